#include "sim/diagnostics/sphere_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"

namespace tsubu::sim {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double whole = 4 * pi / 3;
constexpr double inf = std::numeric_limits<double>::infinity();

// Of the unit sphere by quadrature: exact along x, the midpoint rule over y and z. The integrand has a root at its border: error ~ h^(3/2).
double byQuadrature(double a, double b, double c) {
  constexpr int n = 500;
  const double y0 = std::max(b, -1.0), z0 = std::max(c, -1.0), hy = (1 - y0) / n, hz = (1 - z0) / n;
  double sum = 0;
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < n; ++k) {
      const double y = y0 + (j + 0.5) * hy, z = z0 + (k + 0.5) * hz, rest = 1 - y * y - z * z;
      if (rest <= 0) continue;
      const double x = std::sqrt(rest);
      sum += std::max(0.0, x - std::max(a, -x));
    }
  }
  return sum * hy * hz;
}

TEST(SphereBox, OctantsHalvesAndCapsAreFormulas) {
  EXPECT_NEAR(volumeBeyond(0, 0, 0), whole / 8, 1e-15);
  EXPECT_NEAR(volumeBeyond(-1, -1, 0), whole / 2, 1e-15);
  EXPECT_NEAR(volumeBeyond(0, -1, 0), whole / 4, 1e-15);
  for (const double a : {-0.9, -0.3, 0.2, 0.77}) {
    const double cap = pi / 3 * (1 - a) * (1 - a) * (2 + a);
    EXPECT_NEAR(volumeBeyond(a, -1, -1), cap, 1e-14);
    EXPECT_NEAR(volumeBeyond(-1, a, -2), cap, 1e-14);
    EXPECT_NEAR(volumeBeyond(-5, -1, a), cap, 1e-14);
  }
  EXPECT_EQ(volumeBeyond(0.6, 0.6, 0.6), 0);
  EXPECT_EQ(volumeBeyond(1, -1, -1), 0);
}

TEST(SphereBox, CornersAgreeWithQuadrature) {
  Random random(5, 1);
  for (int trial = 0; trial < 25; ++trial) {
    const double a = random.uniform(-1, 0.8), b = random.uniform(-1, 0.8), c = random.uniform(-1, 0.8);
    EXPECT_NEAR(volumeBeyond(a, b, c), byQuadrature(a, b, c), 2e-5) << a << ' ' << b << ' ' << c;
  }
}

TEST(SphereBox, PartsAddUpToTheSphere) {
  Random random(6, 1);
  for (int trial = 0; trial < 50; ++trial) {
    const double r = random.uniform(0.5, 3);
    const Vec3 centre(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    std::array<std::array<double, 5>, 3> cuts{};
    for (auto& axis : cuts) {
      for (double& cut : axis) cut = random.uniform(-4, 4);
      std::sort(axis.begin(), axis.end());
      axis.front() = -inf, axis.back() = inf;
    }
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t k = 0; k < 4; ++k)
          sum +=
              volumeWithin(Box(Vec3(cuts[0][i], cuts[1][j], cuts[2][k]), Vec3(cuts[0][i + 1], cuts[1][j + 1], cuts[2][k + 1])), centre, r);
    EXPECT_NEAR(sum, whole * r * r * r, 3e-14 * r * r * r);
  }
}

TEST(SphereBox, InsideOutsideAndABoxWithinTheSphere) {
  const Vec3 centre(1, 2, 3);
  EXPECT_NEAR(volumeWithin(Box(Vec3(0, 1, 2), Vec3(2, 3, 4)), centre, 0.9), whole * 0.729, 1e-14);
  EXPECT_EQ(volumeWithin(Box(Vec3(2.1, 1, 2), Vec3(3, 3, 4)), centre, 1), 0);
  EXPECT_NEAR(volumeWithin(Box(centre + Vec3(-0.1, 0.05, -0.2), centre + Vec3(0.2, 0.1, 0.1)), centre, 1), 0.3 * 0.05 * 0.3, 1e-14);
}

}  // namespace
}  // namespace tsubu::sim
