#pragma once
// Bonds as a scene tells them: names where sim::Bonding has numbers.

#include <optional>
#include <string>
#include <variant>

namespace tsubu::scene {

/// k_n per area, N/m³.
struct StiffnessPerArea {
  double stiffness = 0;
  bool operator==(const StiffnessPerArea&) const = default;
};
/// E, Pa: k_n = E over the length of the bond.
struct YoungsModulus {
  double modulus = 0;
  bool operator==(const YoungsModulus&) const = default;
};

/// One value for all ways in which a bond can move, and others where they differ.
struct ByWay {
  double value = 0;
  std::optional<double> shear, torsion, bending;
  bool operator==(const ByWay&) const = default;
};
struct NoDamper {
  bool operator==(const NoDamper&) const = default;
};
struct PercentDamper {
  ByWay share;
  bool operator==(const PercentDamper&) const = default;
};
struct ExponentialDamper {
  ByWay rate;  ///< 1/s
  bool operator==(const ExponentialDamper&) const = default;
};
struct ViscousDamper {
  ByWay ratio;
  bool operator==(const ViscousDamper&) const = default;
};

/// Absent: never.
struct BondStrength {
  std::optional<double> tension, shear;    ///< Pa
  std::optional<double> compressionRatio;  ///< γ
  double frictionAngle = 0;                ///< rad
  std::optional<double> stretch;           ///< r_max over the length when made
  bool operator==(const BondStrength&) const = default;
};

enum class BondContact { off, beyondRest };

struct Bonds {
  std::string name;
  std::string grains, material;          ///< at one end; empty: any
  std::string withGrains, withMaterial;  ///< at the other; empty: as at the first
  std::string wall;                      ///< instead of the other end
  double distance = 1.01;
  double radius = 1;
  std::variant<StiffnessPerArea, YoungsModulus> stiffness;
  double stiffnessRatio = 2.5;
  BondStrength strength;
  std::variant<NoDamper, PercentDamper, ExponentialDamper, ViscousDamper> damping;
  double start = 0;           ///< s
  std::optional<double> end;  ///< s; absent: made once, at the start
  double probability = 1;
  BondContact contact = BondContact::off;

  bool operator==(const Bonds&) const = default;
};

}  // namespace tsubu::scene
