#include "render/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace tsubu::render {

namespace {

constexpr int mostSamples = 16384;  // along a side: the largest texture of llvmpipe

class Complaints {
 public:
  void require(bool good, std::string message) {
    if (!good) list_.push_back({{}, std::move(message), {}});
  }

  void range(std::string_view what, double value, double low, double high) {
    require(value >= low && value <= high, fmt::format("The {} is {}, but must be from {} to {}.", what, value, low, high));
  }

  void opening(double fovY) {
    const bool good = fovY > 0.001 && fovY < 0.99 * std::numbers::pi;
    require(good, fmt::format("The camera's opening angle is {} rad, but must be between 0 and π.", fovY));
  }

  void place(const Vec3& eye, const Vec3& target, const Vec3& up) {
    require(eye.allFinite() && target.allFinite() && (target - eye).norm() > 0, "The camera's eye and target must be different places.");
    direction("camera's up", up);
  }

  void direction(std::string_view what, const Vec3& v) {
    require(v.allFinite() && v.norm() > 0, fmt::format("The {} must be a direction, not zero.", what));
  }

  void throwIfAny() && {
    if (!list_.empty()) throw Error(ErrorKind::scene, std::move(list_));
  }

 private:
  std::vector<Diagnostic> list_;
};

struct CheckCamera {
  Complaints& complaints;

  void operator()(const AutoCamera& c) const {
    complaints.opening(c.fovY);
    complaints.direction("camera's up", c.up);
    complaints.range("camera's elevation (rad)", c.elevation, -1.5708, 1.5708);
    complaints.range("camera's margin", c.margin, 0, 0.45);
  }
  void operator()(const FixedCamera& c) const {
    complaints.opening(c.fovY);
    complaints.place(c.eye, c.target, c.up);
  }
  void operator()(const OrbitCamera& c) const {
    complaints.opening(c.fovY);
    complaints.direction("camera's up", c.up);
    complaints.range("camera's elevation (rad)", c.elevation, -1.5708, 1.5708);
    complaints.require(c.distance > 0 && std::isfinite(c.distance), "The camera's distance must be positive.");
  }
  void operator()(const KeyFrameCamera& c) const {
    complaints.require(!c.frames.empty(), "A camera with key frames needs at least one.");
    for (std::size_t k = 0; k < c.frames.size(); ++k) {
      complaints.opening(c.frames[k].fovY);
      complaints.place(c.frames[k].eye, c.frames[k].target, c.frames[k].up);
      complaints.require(k == 0 || c.frames[k].time > c.frames[k - 1].time, "The camera's key frames must be in ascending order of time.");
    }
  }
};

}  // namespace

void checkStyle(const Style& style) {
  Complaints complaints;
  complaints.range("picture's width", style.picture.width, 16, 8192);
  complaints.range("picture's height", style.picture.height, 16, 8192);
  const int samples = samplesAlongSide(style.picture.quality) * std::max(style.picture.width, style.picture.height);
  complaints.require(samples <= mostSamples,
                     fmt::format("The picture needs {} samples along a side at this quality, but the most is {}.", samples, mostSamples));
  complaints.direction("direction of the light", style.light.from);
  complaints.range("strength of the sun", style.light.sun, 0, 4);
  complaints.range("strength of the sky", style.light.sky, 0, 4);
  complaints.range("strength of the shadows", style.light.shadowStrength, 0, 1);
  complaints.range("softness of the shadows", style.light.softness, 0, 0.2);
  complaints.range("strength of the ambient occlusion", style.light.occlusionStrength, 0, 2);
  if (style.grains.range) {
    const auto [low, high] = *style.grains.range;
    complaints.require(std::isfinite(low) && std::isfinite(high) && low < high,
                       fmt::format("The range of the colours, {} to {}, must run from a smaller to a larger number.", low, high));
  }
  complaints.range("number of decimals of the time stamp", style.overlay.timeDecimals, 0, 9);
  if (style.overlay.slowMotion) complaints.range("slow motion factor", *style.overlay.slowMotion, 1e-9, 1e9);
  std::visit(CheckCamera{complaints}, style.camera);
  std::move(complaints).throwIfAny();
}

}  // namespace tsubu::render
