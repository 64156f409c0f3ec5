#include "sim/fields/field_source.h"

#include <cmath>

#include "sim/fields/dipole.h"

namespace tsubu::sim {

namespace {

/// Complex numbers by hand: the library's product takes care of infinities and is slow.
struct Complex {
  double re, im;
};
Complex operator*(Complex a, Complex b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }

struct Adds {
  const Vec3& x;
  FieldAt& sum;

  void operator()(const UniformSource& s) const { sum.field += s.field; }

  void operator()(const GradientSource& s) const {
    const Vec3 a = s.axis.normalized(), d = x - s.point;
    const Mat3 gradient = s.gradient * (1.5 * a * a.transpose() - 0.5 * Mat3::Identity());
    sum.field += gradient * d;
    sum.gradient += gradient;
  }

  void operator()(const DipoleSource& s) const {
    const Vec3 d = x - s.point, n = d.normalized();
    const double distance2 = d.squaredNorm(), along = s.moment.dot(n), strength = magneticConstant / (distance2 * d.norm());
    sum.field += strength * (3 * along * n - s.moment);
    const Mat3 product = s.moment * n.transpose();
    sum.gradient += 3 * strength / d.norm() * (along * Mat3::Identity() + product + product.transpose() - 5 * along * n * n.transpose());
  }

  // Outside, B_ξ − i B_η is analytic in ζ = ξ + iη: B (R/ζ)^(n+1), and so is its derivative.
  void operator()(const RollerSource& s) const {
    const Vec3 a = s.axis.normalized(), d = x - s.point, e1 = (s.north - s.north.dot(a) * a).normalized(), e2 = a.cross(e1);
    const double xi = d.dot(e1) / s.radius, eta = d.dot(e2) / s.radius, square = xi * xi + eta * eta;
    const Complex inverse{xi / square, -eta / square};
    Complex f{s.field, 0};
    for (int k = 0; k <= s.pairs; ++k) f = f * inverse;
    const Complex slope = Complex{-(s.pairs + 1) / s.radius, 0} * f * inverse;
    sum.field += f.re * e1 - f.im * e2;
    const Mat3 mixed = e1 * e2.transpose();
    sum.gradient += slope.re * (e1 * e1.transpose() - e2 * e2.transpose()) - slope.im * (mixed + mixed.transpose());
  }
};

}  // namespace

void addField(const FieldSource& source, const Vec3& x, FieldAt& sum) { std::visit(Adds{x, sum}, source.kind); }

void addMovedField(const FieldSource& source, const Pose& pose, const Twist& twist, const Vec3& x, FieldAt& sum) {
  FieldAt local;
  addField(source, pose.toLocal(x), local);
  const Mat3 rotation = pose.rotation.toRotationMatrix();
  const Vec3 field = rotation * local.field;
  const Mat3 gradient = rotation * local.gradient * rotation.transpose();
  sum.field += field;
  sum.gradient += gradient;
  sum.change += twist.angularVelocity.cross(field) - gradient * twist.at(x);
}

}  // namespace tsubu::sim
