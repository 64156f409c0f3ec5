#include "core/portable_math.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/hash.h"
#include "core/random.h"

namespace tsubu {
namespace {

// One number for all processors and C libraries: with the functions for doubles it is another where glibc does without fused
// multiply–add (GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4).
TEST(PortableMath, HasTheSameBitsEverywhere) {
  Hash hash;
  Random random(1, 2);
  for (int k = 0; k < 20000; ++k) {
    const double x = random.uniform(0, 30), y = random.uniform(-1, 1);
    for (const double value : {portable::exp(-x), portable::log(x), portable::sin(x), portable::cos(x), portable::tan(y), portable::cbrt(x),
                               portable::atan2(y, x), portable::atan2(y, -x)})
      hash.add(value);
  }
  EXPECT_EQ(hash.value(), 2996267956918482178U);
}

TEST(PortableMath, IsThatOfTheLibraryToTheLastBit) {
  Random random(3, 4);
  for (int k = 0; k < 1000; ++k) {
    const double x = random.uniform(0, 30);
    EXPECT_DOUBLE_EQ(portable::exp(-x), std::exp(-x));
    EXPECT_DOUBLE_EQ(portable::log(x), std::log(x));
    EXPECT_DOUBLE_EQ(portable::sin(x), std::sin(x));
    EXPECT_DOUBLE_EQ(portable::cos(x), std::cos(x));
    EXPECT_DOUBLE_EQ(portable::cbrt(x), std::cbrt(x));
    EXPECT_DOUBLE_EQ(portable::tan(x / 30), std::tan(x / 30));
    EXPECT_DOUBLE_EQ(portable::atan2(x - 15, -x), std::atan2(x - 15, -x));
  }
}

TEST(PortableMath, TurnsAsARightHandDoes) {
  const Vec3 axis = Vec3(1, -2, 3).normalized(), v(0.3, 0.7, -0.2);
  for (const double angle : {0.0, 0.4, -2.5, 9.0}) {
    const Vec3 across = v - axis.dot(v) * axis;
    const Vec3 exact = axis.dot(v) * axis + std::cos(angle) * across + std::sin(angle) * axis.cross(v);
    EXPECT_LT((portable::turnBy(angle, axis) * v - exact).norm(), 1e-15);
  }
  EXPECT_LT((portable::turnBy(std::numbers::pi / 2, Vec3::UnitZ()) * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
}

}  // namespace
}  // namespace tsubu
