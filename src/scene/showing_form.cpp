#include "scene/showing_form.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tsubu::scene {

namespace {

bool isBareKey(std::string_view key) {
  return !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::string keyText(std::string_view key) { return isBareKey(key) ? std::string(key) : valueText(std::string(key)); }

template <class Items, class Text>
std::string arrayText(const Items& items, Text&& textOf) {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : ", ") + textOf(item);
  return "[" + text + "]";
}

}  // namespace

std::string valueText(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return fmt::format("{}", value);  // the shortest text that reads back to the same bits
}

std::string valueText(const Vec3& value) {
  return fmt::format("[{}, {}, {}]", valueText(value.x()), valueText(value.y()), valueText(value.z()));
}

std::string valueText(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string valueText(render::Colour colour) { return valueText(render::toString(colour)); }

std::string ShowingForm::text() const { return lines_ + tables_; }

void ShowingForm::line(const Field& field, std::string value) { lines_ += fmt::format("{} = {}\n", keyText(field.key), value); }

void ShowingForm::quantity(const Field& field, double& value, Dimension, const Bounds&) { line(field, valueText(value)); }

void ShowingForm::quantityOrAuto(const Field& field, std::optional<double>& value, Dimension, const Bounds&) {
  line(field, value ? valueText(*value) : "\"auto\"");
}

void ShowingForm::optionalQuantity(const Field& field, std::optional<double>& value, Dimension, const Bounds&) {
  if (value) line(field, valueText(*value));
}

void ShowingForm::quantityOfKinds(const Field& field, double& value, std::size_t& which, std::span<const Dimension> dimensions,
                                  const Bounds&) {
  line(field, which == 0 ? valueText(value) : valueText(fmt::format("{} {}", value, unitOf(dimensions[which]))));
}

void ShowingForm::quantities(const Field& field, std::vector<double>& values, Dimension, const Bounds&) {
  line(field, arrayText(values, [](double value) { return valueText(value); }));
}

void ShowingForm::vector(const Field& field, Vec3& value, Dimension, VectorRule) { line(field, valueText(value)); }

void ShowingForm::vectors(const Field& field, std::vector<Vec3>& values, Dimension) {
  line(field, arrayText(values, [](const Vec3& value) { return valueText(value); }));
}

void ShowingForm::integer(const Field& field, std::uint64_t& value, std::uint64_t, std::uint64_t) { line(field, std::to_string(value)); }

void ShowingForm::optionalInteger(const Field& field, std::optional<std::uint64_t>& value, std::uint64_t, std::uint64_t) {
  if (value) line(field, std::to_string(*value));
}

void ShowingForm::boolean(const Field& field, bool& value) { line(field, value ? "true" : "false"); }

void ShowingForm::text(const Field& field, std::string& value) {
  if (!value.empty() || field.required) line(field, valueText(value));
}

void ShowingForm::colour(const Field& field, render::Colour& value) { line(field, valueText(value)); }

void ShowingForm::optionalColour(const Field& field, std::optional<render::Colour>& value) {
  if (value) line(field, valueText(*value));
}

void ShowingForm::rangeOrAuto(const Field& field, std::optional<render::Range>& value, Dimension) {
  line(field, value ? fmt::format("[{}, {}]", valueText(value->low), valueText(value->high)) : "\"auto\"");
}

void ShowingForm::word(const Field& field, std::size_t& index, std::span<const Choice> choices) {
  line(field, valueText(std::string(choices[index].word)));
}

void ShowingForm::someWords(const Field& field, std::span<bool> chosen, std::span<const Choice> choices) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (chosen[i]) words.push_back(valueText(std::string(choices[i].word)));
  line(field, arrayText(words, [](const std::string& word) { return word; }));
}

void ShowingForm::inner(std::string path, std::string header, const Part& part) {
  ShowingForm form(std::move(path));
  part(form);
  // A table of tables needs no header of its own.
  if (!form.lines_.empty() || form.tables_.empty()) tables_ += fmt::format("\n{}\n", header);
  tables_ += form.text();
}

void ShowingForm::table(const Field& field, const Part& part) {
  const std::string path = path_.empty() ? keyText(field.key) : fmt::format("{}.{}", path_, keyText(field.key));
  inner(path, fmt::format("[{}]", path), part);
}

void ShowingForm::optionalTable(const Field& field, bool& present, const Part& part) {
  if (present) table(field, part);
}

void ShowingForm::list(const Field& field, Entries entries) {
  const std::string path = path_.empty() ? keyText(field.key) : fmt::format("{}.{}", path_, keyText(field.key));
  for (std::size_t i = 0; i < entries.count; ++i) {
    inner(path, fmt::format("[[{}]]", path), [&](Form& form) { entries.describe(form, i); });
  }
}

void ShowingForm::others(const Field&, Entries entries) {
  for (std::size_t i = 0; i < entries.count; ++i) {
    const std::string path = fmt::format("{}.{}", path_, keyText(entries.name(i)));
    inner(path, fmt::format("[{}]", path), [&](Form& form) { entries.describe(form, i); });
  }
}

}  // namespace tsubu::scene
