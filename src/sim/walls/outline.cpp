#include "sim/walls/outline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tsubu::sim {

namespace {

constexpr std::size_t fewSegments = 12;  // below this, looking at all of them is as fast as finding the strip

double squaredDistanceToSegment(const Vec2& point, const Outline::Segment& segment) {
  const Vec2 along = segment.b - segment.a, from = point - segment.a;
  const double squared = along.squaredNorm();
  const double t = squared > 0 ? std::clamp(from.dot(along) / squared, 0.0, 1.0) : 0.0;
  return (from - t * along).squaredNorm();
}

}  // namespace

Outline::Outline(const std::vector<Segment>& segments) {
  if (segments.empty()) return;
  low_ = std::numeric_limits<double>::infinity();
  high_ = -low_;
  for (const Segment& s : segments) {
    low_ = std::min({low_, s.a.y(), s.b.y()});
    high_ = std::max({high_, s.a.y(), s.b.y()});
  }
  const std::size_t strips = segments.size() <= fewSegments ? 1 : std::min<std::size_t>(segments.size() / 2, 4096);
  perHeight_ = high_ > low_ ? static_cast<double>(strips) / (high_ - low_) : 0;
  begin_.assign(strips + 1, 0);

  const auto eachStrip = [&](const Segment& s, auto&& visit) {
    for (std::uint32_t k = strip(std::min(s.a.y(), s.b.y())), last = strip(std::max(s.a.y(), s.b.y())); k <= last; ++k) visit(k);
  };
  for (const Segment& s : segments) eachStrip(s, [&](std::uint32_t k) { ++begin_[k + 1]; });
  for (std::size_t k = 0; k < strips; ++k) begin_[k + 1] += begin_[k];
  segments_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (const Segment& s : segments) eachStrip(s, [&](std::uint32_t k) { segments_[next[k]++] = s; });
}

std::uint32_t Outline::strip(double y) const {
  const double k = std::clamp((y - low_) * perHeight_, 0.0, static_cast<double>(begin_.size() - 2));
  return static_cast<std::uint32_t>(k);
}

bool Outline::contains(const Vec2& point) const {
  if (!(point.y() >= low_ && point.y() <= high_)) return false;
  const std::uint32_t k = strip(point.y());
  int winding = 0;
  for (std::uint32_t i = begin_[k]; i < begin_[k + 1]; ++i) {
    const Segment& s = segments_[i];
    const bool upwards = s.b.y() > point.y();
    if ((s.a.y() > point.y()) == upwards) continue;  // half-open: a vertex at this height counts once
    // From the lower end, so that the answer does not depend on the way the segment runs.
    const Vec2& low = upwards ? s.a : s.b;
    const Vec2& high = upwards ? s.b : s.a;
    const double cross = (high.x() - low.x()) * (point.y() - low.y()) - (high.y() - low.y()) * (point.x() - low.x());
    if (cross > 0) winding += upwards ? s.count : -s.count;
  }
  return winding != 0;
}

double Outline::squaredDistance(const Vec2& point, double reach) const {
  double nearest = std::numeric_limits<double>::infinity();
  if (begin_.empty() || point.y() + reach < low_ || point.y() - reach > high_) return nearest;
  const std::uint32_t last = strip(point.y() + reach);
  for (std::uint32_t i = begin_[strip(point.y() - reach)]; i < begin_[last + 1]; ++i)
    nearest = std::min(nearest, squaredDistanceToSegment(point, segments_[i]));
  return nearest;
}

}  // namespace tsubu::sim
