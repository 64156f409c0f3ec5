#include <gtest/gtest.h>

#include <cmath>

#include "scene/build.h"
#include "scene/reader.h"
#include "scenes.h"

namespace tsubu::scene {
namespace {

FramePlan planned(const Overrides& overrides) { return build(readText(shortScene, "scene.toml", overrides)).plan; }

TEST(FramePlan, FramesAndLedgerRowsAreWholeNumbersOfSteps) {
  for (const char* ledger : {"auto", "\"0.1 s\"", "\"10 ms\"", "\"1 ms\""}) {
    for (const char* interval : {"\"10 ms\"", "\"20 ms\"", "\"100 ms\""}) {
      SCOPED_TRACE(std::string(ledger) + " " + interval);
      const FramePlan plan = planned({std::string("output.frame_interval=") + interval, std::string("output.ledger_interval=") + ledger});
      EXPECT_NEAR(static_cast<double>(plan.stepsPerFrame) * plan.timeStep, plan.interval, 1e-12 * plan.interval);
      EXPECT_NEAR(static_cast<double>(plan.stepsPerLedgerRow) * plan.timeStep, plan.ledgerInterval, 1e-12 * plan.ledgerInterval);
      EXPECT_NEAR(static_cast<double>(plan.steps) * plan.timeStep, 1.0, plan.timeStep);
      EXPECT_EQ(plan.frames, static_cast<std::uint64_t>(std::llround(1 / plan.interval)) + 1);
    }
  }
}

TEST(FramePlan, TheStepIsShortenedAndNeverLengthened) {
  for (const double given : {1e-5, 1.3e-5, 0.9999e-5, 3e-6}) {
    const FramePlan plan = planned({"simulation.time_step=" + std::to_string(given * 1e6) + " us"});
    EXPECT_LE(plan.timeStep, given * (1 + 1e-6));
    EXPECT_GT(plan.timeStep, 0.99 * given);
  }
}

// A glass sphere of 2 mm: m = 4/3 π r³ ρ; the bound Σ ω_c² over twelve contacts of k (1/m + 1/m) is below the undamped single
// contact by √12 and damping only lowers it (docs/physics.md, S2 and S3).
TEST(FramePlan, AutomaticStepIsTheSafetyTimesTheLimit) {
  const double mass = 4.0 / 3.0 * M_PI * 8e-9 * 2500, undamped = 2 / std::sqrt(12 * 1000 * 2 / mass);
  const FramePlan plan = planned({"simulation.safety=0.1"});
  EXPECT_LT(plan.limit, undamped);
  EXPECT_GT(plan.limit, 0.2 * undamped);
  EXPECT_LE(plan.timeStep, 0.1 * plan.limit);
  EXPECT_GT(plan.timeStep, 0.099 * plan.limit);
}

// 1000 m/s, 2 mm: half of a tenth of the radius per step is 1e-7 s.
TEST(FramePlan, FastGrainsShortenTheStep) {
  const FramePlan plan = planned({"grains.bed.velocity=[1000, 0, 0]"});
  EXPECT_LE(plan.timeStep, 1e-7);
  EXPECT_GT(plan.timeStep, 0.99e-7);
  EXPECT_EQ(plan.limitedBy.substr(0, 5), "speed");
}

TEST(FramePlan, SlowMotionStretchesTheFilm) {
  EXPECT_EQ(planned({"output.slow_motion=5"}).interval, 1.0 / 150);
  EXPECT_EQ(planned({"output.slow_motion=5"}).frames, 151u);
}

TEST(FramePlan, ARunShorterThanAFrameHasOne) {
  const FramePlan plan = planned({"simulation.end=1 ms"});
  EXPECT_EQ(plan.frames, 1u);
  EXPECT_GE(static_cast<double>(plan.steps) * plan.timeStep, 1e-3 * (1 - 1e-9));
}

}  // namespace
}  // namespace tsubu::scene
