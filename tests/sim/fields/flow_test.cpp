// The flows against their own formulas: half the curl is what central differences of the velocity say.

#include "sim/fields/flow.h"

#include <gtest/gtest.h>

namespace tsubu::sim {
namespace {

Vec3 velocityAt(const FlowField& flow, const Vec3& x) {
  const V3 u = flow.at({x.x(), x.y(), x.z()}).velocity;
  return {u.x, u.y, u.z};
}

Vec3 halfCurl(const FlowField& flow, const Vec3& x) {
  const double h = 1e-5;
  Mat3 gradient;  // column k: ∂u/∂x_k
  for (int k = 0; k < 3; ++k)
    gradient.col(k) = (velocityAt(flow, x + h * Vec3::Unit(k)) - velocityAt(flow, x - h * Vec3::Unit(k))) / (2 * h);
  return 0.5 * Vec3(gradient(2, 1) - gradient(1, 2), gradient(0, 2) - gradient(2, 0), gradient(1, 0) - gradient(0, 1));
}

void turnsAsItsVelocitySays(const Flow& kind, const Vec3& x) {
  const FlowField flow(kind);
  const V3 t = flow.at({x.x(), x.y(), x.z()}).turning;
  EXPECT_LT((Vec3(t.x, t.y, t.z) - halfCurl(flow, x)).norm(), 1e-8);
}

const Vec3 somewhere{0.3, -0.7, 0.4}, point{0.1, 0.2, -0.3}, axis{1, -2, 0.5};

TEST(Flow, Uniform) {
  EXPECT_EQ(velocityAt(FlowField(UniformFlow{{1, 2, -3}}), somewhere), Vec3(1, 2, -3));
  turnsAsItsVelocitySays(UniformFlow{{1, 2, -3}}, somewhere);
}

TEST(Flow, ShearSlidesAlongItsDirection) {
  const ShearFlow shear{point, {2, 0, 0}, {0, 3, 4}, 5};
  const Vec3 expected = 5 * (somewhere - point).dot(Vec3(0, 0.6, 0.8)) * Vec3::UnitX();
  EXPECT_LT((velocityAt(FlowField(shear), somewhere) - expected).norm(), 1e-14);
  turnsAsItsVelocitySays(shear, somewhere);
}

TEST(Flow, VortexTurnsLikeARigidBody) {
  const VortexFlow vortex{point, axis, -3};
  EXPECT_LT((velocityAt(FlowField(vortex), somewhere) - (-3 * axis.normalized()).cross(somewhere - point)).norm(), 1e-14);
  turnsAsItsVelocitySays(vortex, somewhere);
}

TEST(Flow, PipeHasPoiseuillesProfileAndRestsOutside) {
  const PipeFlow pipe{point, axis, 1.2, 0.7};
  const Vec3 a = axis.normalized(), off = somewhere - point - (somewhere - point).dot(a) * a;
  ASSERT_LT(off.norm(), 1.2);
  EXPECT_LT((velocityAt(FlowField(pipe), somewhere) - 0.7 * (1 - off.squaredNorm() / 1.44) * a).norm(), 1e-14);
  turnsAsItsVelocitySays(pipe, somewhere);
  const Vec3 outside = point + 1.21 * a.unitOrthogonal();
  EXPECT_EQ(velocityAt(FlowField(pipe), outside), Vec3(Vec3::Zero()));
  turnsAsItsVelocitySays(pipe, outside + 0.1 * a.unitOrthogonal());
}

}  // namespace
}  // namespace tsubu::sim
