#include "io/document.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>

#include "core/names.h"
#include "io/text_file.h"

namespace tsubu::io {

// From the tree of toml++ to ours.
struct Conversion {
  const std::string& file;
  bool override = false;  // then every position is `file` itself

  SourcePosition at(const toml::source_position& position) const {
    if (override) return {file, 0, 0};
    return {file, static_cast<int>(position.line), static_cast<int>(position.column)};
  }

  Value value(const toml::node& node, std::string path) const {
    Value result;
    result.position_ = result.keyPosition_ = at(node.source().begin);
    result.path_ = std::move(path);
    if (const auto* table = node.as_table()) {
      result.content_ = members(*table, result.path_);
    } else if (const auto* array = node.as_array()) {
      Value::Array elements;
      for (const toml::node& element : *array) elements.push_back(value(element, join(result.path_, std::to_string(elements.size()))));
      result.content_ = std::move(elements);
    } else {
      result.content_ = scalar(node);
    }
    return result;
  }

  static std::string join(const std::string& path, std::string_view key) {
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
  }

 private:
  Value::Table members(const toml::table& table, const std::string& path) const {
    Value::Table members;
    for (const auto& [key, node] : table) {
      Value member = value(node, join(path, key.str()));
      member.keyPosition_ = at(key.source().begin);
      members.emplace_back(std::string(key.str()), std::move(member));
    }
    // toml++ sorts by name; people mean the order in which they write.
    std::stable_sort(members.begin(), members.end(), [](const auto& a, const auto& b) {
      const SourcePosition &p = a.second.keyPosition_, &q = b.second.keyPosition_;
      return std::pair(p.line, p.column) < std::pair(q.line, q.column);
    });
    return members;
  }

  static Value::Content scalar(const toml::node& node) {
    if (const auto value = node.value_exact<bool>()) return *value;
    if (const auto value = node.value_exact<std::int64_t>()) return *value;
    if (const auto value = node.value_exact<double>()) return *value;
    if (const auto value = node.value_exact<std::string>()) return *value;
    std::ostringstream text;
    node.visit([&text](const auto& n) { text << n; });
    return Value::Date{text.str()};
  }
};

namespace {

// Tables inside tables that a key may open. Recursion over the tree, ours and that of toml++, which bounds brackets but not dots, needs
// a stack for each of them.
constexpr int deepestKey = 100;

// Throws when a dotted key has too many parts. Reads no more of TOML than that: dots between keys, but not in texts and comments.
void refuseDeepKeys(std::string_view text, const std::string& name) {
  int line = 1, dots = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      for (++i; i < text.size() && text[i] != c && text[i] != '\n'; ++i) i += c == '"' && text[i] == '\\';
    } else if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
    } else if (c == '.') {
      ++dots;
    } else if (std::string_view(",=[]{}").find(c) != std::string_view::npos) {
      dots = 0;
    }
    if (i < text.size() && text[i] == '\n') {
      ++line;
      dots = 0;
    }
    if (dots > deepestKey) throw Error(ErrorKind::scene, {{{name, line, 1}, "A key here has far too many parts.", {}}});
  }
}

toml::table parse(std::string_view text, const std::string& name) {
  refuseDeepKeys(text, name);
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    const auto& begin = error.source().begin;
    std::string sentence(error.description());
    if (!sentence.empty() && sentence.back() != '.') sentence += '.';
    throw Error(ErrorKind::scene, {{{name, static_cast<int>(begin.line), static_cast<int>(begin.column)}, std::move(sentence), {}}});
  }
}

// The value of an override: TOML when it is exactly one TOML value, else the text as it stands ("2 mm" need not be quoted twice).
toml::table parseOverride(std::string_view text, const std::string& source) {
  refuseDeepKeys(text, source);
  try {
    toml::table table = toml::parse(fmt::format("value = {}", text));
    if (table.size() == 1 && table.contains("value")) return table;
  } catch (const toml::parse_error&) {
  }
  return toml::table{{"value", std::string(text)}};
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// a.b."c d".e; nothing when a segment is empty or a quote does not close.
std::optional<std::vector<std::string>> splitPath(std::string_view path) {
  std::vector<std::string> segments(1);
  char quote = 0;
  bool quoted = false;
  for (const char c : path) {
    if (quote) {
      if (c == quote)
        quote = 0;
      else
        segments.back() += c;
    } else if ((c == '"' || c == '\'') && segments.back().empty()) {
      quote = c;
      quoted = true;
    } else if (c == '.') {
      if (segments.back().empty() && !quoted) return std::nullopt;
      segments.emplace_back();
      quoted = false;
    } else {
      segments.back() += c;
    }
  }
  if (quote || (segments.back().empty() && !quoted)) return std::nullopt;
  return segments;
}

// The index of the element that a path segment means: a number, or the name that an element gives itself.
std::optional<std::size_t> elementIndex(const Value::Array& array, const std::string& segment) {
  std::size_t index = 0;
  const auto [end, failure] = std::from_chars(segment.data(), segment.data() + segment.size(), index);
  if (failure == std::errc() && end == segment.data() + segment.size()) {
    return index < array.size() ? std::optional(index) : std::nullopt;
  }
  for (std::size_t i = 0; i < array.size(); ++i) {
    if (!array[i].table()) continue;
    for (const auto& [key, member] : *array[i].table()) {
      if (key == "name" && member.text() && *member.text() == segment) return i;
    }
  }
  return std::nullopt;
}

std::string shortened(const std::string& text) {
  if (text.size() <= 40) return text;
  std::size_t end = 37;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // not in the middle of a character
  return text.substr(0, end) + "…";
}

void complain(const Value& table, const std::pair<std::string, Value>& member, const std::vector<std::string>& known,
              std::vector<Diagnostic>& complaints) {
  const auto nearest = nearestName(member.first, known);
  std::string hint;
  if (nearest)
    hint = fmt::format("did you mean '{}'?", *nearest);
  else if (!known.empty())
    hint = fmt::format("known here: {}", listNames(known));
  const std::string where = table.path().empty() ? "" : fmt::format(" in '{}'", table.path());
  complaints.push_back({member.second.keyPosition(), fmt::format("Unknown key '{}'{}.", member.first, where), std::move(hint)});
}

}  // namespace

std::string Value::description() const {
  struct Describe {
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::int64_t value) const { return fmt::format("the number {}", value); }
    std::string operator()(double value) const { return fmt::format("the number {}", value); }
    std::string operator()(const std::string& value) const { return fmt::format("the text '{}'", shortened(value)); }
    std::string operator()(const Date& value) const { return fmt::format("the date or time {}", value.text); }
    std::string operator()(const Array& value) const {
      return value.empty() ? "an empty array" : fmt::format("an array of {}", value.size());
    }
    std::string operator()(const Table&) const { return "a table"; }
  };
  return std::visit(Describe{}, content_);
}

bool Value::knows(std::string_view key) const { return std::find(known_.begin(), known_.end(), key) != known_.end(); }

void Value::know(std::string_view key) const {
  if (!knows(key)) known_.emplace_back(key);
}

const Value* Value::find(std::string_view key) const {
  know(key);
  return findQuietly(key);
}

const Value* Value::findQuietly(std::string_view key) const {
  if (!table()) return nullptr;
  for (const auto& [name, member] : *table()) {
    if (name != key) continue;
    member.read_ = true;
    return &member;
  }
  return nullptr;
}

bool Value::has(std::string_view key) const {
  return table() && std::any_of(table()->begin(), table()->end(), [&](const auto& member) { return member.first == key; });
}

Document Document::fromFile(const std::string& path) { return fromText(readTextFile(path, "scene file"), path); }

Document Document::fromText(std::string_view text, const std::string& name) {
  Document document;
  document.root_ = Conversion{name}.value(parse(text, name), {});
  document.root_.position_ = document.root_.keyPosition_ = {name, 0, 0};
  return document;
}

void Document::set(std::string_view assignment) {
  const auto equals = assignment.find('=');
  const std::string_view path = trimmed(assignment.substr(0, equals));
  const std::string source = fmt::format("--set {}", path);
  const auto refuse = [&](std::string sentence, std::string hint = {}) {
    throw Error(ErrorKind::scene, {{{source, 0, 0}, std::move(sentence), std::move(hint)}});
  };
  const auto segments = splitPath(path);
  if (equals == std::string_view::npos || !segments || segments->size() > deepestKey) {
    refuse(fmt::format("'{}' is not an override.", assignment), "write --set path.to.key=value");
  }

  Value* place = &root_;
  for (const std::string& segment : *segments) {
    if (auto* array = std::get_if<Value::Array>(&place->content_)) {
      const auto index = elementIndex(*array, segment);
      if (!index)
        refuse(fmt::format("'{}' has {} elements and none is called '{}'.", place->path_, array->size(), segment), "count from 0");
      place = &(*array)[*index];
    } else if (auto* table = std::get_if<Value::Table>(&place->content_)) {
      auto member = std::find_if(table->begin(), table->end(), [&](const auto& m) { return m.first == segment; });
      if (member == table->end()) {
        Value made;
        made.content_ = Value::Table{};
        made.path_ = Conversion::join(place->path_, segment);
        made.position_ = made.keyPosition_ = {source, 0, 0};
        made.madeByOverride_ = true;
        member = table->insert(table->end(), {segment, std::move(made)});
      }
      place = &member->second;
    } else {
      refuse(fmt::format("'{}' is {}: it has no part '{}'.", place->path_, place->description(), segment));
    }
  }
  const toml::table parsed = parseOverride(trimmed(assignment.substr(equals + 1)), source);
  const bool made = place->madeByOverride_;
  *place = Conversion{source, true}.value(*parsed.get("value"), place->path_);
  place->madeByOverride_ = made;
}

std::vector<Diagnostic> Document::unreadKeys() const {
  std::vector<Diagnostic> complaints;
  std::vector<const Value*> open{&root_};
  while (!open.empty()) {
    const Value& value = *open.back();
    open.pop_back();
    if (value.skipped_) continue;
    if (value.array()) {
      for (const Value& element : *value.array()) open.push_back(&element);
    } else if (value.table()) {
      for (const auto& member : *value.table()) {
        if (member.second.read_)
          open.push_back(&member.second);
        else
          complain(value, member, value.known_, complaints);
      }
    }
  }
  return complaints;
}

}  // namespace tsubu::io
