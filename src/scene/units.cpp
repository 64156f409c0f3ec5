#include "scene/units.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/names.h"

namespace tsubu::scene {

namespace {

// A factor as a quotient: "1.1 mm" is 1.1 / 1000, correctly rounded, and not 1.1 × 0.001.
struct Scale {
  double times = 1, over = 1;
};

struct Unit {
  std::string_view name;
  Scale scale;
  Dimension dimension;
  bool takesPrefix;
};

struct Prefix {
  std::string_view name;
  Scale scale;
};

constexpr double pi = std::numbers::pi;

constexpr Unit units[] = {
    {"m", {}, dimension::length, true},
    {"g", {1, 1e3}, dimension::mass, true},
    {"s", {}, dimension::time, true},
    {"N", {}, dimension::force, true},
    {"Pa", {}, dimension::pressure, true},
    {"J", {}, {{2, 1, -2, 0}}, true},
    {"W", {}, {{2, 1, -3, 0}}, true},
    {"Hz", {}, dimension::frequency, true},
    {"rad", {}, dimension::angle, true},
    {"L", {1, 1e3}, {{3, 0, 0, 0}}, true},
    {"l", {1, 1e3}, {{3, 0, 0, 0}}, true},
    {"bar", {1e5, 1}, dimension::pressure, true},
    {"K", {}, dimension::temperature, true},
    {"A", {}, {{0, 0, 0, 0, 0, 1}}, true},
    {"T", {}, {{0, 1, -2, 0, 0, -1}}, true},
    {"t", {1e3, 1}, dimension::mass, false},
    {"min", {60, 1}, dimension::time, false},
    {"h", {3600, 1}, dimension::time, false},
    {"deg", {pi, 180}, dimension::angle, false},
    {"°", {pi, 180}, dimension::angle, false},
    {"rev", {2 * pi, 1}, dimension::angle, false},
    {"rpm", {2 * pi, 60}, dimension::angularVelocity, false},
    {"fps", {}, dimension::frequency, false},
    {"grain", {}, dimension::number, false},
    {"grains", {}, dimension::number, false},
    {"frame", {}, dimension::number, false},
    {"frames", {}, dimension::number, false},
    {"%", {1, 100}, dimension::number, false},
};

constexpr Prefix prefixes[] = {
    {"p", {1, 1e12}}, {"n", {1, 1e9}}, {"u", {1, 1e6}}, {"\u00b5", {1, 1e6}}, {"\u03bc", {1, 1e6}}, {"m", {1, 1e3}},  {"c", {1, 1e2}},
    {"d", {1, 1e1}},  {"h", {1e2, 1}}, {"k", {1e3, 1}}, {"M", {1e6, 1}},      {"G", {1e9, 1}},      {"T", {1e12, 1}},
};

struct NamedDimension {
  Dimension dimension;
  std::string_view name, example, unit;
};

constexpr NamedDimension named[] = {
    {dimension::number, "a pure number", "0.5", ""},
    {dimension::length, "a length", "\"2 mm\"", "m"},
    {dimension::mass, "a mass", "\"5 g\"", "kg"},
    {dimension::time, "a time", "\"10 ms\"", "s"},
    {dimension::angle, "an angle", "\"35 deg\"", "rad"},
    {dimension::velocity, "a velocity", "\"0.5 m/s\"", "m/s"},
    {dimension::acceleration, "an acceleration", "\"9.81 m/s^2\"", "m/s^2"},
    {dimension::angularVelocity, "an angular velocity", "\"12 rpm\"", "rad/s"},
    {dimension::frequency, "a frequency", "\"50 Hz\"", "1/s"},
    {dimension::massRate, "a mass per time", "\"0.2 kg/s\"", "kg/s"},
    {dimension::density, "a density", "\"2.5 g/cm^3\"", "kg/m^3"},
    {dimension::stiffness, "a stiffness", "\"10 kN/m\"", "N/m"},
    {{{-2, 1, -2, 0}}, "a stiffness per area", "\"1e9 N/m^3\"", "N/m^3"},
    {dimension::force, "a force", "\"3 N\"", "N"},
    {dimension::pressure, "a pressure", "\"1 GPa\"", "Pa"},
    {{{-1, 0, 1, 0}}, "a time per length", "\"0.2 s/m\"", "s/m"},
    {{{2, 0, 0, 0}}, "an area", "\"2 cm^2\"", "m^2"},
    {{{3, 0, 0, 0}}, "a volume", "\"2 L\"", "m^3"},
    {{{2, 1, -2, 0}}, "an energy", "\"2 mJ\"", "J"},
    {{{2, 1, -3, 0}}, "a power", "\"2 W\"", "W"},
    {dimension::temperature, "a temperature", "\"300 K\"", "K"},
    {{{1, 1, -3, 0, -1}}, "a conductivity", "\"0.8 W/(m K)\"", "W/(m K)"},
    {{{2, 0, -2, 0, -1}}, "a heat per mass and kelvin", "\"800 J/(kg K)\"", "J/(kg K)"},
    {{{0, 1, -2, 0, 0, -1}}, "a magnetic field", "\"50 mT\"", "T"},
    {{{-1, 0, 0, 0, 0, 1}}, "a magnetisation", "\"400 kA/m\"", "A/m"},
    {{{2, 0, 0, 0, 0, 1}}, "a magnetic moment", "\"0.5 A m^2\"", "A m^2"},
    {{{-1, 1, -2, 0, 0, -1}}, "a field gradient", "\"0.5 T/m\"", "T/m"},
    {{{-1, 1, -1}}, "a viscosity", "\"1 mPa s\"", "Pa s"},
};

const NamedDimension* find(const Dimension& dimension) {
  for (const NamedDimension& entry : named) {
    if (entry.dimension == dimension) return &entry;
  }
  return nullptr;
}

struct Factor {
  Scale scale;
  Dimension dimension;

  void multiply(const Factor& other, int power) {
    for (int i = 0; i < std::abs(power); ++i) {
      scale.times *= power > 0 ? other.scale.times : other.scale.over;
      scale.over *= power > 0 ? other.scale.over : other.scale.times;
    }
    for (std::size_t k = 0; k < dimension.exponents.size(); ++k) dimension.exponents[k] += power * other.dimension.exponents[k];
  }
};

std::optional<Factor> lookUp(std::string_view name) {
  for (const Unit& unit : units) {
    if (unit.name == name) return Factor{unit.scale, unit.dimension};
  }
  for (const Unit& unit : units) {
    if (!unit.takesPrefix || !name.ends_with(unit.name)) continue;
    for (const Prefix& prefix : prefixes) {
      if (name.size() == prefix.name.size() + unit.name.size() && name.starts_with(prefix.name)) {
        return Factor{{unit.scale.times * prefix.scale.times, unit.scale.over * prefix.scale.over}, unit.dimension};
      }
    }
  }
  return std::nullopt;
}

std::string nearestUnit(std::string_view name) {
  static const std::vector<std::string> common{"mm",  "cm",  "m",   "um",  "km",  "g",   "kg",  "mg",  "t",      "s",     "ms", "us",
                                               "min", "h",   "N",   "kN",  "Pa",  "kPa", "MPa", "GPa", "J",      "mJ",    "W",  "Hz",
                                               "kHz", "rad", "deg", "rpm", "rev", "L",   "bar", "fps", "grains", "frames"};
  const auto nearest = nearestName(name, common);
  return nearest ? fmt::format("did you mean '{}'?", *nearest) : std::string();
}

// unit := factor {[*| |/] factor};  factor := (name | 1 | '(' unit ')') [power]
class UnitParser {
 public:
  UnitParser(std::string_view text, std::string_view whole) : rest_(text), whole_(whole) {}

  Factor parse() {
    const Factor result = product();
    if (!rest_.empty()) fail(fmt::format("In '{}' nothing is expected at '{}'.", whole_, rest_));
    return result;
  }

 private:
  [[noreturn]] static void fail(std::string sentence, std::string hint = {}) {
    throw Error(ErrorKind::scene, std::move(sentence), std::move(hint));
  }

  bool accept(std::string_view token) {
    if (!rest_.starts_with(token)) return false;
    rest_.remove_prefix(token.size());
    return true;
  }

  bool acceptBlanks() {
    bool any = false;
    while (accept(" ")) any = true;
    return any;
  }

  Factor product() {
    if (++depth_ > 20) fail(fmt::format("'{}' has too many parentheses.", whole_));
    acceptBlanks();
    Factor result = factor();
    bool divided = false;
    for (;;) {
      const bool blank = acceptBlanks();
      if (rest_.empty() || rest_.front() == ')') break;
      if (accept("/")) {
        acceptBlanks();
        result.multiply(factor(), -1);
        divided = true;
        continue;
      }
      if (!accept("*") && !accept("·") && !blank) fail(fmt::format("In '{}' nothing is expected at '{}'.", whole_, rest_));
      if (divided) fail(fmt::format("In '{}' it is not clear what is divided.", whole_), "use parentheses, as in \"kg/(m s)\"");
      acceptBlanks();
      result.multiply(factor(), 1);
    }
    --depth_;
    return result;
  }

  Factor factor() {
    Factor base;
    if (accept("(")) {
      base = product();
      if (!accept(")")) fail(fmt::format("In '{}' a parenthesis is not closed.", whole_));
    } else if (!accept("1")) {
      base = unit();
    }
    Factor result;
    result.multiply(base, power());
    return result;
  }

  Factor unit() {
    std::size_t length = 0;
    while (length < rest_.size() && !endsName(rest_.substr(length))) ++length;
    const std::string_view name = rest_.substr(0, length);
    if (name.empty()) fail(fmt::format("In '{}' a unit is missing.", whole_));
    const auto found = lookUp(name);
    if (!found) fail(fmt::format("'{}' in '{}' is not a known unit.", name, whole_), nearestUnit(name));
    rest_.remove_prefix(length);
    return *found;
  }

  static bool endsName(std::string_view text) {
    constexpr std::string_view marks = " */()^+-0123456789";
    return marks.find(text.front()) != std::string_view::npos || text.starts_with("·") || text.starts_with("⁻") || superscript(text) >= 0;
  }

  static int superscript(std::string_view text) {
    for (int d = 0; d < 10; ++d) {
      if (text.starts_with(superscripts[d])) return d;
    }
    return -1;
  }

  // "^2", "^-2", "-2", "2", "²", "⁻²", or nothing.
  int power() {
    const bool caret = accept("^");
    const bool negative = accept("-") || accept("⁻");
    if (caret && !negative) accept("+");
    int digit = superscript(rest_);
    if (digit >= 0) {
      rest_.remove_prefix(superscripts[digit].size());
    } else if (!rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9') {
      digit = rest_.front() - '0';
      rest_.remove_prefix(1);
    } else if (caret || negative) {
      fail(fmt::format("In '{}' a power is missing its whole number.", whole_));
    } else {
      return 1;
    }
    return negative ? -digit : digit;
  }

  static constexpr std::string_view superscripts[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};

  std::string_view rest_, whole_;
  int depth_ = 0;
};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? std::string_view() : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

Quantity parseQuantity(std::string_view text) {
  std::string_view rest = trimmed(text);
  if (rest.starts_with("+") && !rest.starts_with("+-")) rest.remove_prefix(1);
  double value = 0;
  const auto [end, failure] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (failure == std::errc::result_out_of_range) throw Error(ErrorKind::scene, fmt::format("The number in '{}' is out of range.", text));
  if (failure != std::errc()) {
    throw Error(ErrorKind::scene, fmt::format("'{}' does not begin with a number.", text), "write a number and a unit, such as \"2 mm\"");
  }
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  rest = trimmed(rest);
  Factor factor;
  if (!rest.empty()) factor = UnitParser(rest, trimmed(text)).parse();
  return {value * factor.scale.times / factor.scale.over, factor.dimension};
}

Dimension dimensionOf(std::string_view unit) { return unit.empty() ? dimension::number : UnitParser(unit, unit).parse().dimension; }

std::string nameOf(const Dimension& dimension) {
  const NamedDimension* entry = find(dimension);
  return entry ? std::string(entry->name) : fmt::format("a quantity in {}", unitOf(dimension));
}

std::string exampleOf(const Dimension& dimension) {
  const NamedDimension* entry = find(dimension);
  return entry ? std::string(entry->example) : fmt::format("\"1 {}\"", unitOf(dimension));
}

std::string unitOf(const Dimension& dimension) {
  if (const NamedDimension* entry = find(dimension)) return std::string(entry->unit);
  constexpr std::string_view bases[] = {"m", "kg", "s", "rad", "K", "A"};
  std::string text;
  for (std::size_t k = 0; k < std::size(bases); ++k) {
    const int power = dimension.exponents[k];
    if (power == 0) continue;
    if (!text.empty()) text += ' ';
    text += bases[k];
    if (power != 1) text += fmt::format("^{}", power);
  }
  return text;
}

}  // namespace tsubu::scene
