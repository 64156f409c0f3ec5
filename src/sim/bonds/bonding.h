#pragma once
// What a scene says about bonds, in plain numbers: which grains are bonded, how stiff, how strong, and what damps them
// (docs/physics.md, B1–B12).

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace tsubu::sim {

/// Which grains may be at an end of a bond.
struct BondEnd {
  std::optional<std::uint16_t> material;                             ///< absent: of any
  std::uint32_t firstId = 0;                                         ///< ids from here …
  std::uint32_t lastId = std::numeric_limits<std::uint32_t>::max();  ///< … to before here

  bool holds(std::uint32_t id, std::uint16_t itsMaterial) const {
    return id >= firstId && id < lastId && (!material || *material == itsMaterial);
  }
  bool operator==(const BondEnd&) const = default;
};

/// When a bond gives way; infinite: never. Stresses are those of the springs, without dampers (B7–B10).
struct BondStrength {
  static constexpr double never = std::numeric_limits<double>::infinity();

  double tension = never;      ///< Pa: σ_max
  double compression = never;  ///< Pa: γ σ_max
  double shear = never;        ///< Pa: τ_max
  double pressureSlope = 0;    ///< tan φ: how much of the pressure on the bond adds to τ_max
  double stretch = never;      ///< r_max over the length at which the bond was made

  bool breakable() const { return tension < never || compression < never || shear < never || stretch < never; }
  bool operator==(const BondStrength&) const = default;
};

/// B4–B6. `percent` takes a share of each spring force against the motion, `exponential` lets the springs relax, `viscous` is a dashpot.
enum class BondDamping { none, percent, exponential, viscous };

/// Along the bond, across it, twisting, bending.
enum BondWay { along, across, twisting, bending, bondWays };

/// One kind of bond, and between whom and when it is made.
struct Bonding {
  std::string name;
  BondEnd first, second;              ///< which is which does not matter
  std::optional<std::uint16_t> wall;  ///< instead of a second grain: each grain to the nearest point of this wall
  double distance = 1;                ///< bonds are made up to this distance of the centres, over R_i + R_j (to a wall: over R_i)
  double radius = 1;                  ///< λ: r_b over the smaller radius
  double stiffness = 0;               ///< N/m³: k_n per area, where the modulus is 0
  double modulus = 0;                 ///< Pa: E, for k_n = E over the length of the bond
  double stiffnessRatio = 1;          ///< k_n/k_t
  BondStrength strength;
  BondDamping damping = BondDamping::none;
  std::array<double, bondWays> dampingOf{};  ///< a share (percent), 1/s (exponential), or a damping ratio (viscous), by BondWay
  double start = 0, end = 0;                 ///< s: bonds are made at `start`, or all the time from `start` to `end`
  double probability = 1;                    ///< that a pair is bonded, drawn once for each pair
  bool contactBeyondRest = false;            ///< does the contact law of a bonded pair act when it is shorter than made? Otherwise never

  bool operator==(const Bonding&) const = default;
};

}  // namespace tsubu::sim
