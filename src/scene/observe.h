#pragma once
// What a scene wants to know in the end: a few numbers, each with a name. They are measured at the rows of the ledger.

#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "core/vec.h"
#include "sim/insertion/region.h"

namespace tsubu::scene {

/// Grains per second through a counter, the slope of a straight line through count against time.
struct DischargeRate {
  std::string counter;
  double from = 0, to = std::numeric_limits<double>::infinity();  ///< s
  bool operator==(const DischargeRate&) const = default;
};

/// s: when a counter has seen this share of all grains that the scene ever had, or a box holds no more than the rest.
struct TimeToEmpty {
  std::string counter;  ///< empty: the box says
  std::optional<sim::BoxRegion> box;
  double share = 0.9;
  bool operator==(const TimeToEmpty&) const = default;
};

/// m: the coordinate of the centre of mass along an axis, in the end.
struct CentreOfMass {
  Vec3 axis = Vec3::UnitZ();
  std::string material = {};  ///< of these grains alone; empty: of all
  bool operator==(const CentreOfMass&) const = default;
};

/// rad: the slope of the surface of the resting grains of a heap around a vertical axis.
struct AngleOfRepose {
  Vec3 point = Vec3::Zero();
  bool operator==(const AngleOfRepose&) const = default;
};

/// m: how far the front has come along a direction; the front is the place that this share of the grains are behind.
struct RunOut {
  Vec3 direction = Vec3::UnitX();
  double share = 0.99;
  bool operator==(const RunOut&) const = default;
};

/// N: the largest force of grains on a wall at any row.
struct PeakForce {
  std::string wall;
  bool operator==(const PeakForce&) const = default;
};

/// Lacey's index of two kinds of grains, by material: 0 apart, 1 mixed at random.
struct MixingIndex {
  std::string material;  ///< against all others
  double cell = 0;       ///< m: edge of the cells that are the samples
  bool operator==(const MixingIndex&) const = default;
};

/// How many bonds have broken in the end.
struct BrokenBonds {
  bool operator==(const BrokenBonds&) const = default;
};

/// Of any contact at any row, in radii of the smaller grain.
struct LargestOverlap {
  bool operator==(const LargestOverlap&) const = default;
};

/// What no account explains in the end, as a share of the energy turned over.
struct EnergyResidual {
  bool operator==(const EnergyResidual&) const = default;
};

/// J: in the end.
struct KineticEnergy {
  bool operator==(const KineticEnergy&) const = default;
};

struct Observable {
  std::string name;
  std::variant<DischargeRate, TimeToEmpty, CentreOfMass, AngleOfRepose, RunOut, PeakForce, MixingIndex, BrokenBonds, LargestOverlap,
               EnergyResidual, KineticEnergy>
      kind;

  bool operator==(const Observable&) const = default;
};

}  // namespace tsubu::scene
