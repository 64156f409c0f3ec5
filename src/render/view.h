#pragma once
// Where the eye is at an instant, and how it sees.

#include "render/style.h"

namespace tsubu::render {

/// A pinhole camera. In its frame x points right, y up and −z into the picture.
struct View {
  Vec3 eye = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();  ///< world to view directions
  double tanX = 1, tanY = 1;         ///< tangents of half the opening angles
  double distance = 1;               ///< m, from the eye to what it looks at: sets the near plane and the fade of the ground

  Vec3 toView(const Vec3& world) const { return rotation * (world - eye); }
};

/// The view of a camera at a time, for a picture of width/height = `aspect`. `bounds` is what automatic cameras frame.
View viewAt(const Camera& camera, double time, double aspect, const Box& bounds);

/// The direction that a camera calls up (at `time`, for key frames).
Vec3 upOf(const Camera& camera, double time);

}  // namespace tsubu::render
