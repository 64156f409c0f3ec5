#pragma once
// How far each grain may go before the lists must be made anew: its skin. Two grains are listed when the gap between them is less than the
// sum of their skins. A skin follows the fastest grain nearby, since that is what may hit the grain next: grains that fall neither fill the
// lists of those that rest, nor do they leave theirs at once.

#include <vector>

#include "core/thread_team.h"
#include "sim/grain_rows.h"

namespace tsubu::sim {

struct SkinRule {
  double time;         ///< s: for which a grain may go on at the speed of the fastest nearby
  double least, most;  ///< m: bounds of a skin
};

/// The skin of each grain, m.
std::vector<float> chooseSkins(const std::vector<GrainRow>& rows, const SkinRule& rule, ThreadTeam& team);

}  // namespace tsubu::sim
