#include "sim/bonds/bond_limit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "sim/bonds/bond_search.h"
#include "sim/state.h"

namespace tsubu::sim {

namespace {

struct Swing {
  double stiffness, damping;
};

// What one bond would have alone: the largest of its modes, where bending and shear, which turn unequal grains together, are added.
Swing swingOf(const Bonding& bonding, const BondBody& body, double armI, double armJ, double inverseMass, double inverseMomentI,
              double inverseMomentJ) {
  const BondKind kind = kindOf(bonding);
  const BondSprings springs = springsOf(kind, body);
  const double moments = inverseMomentI + inverseMomentJ;
  const double slipping = inverseMass + armI * armI * inverseMomentI + armJ * armJ * inverseMomentJ;
  double share = 1;
  Swing swing{};
  if (bonding.damping == BondDamping::percent) share += *std::max_element(bonding.dampingOf.begin(), bonding.dampingOf.end());
  swing.stiffness =
      share * std::max({springs.along * inverseMass, springs.across * slipping + springs.bend * moments, springs.twist * moments});
  if (bonding.damping == BondDamping::viscous)
    swing.damping = std::max({kind.eta[along] * body.critical * inverseMass,
                              kind.eta[across] * body.critical * slipping + kind.eta[bending] * body.bendCritical * moments,
                              kind.eta[twisting] * body.bendCritical * moments});
  return swing;
}

double momentOf(const GrainRow& row) { return 2.5 * row.inverseMass * row.inverseRadius * row.inverseRadius; }

struct Smallest {
  double mass = std::numeric_limits<double>::infinity(), radius = std::numeric_limits<double>::infinity();
};

Smallest smallestOf(const Model& model) {
  Smallest smallest;
  const auto meet = [&](std::uint16_t material, double radius) {
    smallest.mass = std::min(smallest.mass, massOf(model.materials[material].values[Property::density], radius));
    smallest.radius = std::min(smallest.radius, radius);
  };
  for (const Grain& grain : model.grains) meet(grain.material, grain.radius);
  for (const Stream& stream : model.streams) meet(stream.material, stream.radii.smallest());
  return smallest;
}

}  // namespace

BondSwing swingOfBonds(const Model& model, bool laterOnly) {
  State state;
  for (const Grain& grain : model.grains) state.add(grain, model.materials[grain.material].values[Property::density], Vec3::Zero(), 0);
  const Periods periods(model.domain, model.periodic);
  const BondableGrains grains{state.rows, state.id, state.material, periods};
  std::vector<Swing> sum(state.size(), Swing{});
  Swing later{};
  BondSwing worst;
  double most = 0;
  const auto count = [&](std::int32_t g, const Swing& swing, const Bonding& bonding) {
    Swing& own = sum[static_cast<std::size_t>(g)];
    own.stiffness += swing.stiffness;
    own.damping += swing.damping;
    worst.damping = std::max(worst.damping, own.damping);
    if (own.stiffness > worst.stiffness) worst.stiffness = own.stiffness;
    if (swing.stiffness > most) most = swing.stiffness, worst.of = bonding.name;
  };
  for (std::size_t k = 0; k < model.bonds.size(); ++k) {
    const Bonding& bonding = model.bonds[k];
    if (bonding.start == 0 && bonding.end <= bonding.start) {
      if (laterOnly) continue;
      if (bonding.wall) {
        const Wall& wall = model.walls[*bonding.wall];
        for (const WallFoot& foot : bondableFeet(bonding, k, model.seed, grains, wall, wall.motion.at(0))) {
          const GrainRow& row = state.rows[static_cast<std::size_t>(foot.grain)];
          const double length = (Vec3(row.x, row.y, row.z) - foot.point).norm();
          const BondBody body = bodyOf(bonding, row.radius, length, {row.inverseMass, momentOf(row)});
          count(foot.grain, swingOf(bonding, body, length, 0, row.inverseMass, momentOf(row), 0), bonding);
        }
        continue;
      }
      for (const BondedPair& pair : bondablePairs(bonding, k, model.seed, grains)) {
        const GrainRow &a = state.rows[static_cast<std::size_t>(pair.i)], &b = state.rows[static_cast<std::size_t>(pair.j)];
        const double length = periods.nearest(Vec3(a.x, a.y, a.z) - Vec3(b.x, b.y, b.z)).norm(), arm = length / (a.radius + b.radius);
        const BondBody body = bodyOf(bonding, std::min(a.radius, b.radius), length, inertiaOf(a, b));
        const Swing swing = swingOf(bonding, body, arm * a.radius, arm * b.radius, a.inverseMass + b.inverseMass, momentOf(a), momentOf(b));
        count(pair.i, swing, bonding);
        count(pair.j, swing, bonding);
      }
      continue;
    }
    const Smallest smallest = smallestOf(model);
    if (!std::isfinite(smallest.mass)) continue;
    const double r = smallest.radius, inverseMass = 1 / smallest.mass, moment = 2.5 * inverseMass / (r * r);
    const BondBody body = bodyOf(bonding, r, 2 * r, {2 * inverseMass, 2 * moment});
    const Swing one = swingOf(bonding, body, r, r, 2 * inverseMass, moment, moment);
    const double distance = std::max(1.0, bonding.distance), neighbours = 12 * distance * distance * distance;
    later.stiffness += neighbours * one.stiffness;
    later.damping += neighbours * one.damping;
    if (neighbours * one.stiffness > most) most = neighbours * one.stiffness, worst.of = bonding.name;
  }
  worst.stiffness += later.stiffness;
  worst.damping += later.damping;
  return worst;
}

}  // namespace tsubu::sim
