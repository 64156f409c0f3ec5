#include "sim/walls/bvh.h"

#include <algorithm>
#include <numeric>

namespace tsubu::sim {

namespace {
constexpr std::uint32_t leafSize = 4;
}

Bvh::Bvh(const std::vector<Box>& boxes) {
  if (boxes.empty()) return;
  std::vector<Vec3> centres;
  centres.reserve(boxes.size());
  for (const Box& box : boxes) centres.push_back(box.center());
  items_.resize(boxes.size());
  std::iota(items_.begin(), items_.end(), 0u);
  nodes_.reserve(boxes.size());
  build(boxes, centres, 0, static_cast<std::uint32_t>(boxes.size()));
  boxes_.reserve(boxes.size());
  for (const std::uint32_t item : items_) boxes_.push_back(boxes[item]);
}

std::uint32_t Bvh::build(const std::vector<Box>& boxes, const std::vector<Vec3>& centres, std::uint32_t begin, std::uint32_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({{}, begin, end, 0});
  Box box, spread;
  for (std::uint32_t i = begin; i < end; ++i) {
    box.extend(boxes[items_[i]]);
    spread.extend(centres[items_[i]]);
  }
  nodes_[index].box = box;
  if (end - begin <= leafSize) return index;

  // Halves by the median: the depth is the logarithm of the number of boxes whatever their shapes.
  Eigen::Index axis = 0;
  spread.sizes().maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end, [&](std::uint32_t a, std::uint32_t b) {
    const double x = centres[a][axis], y = centres[b][axis];
    return x < y || (x == y && a < b);
  });
  build(boxes, centres, begin, middle);
  nodes_[index].right = build(boxes, centres, middle, end);
  return index;
}

bool Bvh::meets(const Box& box, const Vec3& a, const Vec3& b) {
  double enter = 0, leave = 1;
  for (int k = 0; k < 3; ++k) {
    const double along = b[k] - a[k];
    if (along == 0) {
      if (a[k] < box.min()[k] || a[k] > box.max()[k]) return false;
      continue;
    }
    const double t0 = (box.min()[k] - a[k]) / along, t1 = (box.max()[k] - a[k]) / along;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return enter <= leave;
}

}  // namespace tsubu::sim
