// Walls of a frame: opaque triangles, and one stream of translucent triangles and lines sorted from back to front.

#include <algorithm>
#include <cmath>

#include "render/colour_map.h"
#include "render/frame.h"

namespace tsubu::render {

namespace {

/// A triangle of the stream of sheets, as three vertices of sheet.vert.
struct Sheet {
  double distance;  ///< m, from the eye
  std::array<std::array<float, 12>, 3> vertices;
};

using Paint = std::array<double, 4>;  // sRGB-encoded, opacity

Paint paintOf(Colour colour, double factor, double opacity) {
  return {colour.red / 255.0 * factor, colour.green / 255.0 * factor, colour.blue / 255.0 * factor, opacity};
}

class Sheets {
 public:
  Sheets(const View& view, double nearPlane, double width, double height)
      : view_(view), near_(nearPlane), halfWidth_(0.5 * width), halfHeight_(0.5 * height) {}

  void addFace(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals, const Paint& paint) {
    Sheet sheet;
    sheet.distance = ((corners[0] + corners[1] + corners[2]) / 3).norm();
    for (std::size_t c = 0; c < 3; ++c) {
      sheet.vertices[c] = vertex(clip(corners[c]), {normals[c].x(), normals[c].y(), normals[c].z(), 0}, paint);
    }
    sheets_.push_back(sheet);
  }

  /// A line `width` samples wide, drawn as two triangles that face the eye; a little nearer than it is, to lie on its wall.
  void addLine(Vec3 a, Vec3 b, double width, const Paint& paint) {
    const double low = -1.001 * near_;
    if (a.z() > low && b.z() > low) return;
    if (a.z() > low) a = b + (a - b) * ((low - b.z()) / (a.z() - b.z()));
    if (b.z() > low) b = a + (b - a) * ((low - a.z()) / (b.z() - a.z()));
    const Eigen::Vector4d p = clip(a), q = clip(b);
    Eigen::Vector2d along((q.x() / q.w() - p.x() / p.w()) * halfWidth_, (q.y() / q.w() - p.y() / p.w()) * halfHeight_);
    if (!(along.norm() > 1e-6)) return;
    along.normalize();
    const double reach = 0.5 * width + 0.5;
    const Eigen::Vector2d across(-along.y() * reach / halfWidth_, along.x() * reach / halfHeight_);
    // Divided by w here: across and depth then run linearly over the screen, as they must.
    const auto corner = [&](const Eigen::Vector4d& end, double sign) {
      const Eigen::Vector2d at = end.head<2>() / end.w() + sign * across;
      return vertex({at.x(), at.y(), std::min(1.0, 1.002 * end.z() / end.w()), 1}, {sign * reach, 0.5 * width, 0, 1}, paint);
    };
    const double distance = 0.999 * (0.5 * (a + b)).norm();
    sheets_.push_back({distance, {corner(p, -1), corner(p, 1), corner(q, -1)}});
    sheets_.push_back({distance, {corner(q, -1), corner(p, 1), corner(q, 1)}});
  }

  std::size_t write(std::vector<float>& to) {
    std::stable_sort(sheets_.begin(), sheets_.end(), [](const Sheet& a, const Sheet& b) { return a.distance > b.distance; });
    to.reserve(sheets_.size() * 36);
    for (const Sheet& sheet : sheets_) {
      for (const auto& v : sheet.vertices) to.insert(to.end(), v.begin(), v.end());
    }
    return sheets_.size();
  }

 private:
  Eigen::Vector4d clip(const Vec3& p) const { return {p.x() / view_.tanX, p.y() / view_.tanY, near_, -p.z()}; }

  static std::array<float, 12> vertex(const Eigen::Vector4d& at, const Eigen::Vector4d& shape, const Paint& paint) {
    std::array<float, 12> v;
    for (int k = 0; k < 4; ++k) {
      v[static_cast<std::size_t>(k)] = static_cast<float>(at[k]);
      v[static_cast<std::size_t>(k) + 4] = static_cast<float>(shape[k]);
      v[static_cast<std::size_t>(k) + 8] = static_cast<float>(paint[static_cast<std::size_t>(k)]);
    }
    return v;
  }

  const View& view_;
  double near_, halfWidth_, halfHeight_;
  std::vector<Sheet> sheets_;
};

/// A triangle in the frame of the eye, its normals towards the eye.
struct Facing {
  std::array<Vec3, 3> corners, normals;
};

Facing facingEye(const WallModel::Triangle& triangle, const Pose& pose, const View& view) {
  Facing t;
  for (std::size_t c = 0; c < 3; ++c) t.corners[c] = view.toView(pose.toWorld(triangle.corners[c]));
  const double sign = (view.rotation * (pose.rotation * triangle.normal)).dot(t.corners[0]) > 0 ? -1 : 1;
  for (std::size_t c = 0; c < 3; ++c) t.normals[c] = sign * (view.rotation * (pose.rotation * triangle.normals[c]));
  return t;
}

void addOpaque(Frame& frame, const Wall& wall, const Pose& pose) {
  for (const WallModel::Triangle& triangle : wall.model.triangles()) {
    const Facing t = facingEye(triangle, pose, frame.view);
    for (std::size_t c = 0; c < 3; ++c) {
      append(frame.walls, t.corners[c].x(), t.corners[c].y(), t.corners[c].z(), wall.lookNumber);
      append(frame.walls, t.normals[c].x(), t.normals[c].y(), t.normals[c].z(), 0);
    }
    ++frame.wallTriangles;
    if (wall.look.ground) continue;
    for (const Vec3& corner : triangle.corners) {
      const Vec3 p = frame.sun.toSun(pose.toWorld(corner));
      append(frame.sunWalls, p.x(), p.y(), p.z(), 1);
    }
    ++frame.sunWallTriangles;
  }
}

}  // namespace

void addWalls(Frame& frame, const std::vector<Wall>& walls, const std::vector<Pose>& poses, const Style& style, int side) {
  Sheets sheets(frame.view, frame.nearPlane, style.picture.width * side, style.picture.height * side);
  // Lines keep their weight against the picture: a pixel at 720 rows, and never thinner than three quarters of one.
  const double pixel = std::max(0.75, style.picture.height / 720.0) * side;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const Wall& wall = walls[k];
    const Pose pose = poseOf(poses, k);
    const WallLook& look = wall.look;
    if (look.style == WallStyle::hidden) continue;
    if (look.style == WallStyle::opaque) addOpaque(frame, wall, pose);
    if (look.style == WallStyle::translucent) {
      for (const WallModel::Triangle& triangle : wall.model.triangles()) {
        const Facing t = facingEye(triangle, pose, frame.view);
        sheets.addFace(t.corners, t.normals, paintOf(look.colour, 1, look.opacity));
      }
    }
    if (look.ground) continue;
    const bool wire = look.style == WallStyle::wire;
    const Paint line = paintOf(look.colour, wire ? 0.85 : 0.5, wire ? 0.95 : look.style == WallStyle::opaque ? 0.5 : 0.6);
    for (const FeatureEdge& edge : wall.model.edges()) {
      sheets.addLine(frame.view.toView(pose.toWorld(edge.a)), frame.view.toView(pose.toWorld(edge.b)), pixel * (wire ? 1.6 : 1.1), line);
    }
  }
  frame.sheetTriangles = sheets.write(frame.sheets);
}

}  // namespace tsubu::render
