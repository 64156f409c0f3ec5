#pragma once
// The one table of material properties. It drives the reading of scenes, the messages for missing and never-read keys, the
// reference page, and what a contact law may ask for.

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

namespace tsubu::sim {

/// What belongs to a material alone, and what to a pair of materials (a material with itself, or grain with wall, included).
enum class Scope { material, pair };

enum class Property : std::size_t {
  density,
  youngModulus,
  poissonRatio,
  normalStiffness,
  tangentialStiffness,
  restitution,
  normalDampingRate,
  tangentialDampingRate,
  tangentialDampingFactor,
  friction,
  rollingFriction,
  rollingDamping,
  rollingViscosity,
  twistingFriction,
  conductivity,
  heatCapacity,
  magnetisation,
  susceptibility,
  count
};

inline constexpr std::size_t propertyCount = static_cast<std::size_t>(Property::count);

struct PropertyInfo {
  Property property;
  Scope scope;
  std::string_view key;       ///< in scene files
  std::string_view symbol;    ///< in docs/physics.md
  std::string_view unit;      ///< SI, as scene files write it; empty for a pure number
  double lower, upper;        ///< the range that makes sense, both ends included
  std::string_view sentence;  ///< for the reference page and for messages
};

/// The table, in the order of `Property`.
std::span<const PropertyInfo, propertyCount> propertyTable();

inline const PropertyInfo& infoOf(Property property) { return propertyTable()[static_cast<std::size_t>(property)]; }

/// Values by property; NaN where the scene gives none.
class PropertyValues {
 public:
  PropertyValues() { values_.fill(std::numeric_limits<double>::quiet_NaN()); }
  double operator[](Property property) const { return values_[static_cast<std::size_t>(property)]; }
  double& operator[](Property property) { return values_[static_cast<std::size_t>(property)]; }
  bool has(Property property) const { return (*this)[property] == (*this)[property]; }
  double valueOr(Property property, double otherwise) const { return has(property) ? (*this)[property] : otherwise; }

 private:
  std::array<double, propertyCount> values_;
};

/// What a law sees of two materials that meet: what belongs to the pair, and what belongs to each.
struct PairValues {
  const PropertyValues& pair;
  const PropertyValues& first;
  const PropertyValues& second;

  double operator[](Property property) const { return pair[property]; }
  bool has(Property property) const { return pair.has(property); }
};

/// What a law needs of a pair. A law reads `property`; where it is absent, `alternative` serves (equal to `property` when there
/// is none); an optional need has a default that the law states in its header.
struct Need {
  Property property;
  Property alternative;
  bool optional;
};
constexpr Need need(Property property) { return {property, property, false}; }
constexpr Need needEither(Property property, Property alternative) { return {property, alternative, false}; }
constexpr Need mayRead(Property property) { return {property, property, true}; }
constexpr Need mayReadEither(Property property, Property alternative) { return {property, alternative, true}; }

/// The tangential stiffness may be left out only where there is a constant normal one to take it from.
constexpr Need sharpened(Need need, bool growingStiffness) {
  if (growingStiffness && need.property == Property::tangentialStiffness) need.optional = false;
  return need;
}

}  // namespace tsubu::sim
