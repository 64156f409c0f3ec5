#pragma once
// Quantities as people write them: "2 mm", "1 GPa", "35 deg", "2.5 g/cm^3".

#include <array>
#include <string>
#include <string_view>

namespace tsubu::scene {

/// Exponents of metre, kilogram, second, radian, kelvin and ampere. The angle counts as a dimension of its own, so that a frequency is not
/// taken for an angular velocity.
struct Dimension {
  std::array<int, 6> exponents{};

  bool operator==(const Dimension&) const = default;
};

namespace dimension {
inline constexpr Dimension number{{0, 0, 0, 0}}, length{{1, 0, 0, 0}}, mass{{0, 1, 0, 0}}, time{{0, 0, 1, 0}}, angle{{0, 0, 0, 1}},
    velocity{{1, 0, -1, 0}}, acceleration{{1, 0, -2, 0}}, angularVelocity{{0, 0, -1, 1}}, frequency{{0, 0, -1, 0}}, massRate{{0, 1, -1, 0}},
    density{{-3, 1, 0, 0}}, temperature{{0, 0, 0, 0, 1}}, stiffness{{0, 1, -2, 0}}, force{{1, 1, -2, 0}}, pressure{{-1, 1, -2, 0}};
}  // namespace dimension

struct Quantity {
  double value = 0;  ///< SI
  Dimension dimension;
};

/// \brief Parses "number unit". Throws Error(scene) with a sentence when it is not one (what is wrong, and the nearest unit).
///
/// Units: m, g, s, N, Pa, J, W, Hz, K, A, T, bar, L with the SI prefixes; min, h, t, rad, deg, °, rev, rpm, fps, grains, frames, %.
/// They combine by product (blank, * or ·), quotient (/) and integer power (^2, ², s2), with parentheses; after a / a product needs them.
Quantity parseQuantity(std::string_view text);

/// The dimension of a unit such as "kg/m^3"; of "" a pure number.
Dimension dimensionOf(std::string_view unit);

/// "a length", or "a quantity in kg m^2" when it has no name.
std::string nameOf(const Dimension& dimension);
/// As a scene writes it: "\"2 mm\"" for a length.
std::string exampleOf(const Dimension& dimension);
/// The SI unit: "kg/m^3", empty for a number.
std::string unitOf(const Dimension& dimension);

}  // namespace tsubu::scene
