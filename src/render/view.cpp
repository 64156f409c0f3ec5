#include "render/view.h"

#include <algorithm>
#include <cmath>

namespace tsubu::render {

namespace {

/// An orthonormal frame whose third axis is `up`: azimuth 0 is its first axis, x where up is z.
Mat3 horizon(const Vec3& up) {
  const Vec3 w = up.normalized();
  const Vec3 hint = std::abs(w.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 u = (hint - w * w.dot(hint)).normalized();
  Mat3 frame;
  frame << u, w.cross(u), w;
  return frame;
}

Vec3 directionOf(double azimuth, double elevation, const Vec3& up) {
  return horizon(up) * Vec3(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
}

View lookAt(const Vec3& eye, const Vec3& target, const Vec3& up, double fovY, double aspect) {
  View view;
  view.eye = eye;
  view.distance = (target - eye).norm();
  const Vec3 back = view.distance > 0 ? Vec3((eye - target) / view.distance) : Vec3(0, -1, 0);
  Vec3 right = up.cross(back);
  if (right.norm() < 1e-9 * up.norm()) right = horizon(back).col(0);  // straight up or down: any horizon will do, always the same
  right.normalize();
  view.rotation << right.transpose(), back.cross(right).transpose(), back.transpose();
  view.tanY = std::tan(0.5 * fovY);
  view.tanX = view.tanY * aspect;
  if (!(view.distance > 0)) view.distance = 1;
  return view;
}

/// The nearest eye that sees all eight corners. With corners (x, y, z) in the directions of the view, z towards the eye, an eye at
/// (X, Y, Z) sees a corner when |x − X| ≤ t·(Z − z), t being the tangent of the half opening. So X lies between max(x + t·z) − t·Z and
/// min(x − t·z) + t·Z, which is possible from some Z on; in between, the middle is fair to both sides. The same for y.
View framing(const AutoCamera& camera, double aspect, const Box& bounds) {
  const Box box = bounds.isEmpty() ? Box(Vec3::Constant(-0.5), Vec3::Constant(0.5)) : bounds;
  const Vec3 centre = box.center(), towardsEye = directionOf(camera.azimuth, camera.elevation, camera.up);
  const View view = lookAt(centre + towardsEye, centre, camera.up, camera.fovY, aspect);
  const double share = 1 - 2 * camera.margin;
  const double t[] = {share * view.tanX, share * view.tanY};
  double most[] = {-INFINITY, -INFINITY}, least[] = {INFINITY, INFINITY}, nearest = -INFINITY;
  for (int k = 0; k < 8; ++k) {
    const Vec3 corner = view.rotation * (box.corner(static_cast<Box::CornerType>(k)) - centre);
    nearest = std::max(nearest, corner.z());
    for (int axis = 0; axis < 2; ++axis) {
      most[axis] = std::max(most[axis], corner[axis] + t[axis] * corner.z());
      least[axis] = std::min(least[axis], corner[axis] - t[axis] * corner.z());
    }
  }
  const double size = std::max(box.diagonal().norm(), 1e-9);
  const double distance = std::max({(most[0] - least[0]) / (2 * t[0]), (most[1] - least[1]) / (2 * t[1]), nearest + 0.01 * size});
  const Vec3 aside = view.rotation.transpose() * Vec3(0.5 * (most[0] + least[0]), 0.5 * (most[1] + least[1]), 0);
  return lookAt(centre + aside + distance * towardsEye, centre + aside, camera.up, camera.fovY, aspect);
}

/// Cubic Hermite with tangents of central differences in time (Catmull–Rom for uneven spacing), at rest at both ends.
template <class T>
T interpolated(const std::vector<KeyFrame>& frames, std::size_t k, double time, T KeyFrame::*member) {
  const auto tangent = [&](std::size_t i) -> T {
    if (i == 0 || i + 1 == frames.size()) return frames[i].*member * 0.0;
    return (frames[i + 1].*member - frames[i - 1].*member) / (frames[i + 1].time - frames[i - 1].time);
  };
  const double h = frames[k + 1].time - frames[k].time, s = (time - frames[k].time) / h;
  const double s2 = s * s, s3 = s2 * s;
  return T(frames[k].*member * (2 * s3 - 3 * s2 + 1) + tangent(k) * (h * (s3 - 2 * s2 + s)) + frames[k + 1].*member * (3 * s2 - 2 * s3) +
           tangent(k + 1) * (h * (s3 - s2)));
}

KeyFrame keyFrameAt(const KeyFrameCamera& camera, double time) {
  const auto& frames = camera.frames;
  if (frames.empty()) return {};
  if (time <= frames.front().time) return frames.front();
  if (time >= frames.back().time) return frames.back();
  std::size_t k = 0;
  while (k + 2 < frames.size() && time >= frames[k + 1].time) ++k;
  return {time, interpolated(frames, k, time, &KeyFrame::eye), interpolated(frames, k, time, &KeyFrame::target),
          interpolated(frames, k, time, &KeyFrame::up), interpolated(frames, k, time, &KeyFrame::fovY)};
}

struct ViewAt {
  double time, aspect;
  const Box& bounds;

  View operator()(const AutoCamera& camera) const { return framing(camera, aspect, bounds); }
  View operator()(const FixedCamera& camera) const { return lookAt(camera.eye, camera.target, camera.up, camera.fovY, aspect); }
  View operator()(const OrbitCamera& camera) const {
    const Vec3 direction = directionOf(camera.azimuth + camera.angularVelocity * time, camera.elevation, camera.up);
    return lookAt(camera.target + camera.distance * direction, camera.target, camera.up, camera.fovY, aspect);
  }
  View operator()(const KeyFrameCamera& camera) const {
    const KeyFrame frame = keyFrameAt(camera, time);
    return lookAt(frame.eye, frame.target, frame.up, frame.fovY, aspect);
  }
};

struct UpOf {
  double time;

  Vec3 operator()(const KeyFrameCamera& camera) const { return keyFrameAt(camera, time).up.normalized(); }
  Vec3 operator()(const auto& camera) const { return camera.up.normalized(); }
};

}  // namespace

View viewAt(const Camera& camera, double time, double aspect, const Box& bounds) {
  return std::visit(ViewAt{time, aspect, bounds}, camera);
}

Vec3 upOf(const Camera& camera, double time) { return std::visit(UpOf{time}, camera); }

}  // namespace tsubu::render
