#pragma once
// Bonds between grains and walls: what differs from bonds between grains is where their other end is.

#include <cstdint>
#include <vector>

#include "sim/bonds/bond_columns.h"
#include "sim/grain_rows.h"
#include "sim/ledger.h"
#include "sim/periodic.h"
#include "sim/walls/motion.h"

namespace tsubu::sim {

/// Bonds of the grains of a slab with a wall: second ends are rows of their own, one for each bond, that move with the wall.
struct WallBonds {
  BondColumns bonds;
  std::vector<Vec3> foot;  ///< m, frame of the wall
  std::vector<GrainRow> rows;
  std::vector<HalfStepRow> half;
  std::vector<ForceRow> forces;
  Tally work;  ///< J: done by the wall

  void add(std::int32_t grain, const Vec3& place, const BondBody& body, const BondMemory& memory);
  void take(const WallBonds& from, std::size_t k);
  void drop(const std::vector<char>& marked);
  /// Puts the feet where the wall is at that time: the image that is nearest to the grain.
  void place(const WallMotion& motion, const std::vector<GrainRow>& grains, const Periods& periods, double time, double dt);
  /// Of a step, with the forces that the bonds have put on the feet.
  void addWork(double dt);
};

}  // namespace tsubu::sim
