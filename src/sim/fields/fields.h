#pragma once
// What acts on grains from afar, in plain structs: gravity that changes, a fluid, global damping (docs/physics.md, F1–F5).

#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "core/vec.h"

namespace tsubu::sim {

// --- gravity ------------------------------------------------------------------------------------------------------------

/// Gravity turns about an axis, right-handed, until it has turned through an angle.
struct GravityTurn {
  Vec3 axis = Vec3::UnitY();                               ///< any length but zero
  double angularSpeed = 0;                                 ///< rad/s
  double angle = std::numeric_limits<double>::infinity();  ///< rad, not negative

  bool operator==(const GravityTurn&) const = default;
};

/// Adds amplitude·sin(2πft + phase): what a box that is shaken feels in its own frame.
struct GravityShake {
  Vec3 amplitude = Vec3::Zero();  ///< m/s²
  double frequency = 0;           ///< Hz
  double phase = 0;               ///< rad

  bool operator==(const GravityShake&) const = default;
};

/// Its clock runs from `start` to `end`. A turn stays where it has come to; a shake is gone.
struct GravityChange {
  std::variant<GravityTurn, GravityShake> kind;
  double start = 0, end = std::numeric_limits<double>::infinity();  ///< s

  bool operator==(const GravityChange&) const = default;
};

// --- flows --------------------------------------------------------------------------------------------------------------

struct UniformFlow {
  Vec3 velocity = Vec3::Zero();  ///< m/s
  bool operator==(const UniformFlow&) const = default;
};

/// u = rate ((x − point)·gradient) direction, both of unit length: layers slide over each other.
struct ShearFlow {
  Vec3 point = Vec3::Zero();                                 ///< m: at rest
  Vec3 direction = Vec3::UnitX(), gradient = Vec3::UnitZ();  ///< any length but zero
  double rate = 0;                                           ///< 1/s
  bool operator==(const ShearFlow&) const = default;
};

/// The fluid turns like a rigid body.
struct VortexFlow {
  Vec3 point = Vec3::Zero(), axis = Vec3::UnitZ();
  double angularSpeed = 0;  ///< rad/s
  bool operator==(const VortexFlow&) const = default;
};

/// Poiseuille's profile in a round pipe; the fluid is at rest outside.
struct PipeFlow {
  Vec3 point = Vec3::Zero(), axis = Vec3::UnitZ();
  double radius = 0;  ///< m: of the pipe
  double speed = 0;   ///< m/s: on the axis, along it
  bool operator==(const PipeFlow&) const = default;
};

using Flow = std::variant<UniformFlow, ShearFlow, VortexFlow, PipeFlow>;

/// A fluid that flows as it is told and does not feel the grains.
struct Drag {
  Flow flow;
  double viscosity = 0;        ///< Pa s: Stokes' drag 6πμr, and torque 8πμr³
  double coefficient = 0;      ///< kg/s: linear drag, the same for every grain
  double dragCoefficient = 0;  ///< C_d of the quadratic drag ½ρ C_d πr² |v − u|
  double density = 0;          ///< kg/m³, of the fluid
  bool buoyancy = true;        ///< the fluid carries the weight of what a grain displaces
  bool torque = true;          ///< the fluid turns grains as it turns itself (its viscosity does)

  bool operator==(const Drag&) const = default;
};

/// Article's C_i and D_i: force −C v and torque −D ω, against rest.
struct GlobalDamping {
  double force = 0;   ///< C, kg/s
  double torque = 0;  ///< D, N m s
  double rate = 0;    ///< 1/s: adds rate·m to C and rate·I to D

  bool operator==(const GlobalDamping&) const = default;
};

struct Fields {
  std::vector<GravityChange> gravity;  ///< applied one after the other: a turn turns what came before it
  std::optional<Drag> drag;
  std::optional<GlobalDamping> damping;

  bool operator==(const Fields&) const = default;
};

}  // namespace tsubu::sim
