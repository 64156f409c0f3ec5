#pragma once
// The grains of a snapshot as one eye sees them: in its frame, with where they fall on the picture, and without what cannot be seen.

#include <array>
#include <cstdint>
#include <vector>

#include "core/snapshot.h"
#include "render/view.h"

namespace tsubu::render {

/// A grain that may be seen.
struct SeenGrain {
  std::uint32_t index;     ///< in the snapshot
  Eigen::Vector3f centre;  ///< in the frame of the view
  float radius;
  std::array<float, 4> box;  ///< clip-space rectangle that just holds the picture of the grain: low x, low y, high x, high y
};

/// The indices of grains whose positions are numbers (below 10¹⁵ m) and whose radii are positive numbers: only these are drawn.
std::vector<std::uint32_t> drawableGrains(const Snapshot& snapshot);

/// Grains for a picture of width × height samples, from front to back. Left out: what lies behind `nearPlane` or outside the picture, what
/// is surely hidden by other grains, and grains that contain the eye.
std::vector<SeenGrain> seenGrains(const Snapshot& snapshot, const std::vector<std::uint32_t>& drawable, const View& view, double nearPlane,
                                  int width, int height);

/// The parallel light of the sun: a box of the world seen along its rays. In its frame x and y run from −1 to 1 over the box, and z from
/// 0 (towards the sun) to 1.
struct SunView {
  Mat3 rotation = Mat3::Identity();  ///< world directions to light directions; the rays run along −z
  Vec3 centre = Vec3::Zero();        ///< of the box, in light directions
  Vec3 half = Vec3::Ones();          ///< half its edges

  Vec3 toSun(const Vec3& world) const {
    const Vec3 p = (rotation * world - centre).cwiseQuotient(half);
    return {p.x(), p.y(), 0.5 - 0.5 * p.z()};
  }
};

SunView sunOver(const Box& bounds, const Vec3& from);

/// A grain that throws a shadow: seen along parallel rays it is a disc through its centre, which hides exactly what the grain hides.
struct ShadowDisc {
  float x, y, z;  ///< in the frame of the sun
  float radiusX, radiusY;
};

/// The discs that are not hidden from the sun by others, on a map of `size` texels a side.
std::vector<ShadowDisc> shadowDiscs(const Snapshot& snapshot, const std::vector<std::uint32_t>& drawable, const SunView& sun, int size);

}  // namespace tsubu::render
