#pragma once
// Where simulation and pictures meet: a plain copy of what can be seen at one instant. `sim` fills it, `render` draws it, and
// neither knows the other. Arrays over grains run in the order of the grains' permanent ids; an array that the scene does not
// model or the picture does not ask for is empty.

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace tsubu {

/// A bond between two grains, or between a grain and a wall.
struct SeenBond {
  Vec3 first, second;       ///< m: its ends (of a broken one: when it broke)
  double radius = 0;        ///< m
  double load = 0;          ///< stress over strength; 0 when it cannot break
  double sinceBroken = -1;  ///< s; negative: it holds
};

/// The normal force of a contact: between the centres of two grains, or from a grain's to where it touches a wall.
struct SeenForce {
  Vec3 first, second;  ///< m
  double force = 0;    ///< N; positive when it repels
};

struct Snapshot {
  double time = 0;         ///< s
  std::uint64_t step = 0;  ///< steps taken so far

  std::vector<std::uint32_t> id;        ///< permanent: never given twice
  std::vector<std::uint16_t> material;  ///< index into the scene's materials
  std::vector<double> radius;           ///< m
  std::vector<Vec3> position;           ///< m
  std::vector<Vec3> velocity;           ///< m/s
  std::vector<Vec3> angularVelocity;    ///< rad/s; empty when rotation is not modelled
  std::vector<Quat> orientation;        ///< empty when nobody asked for it, or nothing turns
  std::vector<double> temperature;      ///< K; empty when heat is not modelled
  std::vector<double> load;             ///< N: sum of the normal contact forces on the grain; empty unless asked for

  std::vector<SeenBond> bonds;    ///< empty unless asked for
  std::vector<SeenForce> forces;  ///< of all contacts; empty unless asked for

  std::vector<Pose> walls;  ///< one per visible wall, in the order of the scene

  std::size_t grains() const { return position.size(); }
};

}  // namespace tsubu
