#pragma once
// An inlet: grains that appear in a region at a rate.

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "sim/insertion/grain.h"
#include "sim/insertion/region.h"
#include "sim/insertion/size_distribution.h"

namespace tsubu::sim {

/// Is a sphere clear of every grain and wall that is there?
using IsFree = std::function<bool(const Vec3& centre, double radius)>;

/// What an inlet has done so far: plain numbers that belong to the state of a run.
struct StreamProgress {
  std::uint64_t emitted = 0;
  double emittedMass = 0;      ///< kg
  std::uint64_t attempts = 0;  ///< places tried in vain for the grain that is next

  bool operator==(const StreamProgress&) const = default;
};

/// \brief Grains enter one after the other, each when its turn has come and a free place has been found.
///
/// Grain k is due as soon as the k grains before it are less than what the rate promises for the time since `start`, by number or by
/// mass. A grain that finds no free place waits, and those behind it; they catch up as soon as there is room, even after `end`, so
/// the amount is right whenever the region can take it, for any step. Everything about grain k is keyed by (seed, stream, k, attempt).
struct Stream {
  std::string name;
  Region region;               ///< where grains appear, entirely inside
  double grainsPerSecond = 0;  ///< one of the two rates is positive
  double kilogramsPerSecond = 0;
  SizeDistribution radii;
  Vec3 velocity = Vec3::Zero();         ///< m/s
  double velocitySpread = 0;            ///< m/s: largest deviation of each component, uniform
  Vec3 angularVelocity = Vec3::Zero();  ///< rad/s
  double temperature = 0;               ///< K; read where heat is modelled
  std::uint16_t material = 0;
  double start = 0;                                                 ///< s
  double end = std::numeric_limits<double>::infinity();             ///< s: no more is promised after it
  std::uint64_t count = std::numeric_limits<std::uint64_t>::max();  ///< at most so many grains

  /// \brief Appends to `grains` those that come in at `time`, and notes them in `progress`.
  /// \param index   number of the stream in the model: streams that are otherwise equal give different grains
  /// \param density kg/m³, of the stream's material
  /// \param isFree  knows the grains and walls that are there already; the stream itself keeps its new grains apart
  void emit(std::uint64_t seed, std::size_t index, double density, double time, const IsFree& isFree, StreamProgress& progress,
            std::vector<Grain>& grains) const;
};

}  // namespace tsubu::sim
