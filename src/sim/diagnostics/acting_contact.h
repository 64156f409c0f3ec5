#pragma once
// Contacts as they act at the present instant: the very forces that move the grains, noted while they are computed. Evaluated once more
// they would be others, since the memory of a contact has by then gone on (docs/physics.md, T5).

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "sim/kernel/kernels.h"

namespace tsubu::sim {

struct ActingContact {
  std::int32_t first;   ///< the grain, by its place
  std::int32_t second;  ///< the other grain, or ofWall()
  Vec3 branch;          ///< m: from the centre of the second, or from the contact point on the wall, to the centre of the first
  Vec3 force;           ///< N: on the first
  Vec3 moment;          ///< N m: of rolling and twisting resistance, on the first

  static constexpr std::int32_t ofWall(std::size_t wall) { return -1 - static_cast<std::int32_t>(wall); }
  bool withWall() const { return second < 0; }
  std::size_t wall() const { return static_cast<std::size_t>(-1 - second); }
  /// N: along the branch; positive when it repels.
  double normalForce() const { return force.dot(branch.normalized()); }
};

/// What the stage holds of contact q after a kernel has run.
template <class Real>
ActingContact contactIn(const StageIn<Real>& stage, int q, std::int32_t first, std::int32_t second, bool rolls);

/// Runs the kernel over a range, in the chunks that it would take anyway and to the same bits, and adds the contacts that touch.
template <class Real>
void passNoting(PairKernelIn<Real> kernel, const PassContext& context, const PairRangeIn<Real>& range, bool rolls, StageIn<Real>& stage,
                Accounts& accounts, std::vector<ActingContact>& acting);

}  // namespace tsubu::sim
