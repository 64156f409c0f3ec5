#include "sim/insertion/stream.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tsubu::sim {
namespace {

const IsFree always = [](const Vec3&, double) { return true; };

Stream rain() {
  Stream stream;
  stream.region = {BoxRegion{Vec3::Zero(), Vec3::Ones()}};
  stream.radii = {ConstantRadius{0.01}};
  stream.grainsPerSecond = 200;
  return stream;
}

std::vector<Grain> run(const Stream& stream, double step, int steps, const IsFree& isFree = always) {
  StreamProgress progress;
  std::vector<Grain> grains;
  for (int i = 1; i <= steps; ++i) {
    std::vector<Grain> now;  // as if the grains of earlier steps had moved away
    stream.emit(1, 0, 2500, i * step, isFree, progress, now);
    grains.insert(grains.end(), now.begin(), now.end());
  }
  EXPECT_EQ(progress.emitted, grains.size());
  return grains;
}

// 200 a second for 2 s are 400, whatever the step; a step much longer than the time between grains brings many at once.
TEST(Stream, NumberRateHoldsForEveryStep) {
  Stream stream = rain();
  for (const double step : {1e-4, 1e-3, 0.0101, 0.1, 0.5}) {
    SCOPED_TRACE(step);
    const int steps = static_cast<int>(std::lround(2 / step));
    EXPECT_EQ(run(stream, step, steps).size(), static_cast<std::size_t>(std::ceil(200 * step * steps * (1 - 1e-12))));
  }
}

TEST(Stream, TheStepDoesNotChangeTheGrains) {
  const auto a = run(rain(), 1e-3, 1000), b = run(rain(), 2.5e-4, 4000);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].position, b[i].position);
    EXPECT_EQ(a[i].radius, b[i].radius);
  }
}

// The mass never lags by more than a step's worth, nor leads by more than one grain.
TEST(Stream, MassRateHolds) {
  Stream stream = rain();
  stream.grainsPerSecond = 0;
  stream.kilogramsPerSecond = 0.5;
  stream.radii = {UniformRadius{0.005, 0.015}};
  double mass = 0;
  for (const Grain& g : run(stream, 1e-3, 5000)) mass += 2500 * 4.0 / 3.0 * std::numbers::pi * std::pow(g.radius, 3);
  EXPECT_NEAR(mass, 0.5 * 5, 2500 * 4.0 / 3.0 * std::numbers::pi * std::pow(0.015, 3));
}

TEST(Stream, StartEndAndCount) {
  Stream stream = rain();
  stream.start = 0.5;
  EXPECT_EQ(run(stream, 1e-3, 500).size(), 0u);
  EXPECT_EQ(run(stream, 1e-3, 1000).size(), 100u);
  stream.end = 0.75;
  EXPECT_EQ(run(stream, 1e-3, 2000).size(), 50u);
  stream.count = 7;
  EXPECT_EQ(run(stream, 1e-3, 2000).size(), 7u);
}

TEST(Stream, GrainsAreInsideAndApartFromEachOther) {
  Stream stream = rain();
  stream.radii = {UniformRadius{0.02, 0.06}};
  StreamProgress progress;
  std::vector<Grain> grains;
  stream.emit(1, 0, 2500, 0.5, always, progress, grains);  // 100 at once
  EXPECT_EQ(grains.size(), 100u);
  for (std::size_t i = 0; i < grains.size(); ++i) {
    EXPECT_TRUE(stream.region.containsSphere(grains[i].position, grains[i].radius));
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE((grains[i].position - grains[j].position).norm(), grains[i].radius + grains[j].radius);
  }
}

// Blocked for a second, the stream waits with the same grain and then catches up.
TEST(Stream, WhatFindsNoPlaceComesLater) {
  const Stream stream = rain();
  bool open = false;
  const IsFree gate = [&open](const Vec3&, double) { return open; };
  StreamProgress progress;
  std::vector<Grain> grains;
  for (int i = 1; i <= 1000; ++i) stream.emit(1, 0, 2500, i * 1e-3, gate, progress, grains);
  EXPECT_EQ(grains.size(), 0u);
  EXPECT_GT(progress.attempts, 1000u);
  open = true;
  for (int i = 1001; i <= 2000; ++i) stream.emit(1, 0, 2500, i * 1e-3, gate, progress, grains);
  EXPECT_EQ(grains.size(), 400u);
}

// A region that can hold only one grain at a time brings no second one, and does not hang.
TEST(Stream, AFullRegionDoesNotHang) {
  Stream stream = rain();
  stream.radii = {ConstantRadius{0.4}};
  StreamProgress progress;
  std::vector<Grain> grains;
  stream.emit(1, 0, 2500, 100, always, progress, grains);
  EXPECT_EQ(grains.size(), 1u);
}

TEST(Stream, SeedsAndStreamsDiffer) {
  const auto first = [](std::uint64_t seed, std::size_t index) {
    StreamProgress progress;
    std::vector<Grain> grains;
    rain().emit(seed, index, 2500, 0.001, always, progress, grains);
    return grains.at(0).position;
  };
  EXPECT_EQ(first(1, 0), first(1, 0));
  EXPECT_NE(first(1, 0), first(2, 0));
  EXPECT_NE(first(1, 0), first(1, 1));
}

// Velocities spread evenly over ±s: variance s²/3; orientations are unit quaternions with mean zero.
TEST(Stream, VelocitiesSpreadAndOrientationsAreRandom) {
  Stream stream = rain();
  stream.velocity = Vec3(0, 0, -2);
  stream.velocitySpread = 0.3;
  stream.grainsPerSecond = 5000;
  const auto grains = run(stream, 1e-3, 1000);
  ASSERT_EQ(grains.size(), 5000u);
  double mean = 0, variance = 0;
  Eigen::Vector4d orientation = Eigen::Vector4d::Zero();
  for (const Grain& g : grains) {
    EXPECT_LE(std::abs(g.velocity.z() + 2), 0.3);
    mean += g.velocity.z() / 5000;
    variance += (g.velocity.z() + 2) * (g.velocity.z() + 2) / 5000;
    EXPECT_NEAR(g.orientation.norm(), 1, 1e-12);
    orientation += g.orientation.coeffs() / 5000;
  }
  EXPECT_NEAR(mean, -2, 5 * 0.3 / std::sqrt(3.0 * 5000));
  EXPECT_NEAR(variance, 0.03, 0.003);
  EXPECT_LT(orientation.norm(), 5 * 1 / std::sqrt(5000.0));
}

}  // namespace
}  // namespace tsubu::sim
