// Bonds of a frame: bars that tell the load by their colour.

#include <algorithm>

#include "render/frame_bars.h"

namespace tsubu::render {

void addBonds(Frame& frame, const std::vector<SeenBond>& bonds, const Style& style, int firstLook, int side) {
  const Range range = style.bonds.range.value_or(Range{0, 1});
  Bars bars(frame, style, !style.grains.shown, side);
  for (const SeenBond& bond : bonds) {
    double radius = style.bonds.scale * bond.radius;
    int look = firstLook + barLook(bond.load, range);
    if (bond.sinceBroken >= 0) {
      look = firstLook + barLooks;
      radius *= 1 - std::min(1.0, bond.sinceBroken / std::max(style.bonds.brokenFor, 1e-300));
    }
    bars.add(bond.first, bond.second, radius, look);
  }
  if (!frame.legend && std::any_of(bonds.begin(), bonds.end(), [](const SeenBond& bond) { return bond.load > 0; })) {
    frame.legend = Legend{"stress / strength", "", style.bonds.map, range, 1, true};
  }
}

std::vector<WallLook> looksOfBonds(const Bonds& style) {
  std::vector<WallLook> looks = looksOfBars(style.map);
  looks.emplace_back().colour = style.broken;
  return looks;
}

}  // namespace tsubu::render
