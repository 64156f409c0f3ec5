#pragma once
// Which grains can be seen at all: in a packed bed most cannot, and llvmpipe would draw every one of them in full.

#include <cstdint>
#include <vector>

namespace tsubu::render {

/// A grain on a raster, in cells of the raster. Depths grow away from the eye, in any monotonic measure.
struct Splat {
  float x, y, inner;            ///< a disc that the grain covers wholly, nowhere deeper than `back`
  float outerX, outerY, outer;  ///< a disc outside which nothing of the grain is seen
  float front, back;            ///< `front`: nothing of the grain is nearer
};

/// The numbers of the splats that are not surely hidden behind others, from front to back. Conservative: a splat is left out only when
/// each cell of the raster that it may touch lies wholly within the disc of a splat whose `back` is in front of its `front`.
/// Splats outside the raster (width × height cells) are left out too.
std::vector<std::uint32_t> notHidden(const std::vector<Splat>& splats, int width, int height);

}  // namespace tsubu::render
