#include "render/cull.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tsubu::render {

namespace {

enum class Cells { touched, contained };

/// Calls visit(y, from, to) with the cells of each row of the raster that the disc touches or contains, until it answers true; says
/// whether it did.
template <class Visit>
bool anyRow(float cx, float cy, float radius, Cells which, int width, int height, Visit visit) {
  const bool inside = which == Cells::contained;
  const auto first = [&](float v, int limit) {
    return static_cast<int>(std::clamp(inside ? std::ceil(v) : std::floor(v), 0.0f, static_cast<float>(limit)));
  };
  const auto end = [&](float v, int limit) {
    return static_cast<int>(std::clamp(inside ? std::floor(v) : std::ceil(v), 0.0f, static_cast<float>(limit)));
  };
  const int endY = end(cy + radius, height);
  for (int y = first(cy - radius, height); y < endY; ++y) {
    // Of the two edges of the row, the farther decides what is contained, the nearer what is touched.
    const float a = static_cast<float>(y) - cy, b = a + 1;
    const float far = std::max(std::abs(a), std::abs(b)), near = a <= 0 && b >= 0 ? 0 : std::min(std::abs(a), std::abs(b));
    const float offset = inside ? far : near, rest = radius * radius - offset * offset;
    if (rest <= 0) continue;
    const float half = std::sqrt(rest);
    const int from = first(cx - half, width), to = end(cx + half, width);
    if (from < to && visit(y, from, to)) return true;
  }
  return false;
}

/// For each cell the depth behind which nothing can be seen.
class Raster {
 public:
  Raster(int width, int height)
      : width_(width),
        height_(height),
        depth_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), std::numeric_limits<float>::infinity()) {}

  bool shows(const Splat& s) const {
    return anyRow(s.outerX, s.outerY, s.outer, Cells::touched, width_, height_, [&](int y, int from, int to) {
      const float* row = &depth_[index(y)];
      float deepest = 0;
      for (int x = from; x < to; ++x) deepest = std::max(deepest, row[x]);
      return deepest > s.front;
    });
  }

  void cover(const Splat& s) {
    anyRow(s.x, s.y, s.inner, Cells::contained, width_, height_, [&](int y, int from, int to) {
      float* row = &depth_[index(y)];
      for (int x = from; x < to; ++x) row[x] = std::min(row[x], s.back);
      return false;
    });
  }

 private:
  std::size_t index(int y) const { return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_); }

  int width_, height_;
  std::vector<float> depth_;
};

}  // namespace

std::vector<std::uint32_t> notHidden(const std::vector<Splat>& splats, int width, int height) {
  std::vector<std::uint32_t> order(splats.size());
  for (std::uint32_t k = 0; k < order.size(); ++k) order[k] = k;
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return splats[a].front != splats[b].front ? splats[a].front < splats[b].front : a < b;
  });
  Raster raster(width, height);
  // Whatever hides a splat is nearer in front, so it has been covered before its turn comes. A hidden splat hides nothing new.
  std::vector<std::uint32_t> shown;
  for (const std::uint32_t k : order) {
    if (!raster.shows(splats[k])) continue;
    raster.cover(splats[k]);
    shown.push_back(k);
  }
  return shown;
}

}  // namespace tsubu::render
