#include "sim/laws/damping_from_restitution.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace tsubu::sim {
namespace {

struct Point {
  double x, v;
};

// x″ + 2ζ x′ + x = 0, the contact in units of its own frequency; x is the overlap.
Point rungeKutta(Point p, double zeta, double h) {
  const auto slope = [zeta](Point q) { return Point{q.v, -q.x - 2 * zeta * q.v}; };
  const auto plus = [](Point q, double s, Point d) { return Point{q.x + s * d.x, q.v + s * d.v}; };
  const Point a = slope(p), b = slope(plus(p, h / 2, a)), c = slope(plus(p, h / 2, b)), d = slope(plus(p, h, c));
  return {p.x + h / 6 * (a.x + 2 * b.x + 2 * c.x + d.x), p.v + h / 6 * (a.v + 2 * b.v + 2 * c.v + d.v)};
}

/// Speed after a contact that began with speed 1: integrated in steps of 1e-3 until the end of the contact, which is then found by
/// bisection of the last step. The contact ends when the grains part (tension), or when the force is no longer positive.
double integratedRestitution(double zeta, bool tension) {
  const auto over = [&](Point p) { return tension ? p.x <= 0 : p.x + 2 * zeta * p.v <= 0; };
  Point p = rungeKutta({0, 1}, zeta, 1e-3);
  for (int step = 0; step < 1000000; ++step) {
    const Point next = rungeKutta(p, zeta, 1e-3);
    if (over(next)) {
      double low = 0, high = 1e-3;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (over(rungeKutta(p, zeta, middle)) ? high : low) = middle;
      }
      return -rungeKutta(p, zeta, high).v;
    }
    p = next;
  }
  return 0;  // never parts
}

TEST(DampingFromRestitution, WithTensionAgreesWithIntegration) {
  for (const double zeta : {0.001, 0.05, 0.3, 0.6, 0.8, 0.9})
    EXPECT_NEAR(restitutionOf(zeta, true), integratedRestitution(zeta, true), 1e-8) << zeta;
  EXPECT_EQ(restitutionOf(1.0, true), 0.0);
  EXPECT_EQ(restitutionOf(3.0, true), 0.0);
}

TEST(DampingFromRestitution, WithoutTensionAgreesWithIntegrationInAllBranches) {
  // Schwager & Pöschel 2007: ζ < 1/√2, up to 1, beyond 1.
  for (const double zeta : {0.001, 0.05, 0.3, 0.5, 0.7, 0.7071, 0.708, 0.8, 0.95, 0.9999, 1.0, 1.0001, 1.1, 2.0, 10.0})
    EXPECT_NEAR(restitutionOf(zeta, false), integratedRestitution(zeta, false), 1e-8) << zeta;
}

TEST(DampingFromRestitution, BranchesMeetWithoutAStep) {
  for (const double joint : {1 / std::numbers::sqrt2, 1.0}) {
    const double middle = restitutionOf(joint, false);
    for (const double h : {1e-6, 1e-9, 1e-12}) {
      // The slope de/dζ is of order one here, so the two sides may differ by no more than a few h.
      EXPECT_NEAR(restitutionOf(joint - h, false), middle, 5 * h + 1e-9);
      EXPECT_NEAR(restitutionOf(joint + h, false), middle, 5 * h + 1e-9);
    }
  }
  EXPECT_NEAR(restitutionOf(1.0, false), std::exp(-2.0), 1e-15);
}

TEST(DampingFromRestitution, IsTheInverseOfRestitution) {
  for (const bool tension : {false, true})
    for (const double e : {1e-6, 1e-3, 0.01, 0.05, 0.1, 0.135, 0.136, 0.3, 0.5, 0.9, 0.99, 0.999999})
      EXPECT_NEAR(restitutionOf(dampingRatio(e, tension), tension), e, 1e-12) << e << (tension ? " with" : " without") << " tension";
}

TEST(DampingFromRestitution, ElasticIsExactlyWithoutDamping) {
  EXPECT_EQ(dampingRatio(1.0, true), 0.0);
  EXPECT_EQ(dampingRatio(1.0, false), 0.0);
  EXPECT_EQ(restitutionOf(0.0, true), 1.0);
  EXPECT_EQ(restitutionOf(0.0, false), 1.0);
}

// Note (B.9): η = −2 ln e √(m k/(π² + ln² e)), that is ζ = −ln e/√(π² + ln² e).
TEST(DampingFromRestitution, WithTensionIsTheFormulaOfTheNote) {
  for (const double e : {0.05, 0.5, 0.9}) {
    const double l = std::log(e);
    EXPECT_NEAR(dampingRatio(e, true), -l / std::sqrt(std::numbers::pi * std::numbers::pi + l * l), 1e-15);
  }
}

TEST(DampingFromRestitution, MoreDampingIsNeededWithTensionForbidden) {
  // Cutting off the pull leaves speed: for small damping, the same e needs more of it… but only of second order. At e = 0.05 a
  // pulling contact is under-damped and one that may not pull over-damped.
  EXPECT_LT(dampingRatio(0.05, true), 1.0);
  EXPECT_GT(dampingRatio(0.05, false), 1.0);
  for (const double e : {0.1, 0.5, 0.9, 0.99}) EXPECT_GT(dampingRatio(e, false), dampingRatio(e, true)) << e;
}

}  // namespace
}  // namespace tsubu::sim
