#pragma once
// Contacts, properties and small vector helpers for the tests of laws.

#include <string>

#include "core/random.h"
#include "core/vec.h"
#include "sim/laws/catalogue.h"

namespace tsubu::sim::test {

inline Vec3 vec(V3 a) { return {a.x, a.y, a.z}; }
inline V3 v3(const Vec3& a) { return {a.x(), a.y(), a.z()}; }

inline Vec3 randomVec(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size), z = random.uniform(-size, size);
  return {x, y, z};
}
inline Vec3 tangentTo(const Vec3& n, const Vec3& a) { return a - a.dot(n) * n; }

/// Grains of some millimetres: k_n = 2 kN/m, k_t = 900 N/m, e = 0.6, μ = 0.35, μ_r = 0.2.
inline PropertyValues someProperties() {
  PropertyValues values;
  values[Property::normalStiffness] = 2000;
  values[Property::tangentialStiffness] = 900;
  values[Property::restitution] = 0.6;
  values[Property::friction] = 0.35;
  values[Property::rollingFriction] = 0.2;
  return values;
}

/// A contact of two unequal grains somewhere in its life: overlap of micrometres, slip and separation of a tenth of a metre per second.
inline Contact randomContact(Random& random) {
  Contact c{};
  const Vec3 n = randomVec(random, 1).normalized();
  c.n = v3(n);
  c.overlap = random.uniform(0, 5e-5);
  c.separationSpeed = random.uniform(-0.1, 0.1);
  c.slip = v3(tangentTo(n, randomVec(random, 0.1)));
  c.relativeSpin = v3(randomVec(random, 40));
  c.effectiveMass = random.uniform(1e-6, 1e-4);
  c.effectiveRadius = random.uniform(1e-3, 3e-3);
  c.inverseSpinInertia = 5 / (c.effectiveMass * c.effectiveRadius * c.effectiveRadius);
  c.frameAngle = random.uniform(-1e-3, 1e-3);
  return c;
}

/// What a contact remembers, near the size of the forces of randomContact.
struct Memory {
  V3 tangential{0, 0, 0}, rolling{0, 0, 0};
};
inline Memory randomMemory(Random& random, const Contact& c) {
  return {v3(tangentTo(vec(c.n), randomVec(random, 0.03))), v3(tangentTo(vec(c.n), randomVec(random, 1e-5)))};
}

/// One evaluation with all that comes of it.
struct Result {
  Vec3 force, couple, moment;
  ContactEnergy energy{};
  Memory memory;
};
template <class Law>
Result evaluate(const typename Law::Pair& pair, const Contact& c, StepOf step, Memory memory) {
  Result r;
  const ContactForce f = Law::template evaluate<true>(pair, c, step, memory.tangential, memory.rolling, r.energy);
  r.force = vec(f.force);
  r.couple = vec(f.couple);
  r.moment = vec(f.moment);
  r.memory = memory;
  return r;
}

template <class Law>
std::string nameOf() {
  return std::string(Law::Normal::name) + " / " + std::string(Law::Tangential::name) + " / " + std::string(Law::Rolling::name);
}

}  // namespace tsubu::sim::test
