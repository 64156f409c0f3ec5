#include "study/tradeoff.h"

#include <cmath>
#include <mutex>

#include "core/error.h"
#include "core/random.h"
#include "scenes.h"
#include "study/report.h"

namespace tsubu::study {
namespace {

Request requestFor(const Folder& folder, const std::string& text) {
  Request request;
  request.scene = folder.file("scene.toml", text);
  request.folder = folder.path() / "study";
  request.version = "test";
  request.budget = 20;
  return request;
}

/// Runs trials as they are, but on a machine where a grain-step takes 0.1 us, whatever this one is busy with.
class EvenMachine {
 public:
  explicit EvenMachine(int threads = 1) : threads_(threads) {}

  Machine machine() {
    return {[this](const Trial& trial, const Stop& stop, const Watch& watch) { return runOne(trial, stop, watch); },
            [this] {
              const std::lock_guard lock(mutex_);
              return seconds_;
            }};
  }
  /// All the rest of this trial would take so long, s: the clock goes on before it has begun.
  std::function<double(const Trial&)> delay = [](const Trial&) { return 0.0; };

 private:
  std::optional<Outcome> runOne(const Trial& trial, const Stop& stop, const Watch& watch) {
    const double late = delay(trial);
    spend(late);
    if (watch && watch(0.01, late)) return std::nullopt;
    std::optional<Outcome> outcome = run(trial, stop);
    if (!outcome) return std::nullopt;
    outcome->cost = outcome->wall = late + 1e-7 * static_cast<double>(outcome->grainSteps);
    spend(outcome->cost - late);
    return outcome;
  }
  void spend(double seconds) {
    const std::lock_guard lock(mutex_);
    seconds_ += seconds / threads_;
  }

  int threads_;
  std::mutex mutex_;
  double seconds_ = 0;
};

Study made(const Request& request) { return tradeoff(request, {}, {}, EvenMachine(request.threads).machine()); }

/// d ln(error)/d ln(Δt) along the step axis, by its first and last places.
double orderOf(const Study& study) {
  const Point *fine = nullptr, *coarse = nullptr;
  for (const Point& point : study.points) {
    if (point.axis != "step") continue;
    if (!fine || point.at < fine->at) fine = &point;
    if (!coarse || point.at > coarse->at) coarse = &point;
  }
  const auto step = [](const Point& point) { return point.outcomes.at(1).timeStep; };
  return std::log(coarse->deviations[0].error / fine->deviations[0].error) / std::log(step(*coarse) / step(*fine));
}

// A grain that never leaves the floor is a damped oscillator: symplectic Euler is of first order there, velocity Verlet of second
// (docs/physics.md, I1, I2). The study must find it, and that nothing is random.
TEST(Tradeoff, FindsTheOrderOfTheScheme) {
  for (const auto& [integrator, order] : {std::pair{"symplectic_euler", 1.0}, std::pair{"velocity_verlet", 2.0}}) {
    const Folder folder("tradeoff");
    Request request = requestFor(folder, swinging);
    request.axes = {"step"};
    request.overrides = {std::string("simulation.integrator=") + integrator};
    const Study study = made(request);
    EXPECT_NEAR(orderOf(study), order, 0.15) << integrator;
    EXPECT_FALSE(study.random);
    EXPECT_EQ(study.seeds, 1);
  }
}

// A blow presses a spring in by v √(m/k) f(ζ): a softer one by 1/√factor more.
TEST(Tradeoff, SofterSpringsArePressedInDeeper) {
  const Folder folder("tradeoff");
  std::string text = swinging;
  text.replace(text.find("9.6 mm"), 6, "10 mm");
  text.replace(text.find("height ="), text.size(), "overlap = { kind = \"largest_overlap\" }\n");
  Request request = requestFor(folder, text);
  request.axes = {"stiffness"};
  request.overrides = {"simulation.gravity=[0, 0, 0]", "grains.ball.velocity=[0, 0, -0.1]", "output.ledger_interval=0.05 ms",
                       "output.frame_interval=0.05 ms"};
  const Study study = made(request);
  int seen = 0;
  for (const Point& point : study.points) {
    if (point.axis != "stiffness" || !point.ran() || !point.failure().empty()) continue;
    EXPECT_NEAR(point.deviations[0].error / (1 / std::sqrt(point.setting.softening) - 1), 1, 0.02) << point.label;
    EXPECT_FALSE(point.deviations[0].none());
    ++seen;
  }
  EXPECT_GE(seen, 3);
}

TEST(Tradeoff, ASecondCallRunsNothingAndSaysTheSame) {
  const Folder folder("tradeoff");
  Request request = requestFor(folder, heap);
  request.axes = {"step", "skin"};
  request.seeds = 2;
  request.threads = 2;
  const Study first = made(request), second = made(request);
  EXPECT_GT(first.ran, 10u);
  EXPECT_EQ(first.known, 0u);
  EXPECT_EQ(second.ran, 0u);
  EXPECT_EQ(second.known, first.ran);
  EXPECT_EQ(csvOf(first), csvOf(second));
  // Skins change nothing, and the study says so; a point that is the scene over again makes no difference.
  EXPECT_NE(tableOf(first).find("same bits"), std::string::npos) << tableOf(first);
}

TEST(Tradeoff, GoesOnWhereItWasInterrupted) {
  const Folder folder("tradeoff");
  Request request = requestFor(folder, heap);
  request.axes = {"step"};
  request.seeds = 2;
  std::size_t told = 0;
  const Study broken = tradeoff(
      request, [&] { return told >= 3; }, [&](const Progress&) { ++told; }, EvenMachine().machine());
  EXPECT_FALSE(broken.complete);
  EXPECT_EQ(broken.ran, 3u);
  EXPECT_NE(tableOf(broken).find("the same command goes on"), std::string::npos);
  const Study whole = made(request);
  EXPECT_TRUE(whole.complete);
  EXPECT_EQ(whole.known, 3u);
}

// All at the same step; a heap that falls notices friction.
TEST(Tradeoff, FeaturesAreComparedWithTheSceneAsItIs) {
  const Folder folder("tradeoff");
  Request request = requestFor(folder, heap);
  request.features = true;
  const Study study = made(request);
  ASSERT_GT(study.points.size(), 5u);
  for (const Point& point : study.points) {
    if (!point.ran()) continue;
    EXPECT_EQ(point.outcomes.at(1).timeStep, study.scene().outcomes.at(1).timeStep) << point.label;
    EXPECT_TRUE(point.label != "as it is" || point.deviations[0].error == 0);
    EXPECT_TRUE(point.label != "without friction" || !point.none());
  }
}

TEST(Tradeoff, AnotherSceneIsAnotherTrial) {
  const Folder folder("tradeoff");
  const Trial trial{folder.file("scene.toml", swinging), {}};
  const std::string key = keyOf(trial, "1");
  EXPECT_EQ(keyOf({trial.scene, {"colours.by=speed"}}, "1"), key);  // looks do not matter
  EXPECT_NE(keyOf({trial.scene, {"pairs.restitution=0.71"}}, "1"), key);
  EXPECT_NE(keyOf(trial, "2"), key);
}

TEST(Tradeoff, KeepsToItsBudget) {
  const Folder folder("tradeoff");
  Request request = requestFor(folder, heap);
  EvenMachine even;
  const double once = even.machine().run({request.scene, {}}, {}, {})->cost;
  request.budget = 40 * once;
  const Study study = made(request);
  EXPECT_FALSE(study.leftOut.empty());
  EXPECT_GT(study.used, 0.7 * request.budget);
  EXPECT_LT(study.used, 1.02 * request.budget);
  request.budget = 2 * once;
  EXPECT_THROW(made(request), Error);
}

// One setting takes much longer than could be foreseen: it is broken off when a tenth more than the budget is gone, and said to be left
// out.
TEST(Tradeoff, BreaksOffATrialThatTakesTooLong) {
  const Folder folder("tradeoff");
  Request request = requestFor(folder, heap);
  request.axes = {"stiffness"};
  request.seeds = 1;
  EvenMachine even;
  even.delay = [&](const Trial& trial) { return commandOf(trial).find("stiffness=15 ") == std::string::npos ? 0 : 1.2 * request.budget; };
  const Study study = tradeoff(request, {}, {}, even.machine());
  EXPECT_TRUE(study.complete);
  ASSERT_EQ(study.points.back().overrides, scene::Overrides{"pairs.normal_stiffness=5"});
  const std::size_t softest = study.points.size() - 1;
  EXPECT_TRUE(study.points[softest - 2].ran());
  EXPECT_FALSE(study.points[softest - 1].ran());
  EXPECT_EQ(study.leftOut, (std::vector{study.points[softest - 1].label, study.points[softest].label}));
}

// The first trial of all has run for 4 s and done a hundredth: four such trials are not to be had for 20 s.
TEST(Tradeoff, APilotThatTakesTooLongIsRefusedEarly) {
  const Folder folder("tradeoff");
  EvenMachine even;
  even.delay = [](const Trial&) { return 4.0; };
  try {
    tradeoff(requestFor(folder, heap), {}, {}, even.machine());
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("One trial takes about 400 s of CPU"), std::string::npos) << error.what();
  }
}

// More samples in a pixel cost more and come nearer to the finest picture; the finest is itself.
TEST(Tradeoff, PicturesAgainstTheFinest) {
  const Folder folder("tradeoff");
  const auto pictures =
      comparePictures({folder.file("scene.toml", heap), {"picture.width=320", "picture.height=192", "simulation.end=0.01"}}, {});
  ASSERT_TRUE(pictures && pictures->size() == 3);
  EXPECT_EQ(pictures->front().quality, "fine");
  EXPECT_EQ(pictures->front().error, 0);
  EXPECT_GT((*pictures)[1].error, 0);
  EXPECT_GT((*pictures)[2].error, (*pictures)[1].error);
  EXPECT_LT((*pictures)[2].error, 0.2);
  for (const auto& picture : *pictures) EXPECT_GT(picture.cost, 0) << picture.quality;  // which costs more is for a quiet machine to say
}

TEST(Tradeoff, WhatTheSceneCannotHaveIsRefusedWithTheReason) {
  const Folder folder("tradeoff");
  Request request = requestFor(folder, swinging);
  request.axes = {"law", "rolling"};
  const std::string table = tableOf(made(request));
  EXPECT_NE(table.find("not possible   hertz: The normal law 'hertz' needs 'young_modulus'"), std::string::npos) << table;
  EXPECT_NE(table.find("grains without friction never turn"), std::string::npos) << table;
}

/// A study of made-up numbers: every setting has the reference's mean but the last, which is off by `shift` standard deviations.
Study drawn(std::uint64_t key, int seeds, double shift) {
  Random random(11, key);
  Study study;
  for (int p = 0; p < 12; ++p) {
    Point point;
    point.label = std::to_string(p);
    for (int seed = 1; seed <= seeds; ++seed) {
      double deviate = -6;
      for (int k = 0; k < 12; ++k) deviate += random.uniform(0, 1);
      Outcome outcome;
      outcome.cost = 1 + p;
      outcome.values = {{"x", "", 100 + deviate + (p == 11 ? shift : 0), 100}};
      point.outcomes[seed] = outcome;
    }
    study.points.push_back(point);
  }
  analyse(study);
  return study;
}

// Equal settings differ by chance alone, and are called so in nine cases of ten at least; a difference of eight deviations is seen.
TEST(Tradeoff, ADifferenceWithinTheNoiseIsNone) {
  for (const int seeds : {2, 3, 5}) {
    int none = 0, all = 0, seen = 0;
    for (std::uint64_t key = 0; key < 40; ++key) {
      const Study study = drawn(key, seeds, 8);
      for (std::size_t p = 3; p < 11; ++p, ++all) none += study.points[p].deviations[0].none() ? 1 : 0;
      seen += study.points[11].deviations[0].none() ? 0 : 1;
    }
    EXPECT_GT(none, 0.9 * all) << seeds;
    EXPECT_GT(seen, 36) << seeds;
  }
}

TEST(Tradeoff, TheFrontHasNothingCheaperAndMoreAccurate) {
  const Study study = drawn(3, 3, 30);
  for (const Point& a : study.points) {
    bool beaten = false;
    for (const Point& b : study.points) beaten = beaten || (b.cost < a.cost && b.bound() < a.bound());
    EXPECT_FALSE(a.pareto && beaten) << a.label;
  }
  EXPECT_TRUE(study.points[0].pareto);    // the cheapest
  EXPECT_FALSE(study.points[11].pareto);  // the most expensive and farthest off
}

SavedPoint saved(const std::string& label, double cost, double bound, bool front) {
  SavedPoint point;
  point.label = label, point.cost = cost, point.bound = bound, point.pareto = front, point.worst = "x";
  return point;
}

TEST(SavedStudy, TakesTheCheapestThatKeepsThePromise) {
  SavedStudy study;
  study.points = {saved("coarse", 1, 0.2, true), saved("fair", 2, 0.019, true), saved("dear", 3, 0.015, false),
                  saved("fine", 9, 0.001, true)};
  study.reference = study.points.back();
  EXPECT_EQ(cheapestWithin(study, 0.02).label, "fair");
  EXPECT_EQ(cheapestWithin(study, 0.5).label, "coarse");
  EXPECT_EQ(cheapestWithin(study, 0.01).label, "fine");
  EXPECT_THROW(cheapestWithin(study, 1e-4), Error);
  EXPECT_EQ(pointOfQuality(study, "draft").label, "fair");
  EXPECT_EQ(pointOfQuality(study, "reference").label, "fine");
  EXPECT_THROW(pointOfQuality(study, "best"), Error);
}

// From the study through its file to a setting whose run is as accurate as promised.
TEST(SavedStudy, APromiseIsKept) {
  const Folder folder("saved");
  Request request = requestFor(folder, swinging);
  request.axes = {"step"};
  const Study study = made(request);
  writeStudy(folder.path() / "tradeoff.json", study);
  const SavedStudy read = readStudy(folder.path() / "tradeoff.json", request.scene);
  refuseOtherScene(read, request.scene, {"simulation.seed=9", "simulation.end=3"}, "test");
  EXPECT_THROW(refuseOtherScene(read, folder.file("other.toml", heap), {}, "test"), Error);
  EXPECT_THROW(refuseOtherScene(read, request.scene, {"pairs.restitution=0.6"}, "test"), Error);
  const double accuracy = 3 * study.points.back().bound();
  const SavedPoint& chosen = cheapestWithin(read, accuracy);
  for (const Point& point : study.points) EXPECT_TRUE(!point.ran() || point.bound() > accuracy || chosen.cost <= point.cost) << point.label;
  const double truth = valueOf(*run({request.scene, {"simulation.safety=0.005"}}), "height");
  const double value = valueOf(*run({request.scene, chosen.overrides}), "height");
  EXPECT_LE(std::abs(value - truth) / study.observables[0].scale, accuracy + study.observables[0].bar);
  EXPECT_THROW(readStudy(folder.path() / "absent.json", request.scene), Error);
}

}  // namespace
}  // namespace tsubu::study
