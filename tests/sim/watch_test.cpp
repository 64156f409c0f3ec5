// What the simulation says when things go wrong, and what it does at the edges of sense.

#include <gtest/gtest.h>

#include "core/error.h"
#include "verification/models.h"
#include "verification/shapes.h"

namespace tsubu::sim {
namespace {

using test::look;
using test::Scenario;

Scenario smooth(double k = 1000) {
  Scenario s;
  s.pair[Property::normalStiffness] = k;
  s.pair[Property::restitution] = 0.8;
  s.model.watch = Watch{};
  return s;
}

std::string failureOf(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::simulation);
    return error.what();
  }
  return {};
}

TEST(Watch, OverlapStopsTheRunAndNamesTheGrain) {
  Scenario s = smooth(1);
  s.grain(1e-5, 1e-3, {0, 0, 1e-3}, {0, 0, -0.3});
  s.plane({0, 0, 0}, {0, 0, 1});
  Simulation sim = s.start(1e-5);
  const std::string message = failureOf([&] { sim.advance(10000); });
  EXPECT_NE(message.find("Overlap"), std::string::npos) << message;
  EXPECT_NE(message.find("grain 0"), std::string::npos) << message;
  EXPECT_NE(message.find("wall 'plane0'"), std::string::npos) << message;
  EXPECT_NE(message.find("too soft"), std::string::npos) << message;
}

TEST(Watch, OverlapAtTheStartIsSaidToBeThat) {
  Scenario s = smooth();
  s.grain(1e-5, 1e-3, {0, 0, 0});
  s.grain(1e-5, 1e-3, {1e-3, 0, 0});
  const std::string message = failureOf([&] { s.start(1e-6).advance(1); });
  EXPECT_NE(message.find("at the start"), std::string::npos) << message;
}

TEST(Watch, AFastGrainStopsTheRun) {
  Scenario s = smooth();
  s.grain(1e-5, 1e-3, {0, 0, 0}, {30, 0, 0});
  Simulation sim = s.start(1e-5);
  const std::string message = failureOf([&] { sim.advance(10); });
  EXPECT_NE(message.find("radius in one step"), std::string::npos) << message;
  EXPECT_NE(message.find("grain 0"), std::string::npos) << message;
}

TEST(Watch, NotANumberAlwaysStops) {
  for (const bool continuous : {false, true}) {
    Scenario s = smooth();
    s.model.watch.stop = false;
    s.model.continuous = continuous;
    s.grain(1e-5, 1e-3, {0, 0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
    const std::string message = failureOf([&] { s.start(1e-5).advance(3); });
    EXPECT_NE(message.find("Not a number"), std::string::npos) << message;
  }
}

TEST(Watch, WarnsOnceAndGoesOnWhenAsked) {
  Scenario s = smooth(1);
  s.model.watch.stop = false;
  s.grain(1e-5, 1e-3, {0, 0, 1e-3}, {0, 0, -0.3});
  s.plane({0, 0, 0}, {0, 0, 1});
  Simulation sim = s.start(1e-5);
  sim.advance(500);
  EXPECT_EQ(sim.warnings().size(), 1u);
}

TEST(Watch, WithoutALedgerItStillLooks) {
  Scenario s = smooth(1);
  s.model.ledger = false;
  s.grain(1e-5, 1e-3, {0, 0, 1e-3}, {0, 0, -0.3});
  s.plane({0, 0, 0}, {0, 0, 1});
  Simulation sim = s.start(1e-5);
  EXPECT_FALSE(failureOf([&] { sim.advance(10000); }).empty());
}

TEST(Watch, LeavingTheDomainIsALossWithAName) {
  Scenario s = smooth();
  s.model.domain = Box(Vec3(-0.01, -0.01, -0.01), Vec3(0.01, 0.01, 0.01));
  s.grain(1e-5, 1e-3, {0, 0, 0}, {1, 0, 0});
  s.grain(1e-5, 1e-3, {0, 5e-3, 0});
  Simulation sim = s.start(1e-5);
  sim.advance(2000);
  EXPECT_EQ(sim.grains(), 1u);
  ASSERT_EQ(sim.lostGrains().size(), 1u);
  EXPECT_EQ(sim.lostGrains()[0].id, 0u);
  EXPECT_NE(sim.lostGrains()[0].why.find("domain"), std::string::npos);
  EXPECT_EQ(sim.counts().lost, 1u);
  EXPECT_EQ(look(sim).id[0], 1u);
}

// A thin sheet and grains that move many times their radius in a step: wherever in the life of the neighbour lists the passage
// falls, it is noticed.
TEST(Watch, GoingThroughAThinWallIsNoticed) {
  for (const double skin : {0.0, 1e-4, 1e-2}) {
    for (int start = 0; start < 40; ++start) {
      Scenario s = smooth();
      s.model.watch.stop = false;
      s.model.skin = skin;
      s.model.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
      const double step = 3e-3;  // m; three radii
      s.grain(1e-5, 1e-3, {1e-3, 2e-3, 0.05 + step * start / 40.0}, {0, 0, -step / 1e-5});
      s.grain(1e-5, 1e-3, {3e-2, 2e-3, 0.01}, {0, 0, 0});
      s.wall(Surface(test::rectangle(-0.02, 0.02, -0.02, 0.02, 0, 2, 2)));
      Simulation sim = s.start(1e-5);
      sim.advance(60);
      if (look(sim).grains() == 2) {
        // It may also have been caught by the sheet and thrown back.
        EXPECT_GT(look(sim).position[0].z(), 0) << "skin " << skin << ", start " << start;
        continue;
      }
      ASSERT_EQ(sim.lostGrains().size(), 1u);
      EXPECT_EQ(sim.lostGrains()[0].id, 0u);
      EXPECT_NE(sim.lostGrains()[0].why.find("wall"), std::string::npos);
    }
  }
}

TEST(Edge, NoGrainsAtAll) {
  Scenario s = smooth();
  s.plane({0, 0, 0}, {0, 0, 1});
  Simulation sim = s.start(1e-5);
  sim.advance(100);
  EXPECT_EQ(sim.grains(), 0u);
  EXPECT_EQ(sim.contacts().touching, 0u);
  EXPECT_EQ(sim.ledger().mechanical(), 0);
  EXPECT_EQ(sim.ledger().residualFraction(), 0);
  EXPECT_EQ(look(sim).grains(), 0u);
}

TEST(Edge, OneGrainFallsForever) {
  Scenario s = smooth();
  s.model.gravity = {0, 0, -9.81};
  s.model.domain = Box(Vec3::Constant(-10), Vec3::Constant(10));
  s.grain(1e-5, 1e-3, {0, 0, 5});
  Simulation sim = s.start(1e-5);
  sim.advance(50000);
  EXPECT_NEAR(look(sim).position[0].z(), 5 - 0.5 * 9.81 * 0.25, 1e-8);
}

// Centres that coincide have no direction between them. The watch reports the overlap; nothing becomes not-a-number.
TEST(Edge, CoincidentCentres) {
  Scenario s = smooth();
  s.model.contact = {"linear", "spring", "elastic_plastic", false};
  s.pair[Property::friction] = 0.5;
  s.pair[Property::rollingFriction] = 0.1;
  s.grain(1e-5, 1e-3, {1e-3, 2e-3, 3e-3});
  s.grain(2e-5, 1e-3, {1e-3, 2e-3, 3e-3}, {0, 0, 0}, {1, 2, 3});
  EXPECT_NE(failureOf([&] { s.start(1e-6).advance(1); }).find("at the start"), std::string::npos);
  s.model.watch.stop = false;
  Simulation sim = s.start(1e-6);
  sim.advance(100);
  EXPECT_EQ(sim.warnings().size(), 1u);
  for (const Vec3& x : look(sim).position) EXPECT_TRUE(x.allFinite());
  EXPECT_TRUE(std::isfinite(sim.ledger().mechanical()));
}

TEST(Edge, CentreOnAWall) {
  Scenario s = smooth();
  s.model.contact = {"linear", "spring", "none", false};
  s.pair[Property::friction] = 0.5;
  s.model.watch.stop = false;
  s.model.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
  s.grain(1e-5, 1e-3, {0, 0, 0});
  s.wall(Surface(test::rectangle(-0.02, 0.02, -0.02, 0.02, 0, 1, 1)));
  Simulation sim = s.start(1e-6);
  sim.advance(1000);
  ASSERT_EQ(sim.grains(), 1u);
  EXPECT_GT(std::abs(look(sim).position[0].z()), 1e-4);  // pushed off
}

// The net number of grains that go through a plane: forth and back count nothing, outside the radius neither; looking does not count.
TEST(Counters, CountNetCrossings) {
  Scenario s = smooth();
  s.model.domain = Box(Vec3::Constant(-1), Vec3::Constant(1));
  s.model.counters.push_back({"gate", {0, 0, 0}, {0, 0, 1}, 0.01});
  s.model.counters.push_back({"all", {0, 0, 0}, {0, 0, 1}, std::numeric_limits<double>::infinity()});
  const double v = 0.5;
  s.grain(1e-5, 1e-3, {0, 0, -0.02}, {0, 0, v});           // through the gate
  s.grain(1e-5, 1e-3, {0.005, 0, 0.02}, {0, 0, -v});       // back through the gate
  s.grain(1e-5, 1e-3, {-0.005, 0, -0.02}, {0, 0, v});      // through the gate
  s.grain(1e-5, 1e-3, {0.05, 0, -0.02}, {0, 0, v});        // past it
  s.grain(1e-5, 1e-3, {-0.05, 0, -0.02}, {v, 0, v});       // past it, and drawing nearer
  s.grain(1e-5, 1e-3, {0, 0.009, -0.02}, {0, 0.0, v});     // through
  s.grain(1e-5, 1e-3, {0, -0.0085, -1e-4}, {0, -1, 0.1});  // through at its rim, a millisecond later far outside
  for (const bool looking : {false, true}) {
    Scenario same = s;
    same.model.skin = 0.02;
    Simulation sim = same.start(1e-5);
    for (int n = 0; n < 100; ++n) {
      sim.advance(100);
      if (looking) sim.ledger();
    }
    sim.ledger();
    EXPECT_EQ(sim.counts().crossed[0], 3) << (looking ? "looking" : "");
    EXPECT_EQ(sim.counts().crossed[1], 5) << (looking ? "looking" : "");
  }
}

TEST(Counters, MoreThanThirtyTwoAreRefused) {
  Scenario s = smooth();
  s.model.counters.resize(33, {"gate", Vec3::Zero(), Vec3::UnitZ(), 1.0});
  s.grain(1e-5, 1e-3, Vec3::Zero());
  EXPECT_THROW(s.start(1e-5), Error);
}

// A ball that bounces on one plane crosses another again and again: net, it is above or below.
TEST(Counters, ForthAndBackCountsNothing) {
  Scenario s = smooth();
  s.model.gravity = {0, 0, -9.81};
  s.pair[Property::restitution] = 1;
  s.model.counters.push_back({"above", {0, 0, 5e-3}, {0, 0, 1}, 1.0});
  s.grain(1e-5, 1e-3, {0, 0, 1e-2});
  s.plane({0, 0, 0}, {0, 0, 1});
  Simulation sim = s.start(1e-5);
  for (int n = 0; n < 200; ++n) {
    sim.advance(173);
    sim.ledger();
    EXPECT_EQ(sim.counts().crossed[0], look(sim).position[0].z() > 5e-3 ? 0 : -1);
  }
}

}  // namespace
}  // namespace tsubu::sim
