#include "scene/reference.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/describe.h"
#include "scene/showing_form.h"

namespace tsubu::scene {

namespace {

struct Section {
  std::string title, sentence, rows;

  bool operator==(const Section&) const = default;
};

// The form that explains: a section for each table, a row for each key.
class ExplainingForm : public Form {
 public:
  ExplainingForm(std::vector<Section>& sections, std::string path, std::string sentence) : sections_(sections), path_(std::move(path)) {
    section_ = {path_.empty() ? "The file" : fmt::format("`[{}]`", path_), std::move(sentence), {}};
  }

  /// Puts this table before those inside it, unless it has been explained already.
  void close() {
    for (const Section& section : sections_) {
      if (section == section_) return;
    }
    if (!section_.rows.empty()) sections_.push_back(section_);
    for (const Section& section : inner_) {
      bool known = false;
      for (const Section& other : sections_) known = known || section == other;
      if (!known) sections_.push_back(section);
    }
  }

  void quantity(const Field& field, double& value, Dimension dimension, const Bounds& bounds) override {
    row(field, kindOf(dimension, bounds), number(value, dimension));
  }
  void quantityOrAuto(const Field& field, std::optional<double>& value, Dimension dimension, const Bounds& bounds) override {
    row(field, kindOf(dimension, bounds) + ", or `\"auto\"`", value ? number(*value, dimension) : "`\"auto\"`");
  }
  void optionalQuantity(const Field& field, std::optional<double>&, Dimension dimension, const Bounds& bounds) override {
    row(field, kindOf(dimension, bounds), "");
  }
  void quantityOfKinds(const Field& field, double&, std::size_t&, std::span<const Dimension> dimensions, const Bounds&) override {
    std::string kinds;
    for (const Dimension& dimension : dimensions) kinds += (kinds.empty() ? "" : " or ") + nameOf(dimension);
    row(field, kinds, "");
  }
  void quantities(const Field& field, std::vector<double>&, Dimension dimension, const Bounds& bounds) override {
    row(field, "array, each " + kindOf(dimension, bounds), "");
  }
  void vector(const Field& field, Vec3& value, Dimension dimension, VectorRule) override {
    row(field, "three numbers, each " + nameOf(dimension), code(valueText(value)) + unitText(dimension));
  }
  void vectors(const Field& field, std::vector<Vec3>&, Dimension dimension) override {
    row(field, "array of three numbers, each " + nameOf(dimension), "");
  }
  void integer(const Field& field, std::uint64_t& value, std::uint64_t lower, std::uint64_t upper) override {
    row(field, whole(lower, upper), code(std::to_string(value)));
  }
  void optionalInteger(const Field& field, std::optional<std::uint64_t>&, std::uint64_t lower, std::uint64_t upper) override {
    row(field, whole(lower, upper), "");
  }
  void boolean(const Field& field, bool& value) override { row(field, "`true` or `false`", value ? "`true`" : "`false`"); }
  void text(const Field& field, std::string& value) override { row(field, "text", value.empty() ? "" : code(valueText(value))); }
  void colour(const Field& field, render::Colour& value) override { row(field, "colour", code(valueText(value))); }
  void optionalColour(const Field& field, std::optional<render::Colour>&) override { row(field, "colour", ""); }
  void rangeOrAuto(const Field& field, std::optional<render::Range>&, Dimension) override {
    row(field, "two numbers, or `\"auto\"`", "`\"auto\"`");
  }
  void word(const Field& field, std::size_t& index, std::span<const Choice> choices) override {
    std::string words;
    for (const Choice& choice : choices) {
      if (!words.empty()) words += "<br>";
      words += code(valueText(std::string(choice.word)));
      if (!choice.sentence.empty()) words += fmt::format(": {}", choice.sentence);
    }
    row(field, words, code(valueText(std::string(choices[index].word))));
  }
  void someWords(const Field& field, std::span<bool>, std::span<const Choice> choices) override {
    std::string words;
    for (const Choice& choice : choices) words += (words.empty() ? "" : ", ") + code(valueText(std::string(choice.word)));
    row(field, "array of " + words, "`[]`");
  }

  void table(const Field& field, const Part& part) override { child(field, "table", field.key, part); }
  void optionalTable(const Field& field, bool&, const Part& part) override { child(field, "table", field.key, part); }
  void list(const Field& field, Entries entries) override {
    child(field, "table, or an array of tables", field.key, [&](Form& form) { entries.describe(form, 0); });
  }
  void others(const Field& field, Entries entries) override {
    const std::string name = field.key == "name" ? "NAME" : field.key == "first" ? "A" : "B";
    section_.rows += fmt::format("| *{}* | table | | {} |\n", name, field.sentence);
    inner(name, field.sentence, [&](Form& form) { entries.describe(form, 0); });
  }

  std::size_t whichKey(std::span<const Choice>, std::size_t present, bool) override { return present; }
  bool isPlain(std::string_view, bool present) override { return present; }
  void misplaced(std::string_view, std::string_view) override {}
  bool wantsAll() const override { return true; }
  void beginAlternative(std::string_view title) override { alternatives_.emplace_back(title); }
  void endAlternative() override { alternatives_.pop_back(); }

 private:
  static std::string code(const std::string& text) { return "`" + text + "`"; }
  static std::string unitText(Dimension dimension) {
    const std::string unit = unitOf(dimension);
    return unit.empty() ? "" : " " + unit;
  }
  static std::string number(double value, Dimension dimension) {
    if (std::isinf(value)) return code("inf");
    return code(fmt::format("{:.6g}", value)) + unitText(dimension);
  }
  static std::string whole(std::uint64_t lower, std::uint64_t upper) {
    return upper > 1'000'000'000'000 ? fmt::format("whole number from {}", lower) : fmt::format("whole number, {} to {}", lower, upper);
  }
  static std::string kindOf(Dimension dimension, const Bounds& bounds) {
    const std::string range = bounds.description();
    return range == "finite" || bounds.upper >= 1e9 ? nameOf(dimension) : fmt::format("{}, {}", nameOf(dimension), range);
  }

  // Which alternative the row that follows belongs to, where it differs from the row before.
  void sayAlternative() {
    std::string now;
    for (const std::string& title : alternatives_) now += (now.empty() ? "" : ", ") + title;
    if (now != said_) section_.rows += fmt::format("| **{}** | | | |\n", now.empty() ? "in any case" : now);
    said_ = now;
  }

  void row(const Field& field, std::string kind, const std::string& otherwise) {
    sayAlternative();
    section_.rows += fmt::format("| `{}` | {} | {} | {} |\n", field.key, kind, field.required ? "required" : otherwise, field.sentence);
  }

  void child(const Field& field, std::string kind, std::string_view name, const Part& part) {
    row(field, std::move(kind), "");
    inner(name, field.sentence, part);
  }

  void inner(std::string_view name, std::string_view sentence, const Part& part) {
    const std::string path = path_.empty() ? std::string(name) : fmt::format("{}.{}", path_, name);
    ExplainingForm form(inner_, path, std::string(sentence));
    part(form);
    form.close();
  }

  std::vector<Section>& sections_;
  std::vector<Section> inner_;
  std::string path_, said_;
  std::vector<std::string> alternatives_;
  Section section_;
};

constexpr std::string_view preface = R"(# Scene reference

This page is printed by `tsubu reference` from the description by which tsubu reads scenes.

A scene is a [TOML](https://toml.io) file. A quantity is a number in SI units, or a text with a unit: `"2 mm"`, `"1 GPa"`, `"35 deg"`,
`"12 rpm"`, `"2.5 g/cm^3"`, `"0.2 kg/s"`. Units: m, g, s, N, Pa, J, W, Hz, K, A, T, rad, L and bar with the prefixes p n u µ m c d h k M G T; min, h,
t, deg, °, rev, rpm, fps, grains, frames, %. They combine by product, quotient and power; after a `/` a product needs parentheses. A
frequency is not an angular velocity.

Everything of which there can be several is a table of named things: `[materials.glass]`, `[grains.bed]`, `[walls.floor]`. Paths to other
files start at the folder of the scene. Any value can be overridden on the command line: `--set walls.drum.motion.speed="12 rpm"`,
`--set grains.bed.count=500`; elements of arrays by their index from 0. A key that means nothing is an error.
)";

}  // namespace

std::string writeReference() {
  std::vector<Section> sections;
  ExplainingForm form(sections, {}, "What is at the top level.");
  Scene defaults;
  describe(form, defaults);
  form.close();
  std::string text(preface);
  for (const Section& section : sections) {
    text += fmt::format("\n## {}\n\n{}\n\n| key | value | default | meaning |\n|---|---|---|---|\n{}", section.title, section.sentence,
                        section.rows);
  }
  return text;
}

}  // namespace tsubu::scene
