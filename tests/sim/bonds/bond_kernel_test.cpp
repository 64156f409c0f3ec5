// The loops over bonds do what the law says of one bond, bit by bit: with every instruction set, kind of damping and number of bonds left
// over at the end, with half-step rows and without.

#include <gtest/gtest.h>

#include <vector>

#include "core/random.h"
#include "core/vec.h"
#include "sim/bonds/bond_search.h"
#include "sim/kernel/kernels.h"

namespace tsubu::sim {
namespace {

constexpr double dt = 1e-6;

/// Grains in a cloud, each bonded with some that come later, in motion, and the bonds strained already.
struct Cloud {
  BondKind kind{};
  std::vector<GrainRow> rows;
  std::vector<HalfStepRow> half;
  std::vector<ForceRow> forces;
  BondColumns bonds;
  BondFindings found;

  /// \param alike  all grains have one radius
  Cloud(BondDamping damping, bool breakable, int bonded, bool alike) {
    Random random(5, 3);
    const auto some = [&](double size) { return random.uniform(-size, size); };
    for (int g = 0; g < 60; ++g) {
      const double drawn = random.uniform(0.5e-3, 2e-3), r = alike ? 1.3e-3 : drawn;
      rows.push_back({some(0.01), some(0.01), some(0.01), r, some(1), some(1), some(1), 1e5, some(1), some(1), some(1), 1 / r});
      half.push_back({some(1), some(1), some(1), 0, some(1), some(1), some(1), 0});
    }
    forces.resize(rows.size());
    Bonding bonding;
    bonding.stiffness = 3e11;
    bonding.stiffnessRatio = 2.4;
    bonding.damping = damping;
    bonding.dampingOf = {0.1, 0.2, 0.3, 0.4};
    // So that about half of them break, some by each stress.
    if (breakable) bonding.strength = {8e5, 1e6, 6e5, 0.3, 1.001};
    kind = kindOf(bonding);
    for (int k = 0; k < bonded; ++k) {
      const int i = k % 50, j = i + 1 + k / 50;
      const GrainRow &a = rows[static_cast<std::size_t>(i)], &b = rows[static_cast<std::size_t>(j)];
      const Vec3 d(a.x - b.x, a.y - b.y, a.z - b.z);
      const V3 n = 1 / d.norm() * V3{d.x(), d.y(), d.z()};
      const BondMemory memory{
          acrossOf({some(1e-6), some(1e-6), some(1e-6)}, n), {some(1e-3), some(1e-3), some(1e-3)}, d.norm() * (1 + some(1e-4))};
      BondBody body = bodyOf(bonding, std::min(a.radius, b.radius), d.norm(), inertiaOf(a, b));
      if (damping != BondDamping::exponential) body.length = memory.rest;
      bonds.add(i, j, body, memory);
    }
  }

  BondRows ends(bool withHalf) { return {rows.data(), withHalf ? half.data() : nullptr, forces.data()}; }
};

V3 at(const double* of) { return {of[0], of[1], of[2]}; }

BondMotion motionOf(const GrainRow& a, const GrainRow& b, const double* vi, const double* vj, const double* si, const double* sj) {
  return {at(vi) - at(vj), at(si) + at(sj), a.inverseRadius * at(si) - b.inverseRadius * at(sj)};
}

void add(double* to, V3 v) { to[0] += v.x, to[1] += v.y, to[2] += v.z; }

/// One bond after the other, by the law.
template <BondDamping damping, bool breakable>
void stepOneByOne(Cloud& cloud, bool withHalf) {
  for (std::size_t k = 0; k < cloud.bonds.size(); ++k) {
    const auto i = static_cast<std::size_t>(cloud.bonds.i[k]), j = static_cast<std::size_t>(cloud.bonds.j[k]);
    const GrainRow &a = cloud.rows[i], &b = cloud.rows[j];
    const BondMotion now = motionOf(a, b, &a.vx, &b.vx, &a.sx, &b.sx);
    const BondMotion moved = withHalf ? motionOf(a, b, &cloud.half[i].vx, &cloud.half[j].vx, &cloud.half[i].sx, &cloud.half[j].sx) : now;
    const V3 d = at(&a.x) - at(&b.x);
    const BondBody body = cloud.bonds.body(k);
    BondMemory memory = cloud.bonds.memory(k);
    const BondPath path = pathOf(d, a.radius + b.radius, moved, dt);
    const BondSlip slip = withHalf ? slipOf(path, now, dt) : slipOf(path.sheared, path.turned, path.n);
    const double r = path.r, r0 = lengthBefore(d, moved.velocity, dt);
    cloud.found.relaxed[0] += stretchBond<damping>(cloud.kind, body, path, r0, dt, memory);
    const BondForce f = pullBond<damping, breakable>(cloud.kind, body, memory, path, slip, dt);
    BondColumns one;
    one.add(0, 0, body, memory);
    for (std::size_t c = 0; c < BondColumns::columns; ++c) cloud.bonds.column[c][k] = one.column[c][0];
    if (!f.holds) {
      cloud.found.broken.push_back(static_cast<std::int32_t>(k));
      const BondStrain strain = strainOf(memory, path.n, r);
      const BondStrain before = strainBefore<damping>(cloud.kind, strain, strainBy(path, r0), dt);
      cloud.found.released += springProduct(springsOf(cloud.kind, body), before, strain);
      continue;
    }
    cloud.found.loss[0] += f.loss;
    add(&cloud.forces[i].fx, f.force);
    add(&cloud.forces[j].fx, -f.force);
    add(&cloud.forces[i].qx, f.couple - a.inverseRadius * f.moment);
    add(&cloud.forces[j].qx, f.couple + b.inverseRadius * f.moment);
  }
}

template <BondDamping damping, bool breakable>
void compare(const Kernels& kernels, int bonded, bool alike, bool withHalf, bool accounts) {
  SCOPED_TRACE(std::string(kernels.isa) + ", " + std::to_string(bonded) + (alike ? ", alike" : "") + (withHalf ? ", half-step rows" : "") +
               (accounts ? ", accounts" : ""));
  Cloud expected(damping, breakable, bonded, alike), cloud(damping, breakable, bonded, alike);
  stepOneByOne<damping, breakable>(expected, withHalf);
  BondStage stage;
  const BondKernel kernel = kernels.bonds({damping, breakable, accounts});
  kernel(cloud.kind, cloud.bonds, cloud.ends(withHalf), cloud.ends(withHalf), dt, stage, cloud.found);
  for (std::size_t c = 0; c < BondColumns::columns; ++c) EXPECT_EQ(cloud.bonds.column[c], expected.bonds.column[c]) << "column " << c;
  for (std::size_t g = 0; g < cloud.rows.size(); ++g)
    for (int c = 0; c < 8; ++c) EXPECT_EQ((&cloud.forces[g].fx)[c], (&expected.forces[g].fx)[c]) << "grain " << g;
  EXPECT_EQ(cloud.found.broken, expected.found.broken);
  EXPECT_EQ(cloud.found.released, expected.found.released);
  const auto sum = [](const double* lanes) { return BondFindings::sum(lanes); };
  const double told = accounts ? 1 : 0;
  EXPECT_NEAR(sum(cloud.found.loss), told * sum(expected.found.loss), 1e-12 * std::abs(sum(expected.found.loss)));
  EXPECT_NEAR(sum(cloud.found.relaxed), told * sum(expected.found.relaxed), 1e-12 * sum(expected.found.relaxed));
  if (breakable && bonded > 100) {
    EXPECT_GT(cloud.found.broken.size(), cloud.bonds.size() / 10);
    EXPECT_LT(cloud.found.broken.size(), cloud.bonds.size() * 9 / 10);
  }
}

template <BondDamping damping>
void compareAll() {
  for (const Kernels& kernels : availableKernels())
    for (const bool withHalf : {false, true})
      for (const bool accounts : {false, true})
        for (const bool alike : {false, true})
          for (const int bonded : {1, 4, 63, 64, 203}) {
            compare<damping, false>(kernels, bonded, alike, withHalf, accounts);
            compare<damping, true>(kernels, bonded, alike, withHalf, accounts);
          }
}

TEST(BondKernels, DoWhatTheLawSaysOfOneBond) { compareAll<BondDamping::none>(); }
TEST(BondKernels, DoWhatTheLawSaysOfPercent) { compareAll<BondDamping::percent>(); }
TEST(BondKernels, DoWhatTheLawSaysOfExponential) { compareAll<BondDamping::exponential>(); }
TEST(BondKernels, DoWhatTheLawSaysOfViscous) { compareAll<BondDamping::viscous>(); }

}  // namespace
}  // namespace tsubu::sim
