#pragma once
// Round bars of a frame: triangles with the normals of a cylinder, among the opaque walls. So they are found, lit, shaded and darkened as
// walls are, without a pass of their own.

#include "render/frame.h"

namespace tsubu::render {

class Bars {
 public:
  /// `capped`: are the ends to be seen, or do grains cover them? `side`: samples along the side of a pixel.
  Bars(Frame& frame, const Style& style, bool capped, int side);

  /// A bar of this radius (m) between two points of the world. One that is no bar (a length or radius of zero, not a number) is left out.
  void add(const Vec3& first, const Vec3& second, double radius, int look);

 private:
  void seen(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& na, const Vec3& nb, const Vec3& nc, int look);
  void corner(const Vec3& place, const Vec3& normal, int look);
  void lit(const Vec3& a, const Vec3& b, const Vec3& c);

  Frame& frame_;
  double pixel_;  // m in the picture, at a distance of 1 m
  bool capped_, shadows_;
};

/// The looks of bars that show a value: colours of the map from low to high.
inline constexpr int barLooks = 64;
std::vector<WallLook> looksOfBars(ColourMap map);
/// Which of them shows this value.
int barLook(double value, const Range& range);

}  // namespace tsubu::render
