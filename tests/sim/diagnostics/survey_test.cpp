// Surveys of instants that are written down by hand: every number is a formula.

#include "sim/diagnostics/survey.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"

namespace tsubu::sim {
namespace {

constexpr double pi = std::numbers::pi;
const Box wide(Vec3(-10, -10, -10), Vec3(10, 10, 10));

SeenGrain grainAt(const Vec3& position, double radius, double mass = 1, const Vec3& velocity = Vec3::Zero(),
                  const Vec3& spin = Vec3::Zero()) {
  return {position, velocity, spin, radius, mass};
}

/// Grains i and j of the instant touch, with this force on i.
void touch(Instant& instant, std::int32_t i, std::int32_t j, const Vec3& force) {
  const Vec3 branch = instant.grains[static_cast<std::size_t>(i)].position - instant.grains[static_cast<std::size_t>(j)].position;
  instant.contacts.push_back({i, j, branch, force, Vec3::Zero()});
}

/// Two unequal grains, oblique, with a force that is not along the branch.
Instant pair() {
  Instant instant;
  instant.grains = {grainAt({0.3, -0.2, 0.1}, 1.5), grainAt({1.1, 1.4, 0.9}, 0.6)};
  touch(instant, 0, 1, {-2, -3, 0.5});
  return instant;
}

TEST(Survey, StressOfAPairIsForceTimesBranch) {
  const Instant instant = pair();
  const Mat3 expected = Vec3(-2, -3, 0.5) * Vec3(-0.8, -1.6, -0.8).transpose() / 8000.0;
  const StressSurvey stress = survey(instant, wide).stress;
  EXPECT_EQ(stress.volume, 8000);
  EXPECT_LT((stress.contact - expected).norm(), 1e-15 * expected.norm());
  EXPECT_EQ(stress.kinetic, Mat3(Mat3::Zero()));
  EXPECT_NEAR(stress.pressure(), expected.trace() / 3, 1e-18);
}

// Love–Weber of a part: the branch counts as far as it lies within (here 0.3 → 0.5 of 0.3 → 1.1 along x).
TEST(Survey, ARegionHasItsShareOfTheBranch) {
  const Instant instant = pair();
  const Box part(Vec3(-10, -10, -10), Vec3(0.5, 10, 10));
  const Mat3 expected = 0.25 * Vec3(-2, -3, 0.5) * Vec3(-0.8, -1.6, -0.8).transpose() / part.volume();
  EXPECT_LT((survey(instant, part).stress.contact - expected).norm(), 1e-15 * expected.norm());
}

TEST(Survey, CellsOfAGridAddUpToTheRegion) {
  Random random(8, 2);
  Instant instant;
  for (int g = 0; g < 40; ++g) {
    const auto some = [&](double size) {
      return Vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
    };
    instant.grains.push_back(grainAt(some(9), random.uniform(0.2, 3), random.uniform(1, 5), some(2), some(3)));
    if (g > 0) touch(instant, g, g - 1, some(5));
  }
  const Grid grid{Box(Vec3(-6, -7, -3), Vec3(5, 6, 10)), {3, 5, 4}};
  const Survey all = survey(instant, grid.box);
  const std::vector<CellSurvey> cells = survey(instant, grid);
  Mat3 contact = Mat3::Zero();
  double solid = 0, mass = 0;
  Vec3 momentum = Vec3::Zero();
  for (const CellSurvey& cell : cells) {
    contact += cell.stress.contact / 60;
    solid += cell.solidFraction / 60;
    mass += cell.motion.mass;
    momentum += cell.motion.mass * cell.motion.bulkVelocity;
  }
  EXPECT_LT((contact - all.stress.contact).norm(), 1e-13 * all.stress.contact.norm());
  EXPECT_NEAR(solid, all.solidFraction, 1e-14);
  EXPECT_NEAR(mass, all.motion.mass, 1e-12);
  EXPECT_LT((momentum - all.motion.mass * all.motion.bulkVelocity).norm(), 1e-12);
  EXPECT_GT(all.motion.grains, 5U);
}

TEST(Survey, ContactsAndRattlers) {
  Instant instant;
  for (int g = 0; g < 5; ++g) instant.grains.push_back(grainAt({2.0 * g, 0, 0}, 1.0));
  // 0 – 1 – 2 on the floor with 1 and 2; 3 and 4 lie about: contacts 1, 3, 2, 0, 0.
  touch(instant, 0, 1, {-1, 0, 0});
  touch(instant, 2, 1, {2, 0, 0});
  instant.contacts.push_back({1, ActingContact::ofWall(0), {0, 0, 1}, {0, 0.5, 3}, Vec3::Zero()});
  instant.contacts.push_back({2, ActingContact::ofWall(0), {0, 0, 1}, {0, 0, 10}, Vec3::Zero()});
  const ContactSurvey seen = survey(instant, wide).contacts;
  EXPECT_EQ(seen.betweenGrains, 2U);
  EXPECT_EQ(seen.withWalls, 2U);
  EXPECT_DOUBLE_EQ(seen.coordination, 6.0 / 5);
  EXPECT_EQ(seen.rattlers, 3U);
  EXPECT_DOUBLE_EQ(seen.withoutRattlers, 5.0 / 2);
  EXPECT_EQ(seen.histogram[0], 2U);
  EXPECT_EQ(seen.histogram[1], 1U);
  EXPECT_EQ(seen.histogram[2], 1U);
  EXPECT_EQ(seen.histogram[3], 1U);
  EXPECT_DOUBLE_EQ(seen.meanForce, (1 + 2 + 3 + 10) / 4.0);
  EXPECT_DOUBLE_EQ(seen.largestForce, 10);
  EXPECT_DOUBLE_EQ(seen.shareAboveMean, 0.25);
  EXPECT_DOUBLE_EQ(seen.loadAboveMean, 10.0 / 16);
  // Where they touch decides: the first contact lies at x = 1, the others at 3, 2 and 4.
  const ContactSurvey left = survey(instant, Box(Vec3(-2, -2, -2), Vec3(2.5, 2, 2))).contacts;
  EXPECT_EQ(left.betweenGrains, 1U);
  EXPECT_EQ(left.withWalls, 1U);
  EXPECT_DOUBLE_EQ(left.coordination, 4.0 / 2);  // of grains 0 and 1, wherever their contacts are
}

TEST(Survey, MoreThanTwelveContactsAreCountedTogether) {
  Instant instant;
  instant.grains.push_back(grainAt({0, 0, 0}, 3));
  for (int g = 1; g <= 14; ++g) {
    instant.grains.push_back(grainAt({3.5 * std::cos(g), 3.5 * std::sin(g), 0}, 0.5));
    touch(instant, 0, g, {0, 0, 0});
  }
  EXPECT_EQ(survey(instant, wide).contacts.histogram[12], 1U);
  EXPECT_EQ(survey(instant, wide).contacts.shareAboveMean, 0);
}

TEST(Survey, TemperatureIsFluctuationAboutTheBulk) {
  Instant instant;
  const Vec3 drift(3, -1, 2);
  instant.grains = {grainAt({0, 0, 0}, 0.1, 2, drift + Vec3(0.3, 0, 0), {5, 0, 0}),
                    grainAt({1, 0, 0}, 0.2, 3, drift + Vec3(-0.2, 0, 0), {0, 0, -7})};
  const Survey seen = survey(instant, wide);
  EXPECT_LT((seen.motion.bulkVelocity - drift).norm(), 1e-15);
  EXPECT_NEAR(seen.motion.temperature, (2 * 0.09 + 3 * 0.04) / (3 * 5), 1e-16);
  EXPECT_NEAR(seen.motion.rotationTemperature, 0.4 * (2 * 0.01 * 25 + 3 * 0.04 * 49) / (3 * 5), 1e-15);
  EXPECT_NEAR(seen.stress.kinetic(0, 0), (2 * 0.09 + 3 * 0.04) / 8000, 1e-18);
  EXPECT_NEAR(seen.stress.pressure(), 5 * seen.motion.temperature / 8000, 1e-18);  // p = ρT of a gas
}

TEST(Survey, AGasAtRestHasNeitherTemperatureNorStress) {
  Instant instant;
  for (int g = 0; g < 5; ++g) instant.grains.push_back(grainAt({3.0 * g - 6, 0, 1}, 1.0, 2, {4, 5, 6}));  // at rest, seen from a train
  const Survey seen = survey(instant, wide);
  EXPECT_EQ(seen.stress.total(), Mat3(Mat3::Zero()));
  EXPECT_NEAR(seen.motion.temperature, 0, 1e-30);
  EXPECT_EQ(seen.contacts.coordination, 0);
}

TEST(Survey, NothingIsNoDivisionByZero) {
  const Survey none = survey(Instant{}, wide);
  EXPECT_EQ(none.motion.temperature, 0);
  EXPECT_EQ(none.contacts.meanForce, 0);
  EXPECT_EQ(survey(Instant{}, boxAround(Instant{})).solidFraction, 0);
}

// A simple cubic lattice: every unit cell holds one sphere, wherever its corner is, and the grid holds all of them.
TEST(Survey, SolidFractionOfALattice) {
  Instant instant;
  const double a = 0.02, r = 0.0093;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 3; ++k) instant.grains.push_back(grainAt(a * Vec3(i, j, k), r));
  const Grid inside{Box(a * Vec3(0.3, 0.1, 0.45), a * Vec3(3.3, 2.1, 1.45)), {3, 2, 1}};
  for (const CellSurvey& cell : survey(instant, inside)) EXPECT_NEAR(cell.solidFraction, 4 * pi / 3 * std::pow(r / a, 3), 1e-13);

  const Grid all{Box(a * Vec3(-1, -1, -1), a * Vec3(5, 4.3, 3)), {13, 7, 5}};
  double volume = 0;
  for (const CellSurvey& cell : survey(instant, all)) volume += cell.solidFraction * all.box.volume() / static_cast<double>(all.count());
  EXPECT_NEAR(volume, 60 * 4 * pi / 3 * r * r * r, 1e-12 * volume);
}

TEST(Survey, WallsFeelTheOppositeForceAndItsTorque) {
  Instant instant;
  instant.grains = {grainAt({1, 2, 3}, 0.5)};
  instant.contacts.push_back({0, ActingContact::ofWall(1), {0, 0, 0.4}, {1, -2, 5}, {0.1, 0.2, 0.3}});
  const std::vector<WallSurvey> walls = surveyWalls(instant, 3);
  EXPECT_EQ(walls[0].contacts + walls[2].contacts, 0U);
  EXPECT_EQ(walls[1].contacts, 1U);
  EXPECT_EQ(walls[1].force, Vec3(-1, 2, -5));
  EXPECT_LT((walls[1].torque - (Vec3(1, 2, 2.6).cross(Vec3(-1, 2, -5)) - Vec3(0.1, 0.2, 0.3))).norm(), 1e-15);
}

}  // namespace
}  // namespace tsubu::sim
