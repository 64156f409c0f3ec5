#pragma once
// A tree of boxes: which of many boxes come near a point or a ray.

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace tsubu::sim {

class Bvh {
 public:
  Bvh() = default;
  explicit Bvh(const std::vector<Box>& boxes);

  /// Calls visit(item) for every box nearer than `reach` to the point, in an order that depends on the boxes only.
  template <class Visit>
  void near(const Vec3& point, double reach, Visit&& visit) const {
    // Without a branch: on which side of a box a point lies cannot be foreseen.
    const auto squaredDistance = [&](const Box& box) {
      return (box.min() - point).cwiseMax(point - box.max()).cwiseMax(0.0).squaredNorm();
    };
    walk([&](const Box& box) { return squaredDistance(box) <= reach * reach; }, visit);
  }

  /// Calls visit(item) for every box that the segment from a to b meets.
  template <class Visit>
  void alongSegment(const Vec3& a, const Vec3& b, Visit&& visit) const {
    walk([&](const Box& box) { return meets(box, a, b); }, visit);
  }

  /// Does any box meet the given one?
  bool meetsAny(const Box& other) const {
    bool any = false;
    walk([&](const Box& box) { return !any && box.intersects(other); }, [&](std::uint32_t) { any = true; });
    return any;
  }

  /// Calls visit(item) for every box that meets the given one.
  template <class Visit>
  void overlapping(const Box& other, Visit&& visit) const {
    walk([&](const Box& box) { return box.intersects(other); }, visit);
  }

 private:
  static bool meets(const Box& box, const Vec3& a, const Vec3& b);

  struct Node {
    Box box;
    std::uint32_t begin = 0, end = 0;  ///< items of the subtree, in `items_`
    std::uint32_t right = 0;           ///< the left child follows its parent; 0 for a leaf
  };

  template <class Test, class Visit>
  void walk(Test&& test, Visit&& visit) const {
    std::uint32_t stack[64];
    int depth = 0;
    if (!nodes_.empty()) stack[depth++] = 0;
    while (depth > 0) {
      const std::uint32_t index = stack[--depth];
      const Node& node = nodes_[index];
      if (!test(node.box)) continue;
      if (node.right == 0) {
        for (std::uint32_t i = node.begin; i < node.end; ++i)
          if (test(boxes_[i])) visit(items_[i]);
      } else {
        stack[depth++] = node.right;
        stack[depth++] = index + 1;
      }
    }
  }

  std::uint32_t build(const std::vector<Box>& boxes, const std::vector<Vec3>& centres, std::uint32_t begin, std::uint32_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
  std::vector<Box> boxes_;  ///< of items_, in their order
};

}  // namespace tsubu::sim
