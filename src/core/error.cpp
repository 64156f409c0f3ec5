#include "core/error.h"

#include <fmt/format.h>

namespace tsubu {

std::string toString(const SourcePosition& position) {
  if (position.line == 0) return position.file;
  return fmt::format("{}:{}:{}", position.file, position.line, position.column);
}

std::string toString(const Diagnostic& diagnostic) {
  std::string text;
  if (!diagnostic.position.file.empty()) text = toString(diagnostic.position) + ": ";
  text += diagnostic.message;
  if (!diagnostic.hint.empty()) text += " (" + diagnostic.hint + ")";
  return text;
}

namespace {
std::string join(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) {
    if (!text.empty()) text += '\n';
    text += toString(diagnostic);
  }
  return text;
}

std::vector<Diagnostic> alone(std::string message, std::string hint) {
  std::vector<Diagnostic> diagnostics(1);
  diagnostics[0].message = std::move(message);
  diagnostics[0].hint = std::move(hint);
  return diagnostics;
}
}  // namespace

Error::Error(ErrorKind kind, std::vector<Diagnostic> diagnostics)
    : std::runtime_error(join(diagnostics)), kind_(kind), diagnostics_(std::move(diagnostics)) {}

Error::Error(ErrorKind kind, std::string message, std::string hint) : Error(kind, alone(std::move(message), std::move(hint))) {}

}  // namespace tsubu
