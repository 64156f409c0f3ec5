#include "sim/fields/flow.h"

namespace tsubu::sim {

namespace {
V3 v3(const Vec3& a) { return {a.x(), a.y(), a.z()}; }
}  // namespace

FlowField::FlowField(const Flow& flow) {
  struct {
    FlowField& f;
    void operator()(const UniformFlow& u) const { f.uniform_ = v3(u.velocity); }
    void operator()(const ShearFlow& u) const {
      f.point_ = v3(u.point);
      f.direction_ = v3(u.rate * u.direction.normalized());
      f.gradient_ = v3(u.gradient.normalized());
      f.turning_ = 0.5 * cross(f.gradient_, f.direction_);
    }
    void operator()(const VortexFlow& u) const {
      f.point_ = v3(u.point);
      f.spin_ = f.turning_ = v3(u.angularSpeed * u.axis.normalized());
    }
    void operator()(const PipeFlow& u) const {
      f.point_ = v3(u.point);
      f.axis_ = v3(u.axis.normalized());
      f.inverseRadius2_ = 1 / (u.radius * u.radius);
      f.speed_ = u.speed;
    }
  } fill{*this};
  std::visit(fill, flow);
}

FlowAt FlowField::at(V3 x) const {
  const V3 d = x - point_;
  FlowAt flow{uniform_ + dot(d, gradient_) * direction_ + cross(spin_, d), turning_};
  if (speed_ != 0) {
    const V3 off = d - dot(d, axis_) * axis_;
    const double share = 1 - inverseRadius2_ * norm2(off);
    if (share > 0) {
      flow.velocity = flow.velocity + (speed_ * share) * axis_;
      flow.turning = flow.turning - (speed_ * inverseRadius2_) * cross(off, axis_);
    }
  }
  return flow;
}

}  // namespace tsubu::sim
