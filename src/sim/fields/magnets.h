#pragma once
// Magnetic grains and what magnetises them, in plain structs (docs/physics.md, F5–F8).

#include <optional>
#include <variant>
#include <vector>

#include "core/vec.h"

namespace tsubu::sim {

/// The same everywhere.
struct UniformSource {
  Vec3 field = Vec3::Zero();  ///< T
  bool operator==(const UniformSource&) const = default;
};

/// Grows along an axis and is nothing at a point: B = g (a (a·d) − ½ d⊥), between two coils that oppose each other.
struct GradientSource {
  Vec3 point = Vec3::Zero(), axis = Vec3::UnitZ();
  double gradient = 0;  ///< T/m, along the axis
  bool operator==(const GradientSource&) const = default;
};

/// A small magnet.
struct DipoleSource {
  Vec3 point = Vec3::Zero();
  Vec3 moment = Vec3::Zero();  ///< A m²
  bool operator==(const DipoleSource&) const = default;
};

/// A long round magnet with poles along its circumference, seen from outside: B_r = B (R/ρ)^(n+1) cos nφ, B_φ = B (R/ρ)^(n+1) sin nφ.
struct RollerSource {
  Vec3 point = Vec3::Zero(), axis = Vec3::UnitZ();
  Vec3 north = Vec3::UnitX();  ///< towards a north pole: φ = 0
  int pairs = 1;               ///< n: of poles
  double radius = 0;           ///< R, m
  double field = 0;            ///< B, T: at R
  bool operator==(const RollerSource&) const = default;
};

struct FieldSource {
  std::variant<UniformSource, GradientSource, DipoleSource, RollerSource> kind;
  std::optional<std::size_t> wall;  ///< moves with this wall: given for the place where the wall begins
};

/// Grains are magnetic through their material: a magnetisation along the body's z axis, a susceptibility, or both.
struct Magnets {
  double cutOff = 0;  ///< m: pairs farther apart do not feel each other; the last fifth of the way is smooth
  std::vector<FieldSource> sources;
};

}  // namespace tsubu::sim
