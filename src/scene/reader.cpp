#include "scene/reader.h"

#include <algorithm>
#include <filesystem>

#include "io/document.h"
#include "scene/check.h"
#include "scene/describe.h"
#include "scene/filling_form.h"

namespace tsubu::scene {

namespace {

SourcePosition positionIn(const io::Document& document, const std::vector<std::string>& path) {
  const io::Value* value = &document.root();
  bool exact = true;
  for (const std::string& key : path) {
    const io::Value* next = nullptr;
    if (value->table()) {
      for (const auto& [name, member] : *value->table()) {
        if (name == key) next = &member;
      }
    }
    if (!next) {
      exact = false;
      break;
    }
    value = next;
  }
  return exact && !value->table() ? value->position() : value->keyPosition();
}

// In the order of the file; what the command line said comes last.
void sortByPosition(std::vector<Diagnostic>& diagnostics) {
  std::stable_sort(diagnostics.begin(), diagnostics.end(), [](const Diagnostic& a, const Diagnostic& b) {
    const auto key = [](const SourcePosition& p) { return std::tuple(p.file.starts_with("--set"), p.line, p.column); };
    return key(a.position) < key(b.position);
  });
}

Scene readDocument(io::Document document, const std::string& name, const Overrides& overrides, std::vector<Diagnostic>* warnings) {
  for (const std::string& assignment : overrides) document.set(assignment);

  Scene scene;
  scene.folder = std::filesystem::path(name).parent_path().string();
  std::vector<Diagnostic> complaints;
  FillingForm form(&document.root(), document.root(), {}, complaints);
  describe(form, scene);
  for (Diagnostic& complaint : document.unreadKeys()) complaints.push_back(std::move(complaint));
  const PositionOf positionOf = [&document](const Path& keys) { return positionIn(document, keys); };
  Findings findings;
  checkNames(scene, positionOf, findings);
  // With values missing, comparing them would only repeat what has been said.
  if (complaints.empty()) checkContact(scene, positionOf, findings);
  if (complaints.empty()) checkValues(scene, positionOf, findings);
  if (complaints.empty()) checkFields(scene, positionOf, findings);
  if (complaints.empty()) checkDiagnostics(scene, positionOf, findings);
  if (complaints.empty()) checkObserve(scene, positionOf, findings);
  if (complaints.empty()) checkBonds(scene, positionOf, findings);

  const ErrorKind kind = complaints.empty() && findings.errors.empty() ? ErrorKind::files : ErrorKind::scene;
  for (const auto* more : {&findings.errors, &findings.missingFiles}) complaints.insert(complaints.end(), more->begin(), more->end());
  if (!complaints.empty()) {
    sortByPosition(complaints);
    throw Error(kind, std::move(complaints));
  }
  sortByPosition(findings.warnings);
  if (warnings) warnings->insert(warnings->end(), findings.warnings.begin(), findings.warnings.end());
  return scene;
}

}  // namespace

Scene read(const std::string& path, const Overrides& overrides, std::vector<Diagnostic>* warnings) {
  return readDocument(io::Document::fromFile(path), path, overrides, warnings);
}

Scene readText(std::string_view text, const std::string& name, const Overrides& overrides, std::vector<Diagnostic>* warnings) {
  return readDocument(io::Document::fromText(text, name), name, overrides, warnings);
}

}  // namespace tsubu::scene
