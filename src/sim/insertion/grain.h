#pragma once
// A grain as it enters the simulation, before it has an id.

#include <cstdint>

#include "core/random.h"
#include "core/vec.h"

namespace tsubu::sim {

struct Grain {
  Vec3 position = Vec3::Zero();         ///< m, of the centre
  Vec3 velocity = Vec3::Zero();         ///< m/s
  Vec3 angularVelocity = Vec3::Zero();  ///< rad/s, in the world's axes
  Quat orientation = Quat::Identity();  ///< body to world
  double radius = 0;                    ///< m
  std::uint16_t material = 0;           ///< index into the materials of the model
  double temperature = 0;               ///< K; read where heat is modelled
};

/// A rotation drawn uniformly from all rotations (Marsaglia 1972, two points in discs): no trigonometry, the same bits everywhere.
inline Quat randomRotation(Random& random) {
  const auto disc = [&random](double& x, double& y) {
    double s;
    do {
      x = random.uniform(-1, 1);
      y = random.uniform(-1, 1);
      s = x * x + y * y;
    } while (s >= 1 || s == 0);
    return s;
  };
  double x, y, u, v;
  const double s = disc(x, y), t = disc(u, v);
  const double k = std::sqrt((1 - s) / t);
  return Quat(x, y, u * k, v * k);
}

/// `mean` plus, in each component, a deviation drawn uniformly from [−spread, spread).
inline Vec3 spreadAround(const Vec3& mean, double spread, Random& random) {
  if (spread == 0) return mean;
  const double x = random.uniform(-spread, spread), y = random.uniform(-spread, spread), z = random.uniform(-spread, spread);
  return mean + Vec3(x, y, z);
}

}  // namespace tsubu::sim
