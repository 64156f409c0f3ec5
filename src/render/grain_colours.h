#pragma once
// Which colour each grain has, and what the legend must say about it.

#include <optional>
#include <string>
#include <vector>

#include "core/snapshot.h"
#include "render/style.h"

namespace tsubu::render {

/// A colour bar to draw: the range in units of `scale` (the SI value of one displayed unit).
struct Legend {
  std::string quantity, unit;
  ColourMap map = ColourMap::viridis;
  Range range;         ///< SI
  double scale = 1;    ///< SI value of one `unit`
  bool fixed = false;  ///< false: the range belongs to this frame only
};

struct GrainColours {
  std::vector<Colour> colours;   ///< one per grain of the snapshot
  std::optional<Legend> legend;  ///< when the colour shows a quantity
};

/// N or m/s …: from 0 to a round number not below `largest`, which seldom jumps from frame to frame.
Range rangeUpTo(double largest);

/// Throws Error(scene) when the snapshot does not hold what the colours shall show.
GrainColours grainColours(const Grains& style, const Snapshot& snapshot);

}  // namespace tsubu::render
