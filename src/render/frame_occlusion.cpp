// Who hides the sky from whom. Grains keep a list of the spheres around them, and the shader adds up exactly what these hide; a wall close
// to a grain joins the list as a larger sphere that touches the wall. Walls in turn are darkened by the grains close to them.

#include <algorithm>
#include <cmath>

#include "render/frame.h"
#include "render/neighbours.h"

namespace tsubu::render {

namespace {

constexpr std::size_t mostNeighbours = 24;  // of those that hide most
constexpr double wallSphere = 3;            // radius of the sphere that stands for a wall, in radii of the grain
constexpr double wallReach = 1.2;           // a wall counts up to this gap, in radii of the grain
constexpr double surroundings = 3;          // a grain darkens walls up to this distance from its centre, in radii

double smoothstep(double from, double to, double v) {
  const double t = std::clamp((v - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// How much of the sky an occluder takes at the nearest point of the grain: what decides who counts.
double weight(const Occluder& o, double radius) {
  const double distance = std::max(o.offset.norm() - radius, 0.5 * o.radius);
  return o.radius * o.radius / (distance * distance);
}

/// Shrinks what is about to leave the list, so that nothing pops when it does.
void fade(Occluder& o, double radius) {
  const double reach = (o.offset.norm() - radius) / o.radius;
  o.radius *= std::sqrt(1 - smoothstep(1.3, 2, reach));
}

class Occlusion {
 public:
  /// `bars`: are there any among the walls, which every grain may darken?
  Occlusion(Frame& frame, const Snapshot& snapshot, const std::vector<Wall>& walls, bool bars)
      : frame_(frame), snapshot_(snapshot), bars_(bars) {
    for (std::size_t k = 0; k < walls.size(); ++k) {
      if (walls[k].look.style == WallStyle::opaque) walls_.push_back({&walls[k], poseOf(snapshot.walls, k)});
    }
  }

  /// The places in the frame of the world where walls come close to a grain, one for each direction.
  const std::vector<Vec3>& wallsNear(const Vec3& centre, double radius) {
    nearest_.clear();
    for (const auto& [wall, pose] : walls_) {
      points_.clear();
      wall->model.closestPoints(pose.toLocal(centre), (1 + wallReach) * radius, points_);
      for (const Vec3& p : points_) nearest_.push_back(pose.toWorld(p) - centre);
    }
    std::sort(nearest_.begin(), nearest_.end(), [](const Vec3& a, const Vec3& b) { return a.squaredNorm() < b.squaredNorm(); });
    std::size_t kept = 0;
    for (const Vec3& offset : nearest_) {
      const bool known = std::any_of(nearest_.begin(), nearest_.begin() + static_cast<std::ptrdiff_t>(kept),
                                     [&](const Vec3& other) { return offset.dot(other) > 0.7 * offset.norm() * other.norm(); });
      if (!known && offset.norm() > 0.1 * radius) nearest_[kept++] = offset;
    }
    nearest_.resize(kept);
    return nearest_;
  }

  void add(std::size_t record, const SeenGrain& grain, std::vector<Occluder>& around) {
    const double radius = snapshot_.radius[grain.index];
    if (around.size() > mostNeighbours) {
      std::nth_element(around.begin(), around.begin() + mostNeighbours, around.end(), [&](const Occluder& a, const Occluder& b) {
        const double wa = weight(a, radius), wb = weight(b, radius);
        return wa != wb ? wa > wb : a.grain < b.grain;
      });
      around.resize(mostNeighbours);
    }
    for (Occluder& o : around) fade(o, radius);
    const std::vector<Vec3>& walls = wallsNear(snapshot_.position[grain.index], radius);
    for (const Vec3& offset : walls) {
      const double gap = offset.norm() - radius, share = 1 - smoothstep(0, wallReach * radius, gap);
      around.push_back({offset.normalized() * (offset.norm() + wallSphere * radius), wallSphere * radius * std::sqrt(share), 0});
    }
    const std::size_t first = frame_.neighbours.size() / 4;
    for (const Occluder& o : around) {
      const Vec3 v = frame_.view.rotation * o.offset / radius;
      append(frame_.neighbours, v.x(), v.y(), v.z(), o.radius / radius);
    }
    frame_.grains[record * 20 + 12] = static_cast<float>(first);
    frame_.grains[record * 20 + 13] = static_cast<float>(around.size());
    if (!walls.empty() || bars_) addSurroundings(grain);
  }

 private:
  void addSurroundings(const SeenGrain& grain) {
    const double depth = -static_cast<double>(grain.centre.z()), reach = surroundings * grain.radius;
    std::array<double, 4> box{-1, -1, 1, 1};
    if (depth > reach) {
      // A square around the ball, at the depth where it looks largest.
      const double nearest = depth - reach;
      const auto edge = [&](double c, double sign, double opening) {
        const double at = c + sign * reach;
        return at / ((at * sign > 0 ? nearest : depth + reach) * opening);
      };
      box = {edge(grain.centre.x(), -1, frame_.view.tanX), edge(grain.centre.y(), -1, frame_.view.tanY),
             edge(grain.centre.x(), 1, frame_.view.tanX), edge(grain.centre.y(), 1, frame_.view.tanY)};
    }
    append(frame_.surroundings, grain.centre.x(), grain.centre.y(), grain.centre.z(), grain.radius);
    append(frame_.surroundings, box[0], box[1], box[2], box[3]);
    ++frame_.surroundingCount;
  }

  struct PlacedWall {
    const Wall* wall;
    Pose pose;
  };

  Frame& frame_;
  const Snapshot& snapshot_;
  bool bars_;
  std::vector<PlacedWall> walls_;
  std::vector<Vec3> points_, nearest_;
};

}  // namespace

void addOcclusion(Frame& frame, const std::vector<SeenGrain>& seen, const std::vector<std::uint32_t>& drawable, const Snapshot& snapshot,
                  const std::vector<Wall>& walls, bool bars) {
  std::vector<Vec3> centres;
  std::vector<double> radii;
  std::vector<std::uint32_t> place(snapshot.grains());
  for (const std::uint32_t k : drawable) {
    place[k] = static_cast<std::uint32_t>(centres.size());
    centres.push_back(snapshot.position[k]);
    radii.push_back(snapshot.radius[k]);
  }
  const NeighbourGrid grid(centres, radii);
  Occlusion occlusion(frame, snapshot, walls, bars);
  std::vector<Occluder> around;
  for (std::size_t record = 0; record < seen.size(); ++record) {
    const std::uint32_t k = seen[record].index;
    around.clear();
    grid.near(snapshot.position[k], snapshot.radius[k], place[k], around);
    occlusion.add(record, seen[record], around);
  }
}

}  // namespace tsubu::render
