#pragma once
// Contacts, properties and small vector helpers for the tests of laws.

#include <array>
#include <cmath>
#include <string>
#include <vector>

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

/// A material with itself, or two alike.
inline PairValues same(const PropertyValues& values) { return {values, values, values}; }

/// Grains of some millimetres: k_n = 2 kN/m, k_t = 900 N/m, e = 0.6, μ = 0.35, μ_r = 0.2; E = 20 MPa, ν = 0.3.
inline PropertyValues someProperties() {
  PropertyValues values;
  values[Property::youngModulus] = 2e7;
  values[Property::poissonRatio] = 0.3;
  values[Property::normalStiffness] = 2000;
  values[Property::tangentialStiffness] = 900;
  values[Property::restitution] = 0.6;
  values[Property::friction] = 0.35;
  values[Property::tangentialDampingRate] = 700;
  values[Property::rollingFriction] = 0.2;
  values[Property::rollingViscosity] = 2;
  values[Property::twistingFriction] = 0.15;
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
  c.rootMass = std::sqrt(c.effectiveMass);
  c.effectiveRadius = random.uniform(1e-3, 3e-3);
  c.inverseEffectiveMass = 1 / c.effectiveMass;
  c.inverseSpinInertia = 5 / (c.effectiveMass * c.effectiveRadius * c.effectiveRadius);
  c.frameAngle = random.uniform(-1e-3, 1e-3);
  return c;
}

/// A law with the constants of a pair.
class Prepared {
 public:
  Prepared(std::size_t law, const PropertyValues& values, bool tension, bool rescales = true) : functions_(&lawFunctions(law)) {
    constants_.resize(functions_->constants + 1);
    functions_->prepare(same(values), tension, rescales, constants_.data());
  }
  const LawFunctions& law() const { return *functions_; }
  const double* constants() const { return constants_.data(); }

 private:
  const LawFunctions* functions_;
  std::vector<double> constants_;
};

/// What a contact remembers, in the order of the columns.
using Memory = std::array<double, mostMemory>;

/// What a component of the memory is.
enum class Part { force, stiffness, moment, momentStiffness };
inline Part partOf(const LawTraits& law, int component) {
  if (component < law.tangentialSize) return component < 3 ? Part::force : Part::stiffness;
  const int rolling = component - law.tangentialSize;
  if (rolling < law.rollingSize) return rolling < 3 ? Part::moment : Part::momentStiffness;
  return rolling == law.rollingSize ? Part::moment : Part::momentStiffness;
}

/// Where vectors begin.
inline std::vector<int> vectorsIn(const LawTraits& law) {
  std::vector<int> first;
  if (law.tangentialSize >= 3) first.push_back(0);
  if (law.rollingSize >= 3) first.push_back(law.tangentialSize);
  return first;
}

/// Some memory near the size of the forces of randomContact; vectors in the tangent plane.
inline Memory randomMemory(Random& random, const LawTraits& law, const Contact& c) {
  Memory memory{};
  for (int k = 0; k < law.stateSize; ++k) {
    const Part part = partOf(law, k);
    const double size = part == Part::force ? 0.03 : part == Part::stiffness ? 3000 : 1e-5;
    memory[static_cast<std::size_t>(k)] =
        part == Part::stiffness || part == Part::momentStiffness ? random.uniform(0.1 * size, size) : random.uniform(-size, size);
  }
  for (const int first : vectorsIn(law)) {
    double* const m = memory.data() + first;
    const Vec3 flat = tangentTo(vec(c.n), Vec3(m[0], m[1], m[2]));
    for (int k = 0; k < 3; ++k) m[k] = flat[k];
  }
  return memory;
}
/// The vectors of a memory through a map; numbers stay.
template <class F>
Memory mapped(const LawTraits& law, Memory memory, F&& f) {
  for (const int first : vectorsIn(law)) {
    double* const m = memory.data() + first;
    const V3 image = f(V3{m[0], m[1], m[2]});
    m[0] = image.x, m[1] = image.y, m[2] = image.z;
  }
  return memory;
}

/// One evaluation with all that comes of it.
struct Result {
  Vec3 force, couple, moment;
  ContactEnergy energy{};
  Memory memory;
};
inline Result evaluate(const Prepared& prepared, const Contact& c, StepOf step, Memory memory) {
  Result r;
  const ContactForce f = prepared.law().evaluate(prepared.constants(), c, step, memory.data(), r.energy);
  r.force = vec(f.force);
  r.couple = vec(f.couple);
  r.moment = vec(f.moment);
  r.memory = memory;
  return r;
}

inline std::string nameOf(const LawFunctions& law) {
  std::string name;
  for (const std::string_view part : law.names) name += std::string(part) + " / ";
  return name;
}

}  // namespace tsubu::sim::test
