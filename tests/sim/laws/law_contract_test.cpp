// What every contact law must keep, whatever its formula. Runs over all combinations in the catalogue: a new law is tested by being
// listed.

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "sim/laws/contacts.h"

namespace tsubu::sim {
namespace {

using test::evaluate;
using test::Memory;
using test::nameOf;
using test::Prepared;
using test::Result;
using test::v3;
using test::vec;

constexpr std::array<StepOf, 2> steps{StepOf{1e-6, 0.5}, StepOf{1e-6, 1.0}};

/// Calls f(index, functions) for every law that makes sense.
template <class F>
void everyLaw(F&& f) {
  for (std::size_t index = 0; index < lawCount(); ++index) {
    const LawFunctions& law = lawFunctions(index);
    if (!law.objection.empty()) continue;
    SCOPED_TRACE(nameOf(law));
    f(index, law);
  }
}

void expectNear(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_LE((a - b).norm(), tolerance) << a.transpose() << " | " << b.transpose();
}

TEST(LawContract, SwappingThePartnersSwapsForceAndMoment) {
  everyLaw([](std::size_t index, const LawFunctions& law) {
    Random random(1, 1);
    for (int n = 0; n < 200; ++n) {
      for (const bool tension : {false, true}) {
        const Prepared pair(index, test::someProperties(), tension);
        const Contact c = test::randomContact(random);
        const Memory memory = test::randomMemory(random, law.traits, c);
        Contact swapped = c;
        swapped.n = -c.n;
        swapped.slip = -c.slip;
        swapped.relativeSpin = -c.relativeSpin;
        swapped.frameAngle = -c.frameAngle;
        for (const StepOf step : steps) {
          Memory turned = memory;
          for (int k = 0; k < law.traits.stateSize; ++k)
            if (law.traits.odd >> k & 1U) turned[static_cast<std::size_t>(k)] *= -1;
          const Result a = evaluate(pair, c, step, memory), b = evaluate(pair, swapped, step, turned);
          EXPECT_EQ(a.force, -b.force);
          EXPECT_EQ(a.couple, b.couple);  // n and F_t both turn round: the torque of F_t has the same sign at both ends
          EXPECT_EQ(a.moment, -b.moment);
          for (std::size_t k = 0; k < static_cast<std::size_t>(law.traits.stateSize); ++k)
            EXPECT_EQ(a.memory[k], (law.traits.odd >> k & 1U) ? -b.memory[k] : b.memory[k]);
          EXPECT_EQ(a.energy.friction, b.energy.friction);
        }
      }
    }
  });
}

TEST(LawContract, TurningTheFrameTurnsTheAnswer) {
  everyLaw([](std::size_t index, const LawFunctions& law) {
    Random random(1, 2);
    const Prepared pair(index, test::someProperties(), true);
    for (int n = 0; n < 200; ++n) {
      const Contact c = test::randomContact(random);
      const Memory memory = test::randomMemory(random, law.traits, c);
      const Mat3 R = Eigen::AngleAxisd(random.uniform(0, 6), test::randomVec(random, 1).normalized()).toRotationMatrix();
      const auto turned = [&R](V3 a) { return v3(R * vec(a)); };
      Contact t = c;
      t.n = turned(c.n);
      t.slip = turned(c.slip);
      t.relativeSpin = turned(c.relativeSpin);
      for (const StepOf step : steps) {
        const Result a = evaluate(pair, c, step, memory);
        const Result b = evaluate(pair, t, step, test::mapped(law.traits, memory, turned));
        // Forces of 0.1 N and moments of 1e-4 N m; rounding of a few units in the last place.
        expectNear(R * a.force, b.force, 1e-15);
        expectNear(R * a.couple, b.couple, 1e-15);
        expectNear(R * a.moment, b.moment, 1e-18);
        const Memory expected = test::mapped(law.traits, a.memory, turned);
        for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(expected[k], b.memory[k], 1e-14 * (0.1 + std::abs(expected[k])));
      }
    }
  });
}

/// Factors between two systems of units.
struct Units {
  double length, mass, time;
  double force() const { return mass * length / (time * time); }
};

PropertyValues inUnits(PropertyValues v, Units u) {
  v[Property::normalStiffness] *= u.mass / (u.time * u.time);
  v[Property::tangentialStiffness] *= u.mass / (u.time * u.time);
  v[Property::youngModulus] *= u.force() / (u.length * u.length);
  v[Property::tangentialDampingRate] /= u.time;
  v[Property::rollingViscosity] *= u.time / u.length;
  return v;
}

TEST(LawContract, OtherUnitsGiveTheSameAnswer) {
  everyLaw([](std::size_t index, const LawFunctions& law) {
    Random random(1, 3);
    for (int n = 0; n < 200; ++n) {
      const auto decades = [&] { return std::pow(10.0, random.uniform(-6, 6)); };
      const Units u{decades(), decades(), decades()};
      const double torque = u.force() * u.length;
      const Prepared pair(index, test::someProperties(), false), other(index, inUnits(test::someProperties(), u), false);
      const Contact c = test::randomContact(random);
      const Memory memory = test::randomMemory(random, law.traits, c);
      Contact o = c;
      o.overlap *= u.length;
      o.separationSpeed *= u.length / u.time;
      o.slip = (u.length / u.time) * c.slip;
      o.relativeSpin = (1 / u.time) * c.relativeSpin;
      o.effectiveMass *= u.mass;
      o.rootMass = std::sqrt(o.effectiveMass);
      o.effectiveRadius *= u.length;
      o.inverseEffectiveMass /= u.mass;
      o.inverseSpinInertia /= u.mass * u.length * u.length;
      const auto factor = [&](int component) {
        const test::Part part = test::partOf(law.traits, component);
        return part == test::Part::force ? u.force() : part == test::Part::stiffness ? u.force() / u.length : torque;
      };
      Memory otherMemory = memory;
      for (int k = 0; k < law.traits.stateSize; ++k) otherMemory[static_cast<std::size_t>(k)] *= factor(k);
      for (const StepOf step : steps) {
        const Result a = evaluate(pair, c, step, memory);
        const Result b = evaluate(other, o, {step.dt * u.time, step.lead}, otherMemory);
        expectNear(u.force() * a.force, b.force, 1e-12 * b.force.norm() + 1e-16 * u.force());
        expectNear(torque * a.moment, b.moment, 1e-12 * b.moment.norm());
        for (int k = 0; k < law.traits.stateSize; ++k) {
          const double there = b.memory[static_cast<std::size_t>(k)];
          EXPECT_NEAR(factor(k) * a.memory[static_cast<std::size_t>(k)], there, 1e-11 * std::abs(there) + 1e-14 * factor(k));
        }
        EXPECT_NEAR(torque * a.energy.storedTangential, b.energy.storedTangential, 1e-12 * std::abs(b.energy.storedTangential));
        EXPECT_NEAR(torque * a.energy.storedRolling, b.energy.storedRolling, 1e-12 * std::abs(b.energy.storedRolling));
      }
    }
  });
}

TEST(LawContract, FrictionStaysWithinTheCoulombLimit) {
  everyLaw([](std::size_t index, const LawFunctions& law) {
    Random random(1, 4);
    const PropertyValues values = test::someProperties();
    for (int n = 0; n < 1000; ++n) {
      const Prepared pair(index, values, n % 2 == 0);
      const Contact c = test::randomContact(random);
      const Result r = evaluate(pair, c, steps[static_cast<std::size_t>(n / 2 % 2)], test::randomMemory(random, law.traits, c));
      const double normal = r.force.dot(vec(c.n));
      const Vec3 tangential = r.force - normal * vec(c.n);
      if (law.traits.withinLimit) {
        EXPECT_LE(tangential.norm(), values[Property::friction] * std::abs(normal) * (1 + 1e-12) + 1e-17);
      }
      if (n % 2 != 0) {
        EXPECT_GE(normal, -1e-17);  // no tension
      }
      expectNear(r.couple, vec(c.n).cross(tangential), 1e-16);
    }
  });
}

TEST(LawContract, NothingIsNotANumber) {
  everyLaw([](std::size_t index, const LawFunctions& law) {
    Random random(1, 5);
    const auto zeroed = [](Property p, double value = 0) {
      PropertyValues v = test::someProperties();
      v[p] = value;
      return v;
    };
    const std::array properties{test::someProperties(),
                                zeroed(Property::friction),
                                zeroed(Property::tangentialStiffness),
                                zeroed(Property::rollingFriction),
                                zeroed(Property::restitution, 1),
                                zeroed(Property::restitution, 1e-6),
                                zeroed(Property::tangentialDampingRate, 0)};
    for (const PropertyValues& values : properties) {
      for (const bool tension : {false, true}) {
        const Prepared pair(index, values, tension);
        for (int n = 0; n < 64; ++n) {
          Contact c = test::randomContact(random);
          Memory memory = test::randomMemory(random, law.traits, c);
          if (n & 1) c.overlap = 0;
          if (n & 2) c.separationSpeed = 0;
          if (n & 4) c.slip = {0, 0, 0};
          if (n & 8) c.relativeSpin = {0, 0, 0};
          if (n & 16) memory = {};
          if (n & 32) c.n = {0, 0, 0};  // centres that coincide have no direction
          for (const StepOf step : steps) {
            const Result r = evaluate(pair, c, step, memory);
            EXPECT_TRUE(r.force.allFinite() && r.couple.allFinite() && r.moment.allFinite());
            for (const double component : r.memory) EXPECT_TRUE(std::isfinite(component));
            const ContactEnergy& e = r.energy;
            EXPECT_TRUE(
                std::isfinite(e.storedNormal + e.storedTangential + e.storedRolling + e.normal + e.tangential + e.friction + e.rolling));
          }
        }
      }
    }
  });
}

TEST(LawContract, WorkIsStoredOrDissipated) {
  everyLaw([](std::size_t index, const LawFunctions& law) {
    Random random(1, 6);
    const Prepared pair(index, test::someProperties(), false);
    for (int n = 0; n < 500; ++n) {
      const Contact c = test::randomContact(random);
      const Memory memory = test::randomMemory(random, law.traits, c);
      const StepOf step = steps[static_cast<std::size_t>(n % 2)];
      const Result r = evaluate(pair, c, step, memory);
      EXPECT_GE(r.energy.storedNormal, 0);
      EXPECT_GE(r.energy.storedTangential, 0);
      EXPECT_GE(r.energy.storedRolling, 0);
      EXPECT_GE(r.energy.normal, -1e-18);
      EXPECT_GE(r.energy.tangential, 0);
      if (law.traits.passive) {
        EXPECT_GE(r.energy.friction, -1e-15);
      }
      EXPECT_GE(r.energy.rolling, -1e-15);
    }
  });
}

/// A periodic motion of three harmonics.
class Loop {
 public:
  Loop(Random& random, double amplitude) {
    for (double& p : a_) p = amplitude * random.uniform(-1, 1);
    for (double& p : phase_) p = random.uniform(0, 2 * std::numbers::pi);
  }
  double at(double t) const {
    return sum(
        t, [](double x) { return std::sin(x); }, false);
  }
  double rate(double t) const {
    return sum(
        t, [](double x) { return std::cos(x); }, true);
  }

 private:
  template <class F>
  double sum(double t, F f, bool derivative) const {
    double s = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double w = 2 * std::numbers::pi * static_cast<double>(k + 1);
      s += a_[k] * (derivative ? w : 1) * f(w * t + phase_[k]);
    }
    return s;
  }
  std::array<double, 3> a_{}, phase_{};
};

// Bodies that are led around a closed path and back get out of a contact at most what they put in: over a cycle that repeats, no
// energy comes out. In the first cycle too, none beyond what the memory held, which is nothing. Slow loops probe springs, fast ones
// dashpots; light ones slide, deep ones stick.
TEST(LawContract, ClosedPathsNeverGainEnergy) {
  everyLaw([](std::size_t index, const LawFunctions&) {
    Random random(1, 7);
    for (int n = 0; n < 12; ++n) {
      const double period = std::pow(10.0, random.uniform(-4, 0)), depth = 5e-5, width = std::pow(10.0, random.uniform(-6, -3));
      const Loop overlap(random, depth), x(random, width), y(random, width), turnX(random, width / 1e-3), turnY(random, width / 1e-3);
      PropertyValues values = test::someProperties();
      if (n % 3 == 0) values[Property::restitution] = 1;                                 // nothing is lost along n …
      if (n % 3 == 0) values[Property::tangentialDampingRate] = random.uniform(0, 3e4);  // … so that a gain across it shows
      const Prepared pair(index, values, n % 2 == 0);
      for (const double lead : {0.5, 1.0}) {
        const int count = 4000;
        const StepOf step{period / count, lead};
        Memory memory{};
        double work = 0, most = 0, turnover = 0;
        for (int cycle = 0; cycle < 3; ++cycle) {
          for (int k = 0; k < count; ++k) {
            const double t = static_cast<double>(k) / count;
            Contact c{};
            c.n = {0, 0, 1};
            c.overlap = depth + overlap.at(t);
            c.separationSpeed = -overlap.rate(t) / period;
            c.slip = {x.rate(t) / period, y.rate(t) / period, 0};
            c.relativeSpin = {turnX.rate(t) / period, turnY.rate(t) / period, 0};
            c.effectiveMass = 3e-5;
            c.rootMass = std::sqrt(c.effectiveMass);
            c.inverseEffectiveMass = 1 / c.effectiveMass;
            c.effectiveRadius = 1e-3;
            c.inverseSpinInertia = 5 / (c.effectiveMass * 1e-6);
            if (c.overlap <= 0) {
              memory = {};
              continue;
            }
            const Result r = evaluate(pair, c, step, memory);
            memory = r.memory;
            const double done = (r.force.dot(c.separationSpeed * vec(c.n) + vec(c.slip)) + r.moment.dot(vec(c.relativeSpin))) * step.dt;
            work += done;
            turnover += std::abs(done);
            most = std::max(most, work);
          }
          // Quadrature: the trapezium rule on what is smooth leaves 1/count², and a jump at a beginning or end of contact 1/count.
          EXPECT_LE(work, 2e-3 * turnover) << "loop " << n << ", lead " << lead << ", cycle " << cycle;
        }
        // Normal springs are charged at most once at the beginning of the path, from which `work` may have begun: ½ k (2 depth·3)².
        EXPECT_LE(most, 0.5 * 2000 * std::pow(4 * depth, 2) + 2e-3 * turnover);
      }
    }
  });
}

}  // namespace
}  // namespace tsubu::sim
