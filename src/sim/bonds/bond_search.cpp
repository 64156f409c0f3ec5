#include "sim/bonds/bond_search.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "sim/neighbours/cell_grid.h"
#include "sim/state.h"

namespace tsubu::sim {

namespace {

constexpr std::uint64_t pairKey = 0x626f6e64;    // "bond"
constexpr std::uint64_t footKey = 0x626f6e6477;  // "bondw"

bool drawn(const Bonding& bonding, std::uint64_t seed, std::uint64_t what, std::size_t kind, std::uint64_t ids) {
  return bonding.probability >= 1 || Random(seed, mix64(what + kind), ids).uniform() < bonding.probability;
}

}  // namespace

std::vector<BondedPair> bondablePairs(const Bonding& bonding, std::size_t kind, std::uint64_t seed, const BondableGrains& grains) {
  const auto member = [&](const BondEnd& end, std::int32_t g) {
    const auto k = static_cast<std::size_t>(g);
    return end.holds(grains.ids[k], grains.materials[k]);
  };
  double largest = 0;
  for (const GrainRow& row : grains.rows) largest = std::max(largest, row.radius);
  CellGrid grid;
  const double skin = std::max(0.0, bonding.distance - 1) * 2 * largest + 1e-9 * largest;
  grid.build(grains.rows, skin);
  std::vector<BondedPair> pairs;
  std::vector<std::int32_t> found;
  const auto count = static_cast<std::int32_t>(grains.ids.size());  // rows beyond are images
  for (std::int32_t g = 0; g < count; ++g) {
    const bool first = member(bonding.first, g), second = member(bonding.second, g);
    if (!first && !second) continue;
    const GrainRow& row = grains.rows[static_cast<std::size_t>(g)];
    found.clear();
    const Vec3 place = positionOf(row);
    grid.near(place, row.radius, g, found);
    if (grains.periods.any())
      grains.periods.forImages(place, row.radius + largest + skin,
                               [&](int number) { grid.near(Vec3(place + grains.periods.shift(number)), row.radius, g, found); });
    for (const std::int32_t other : found) {
      if (other < g || other >= count) continue;  // every pair is found from both ends
      if (!(first && member(bonding.second, other)) && !(second && member(bonding.first, other))) continue;
      const GrainRow& partner = grains.rows[static_cast<std::size_t>(other)];
      if (grains.periods.nearest(positionOf(row) - positionOf(partner)).norm() > bonding.distance * (row.radius + partner.radius)) continue;
      std::int32_t i = g, j = other;
      if (grains.ids[static_cast<std::size_t>(i)] > grains.ids[static_cast<std::size_t>(j)]) std::swap(i, j);
      const std::uint64_t ids = keyOfPair(grains.ids[static_cast<std::size_t>(i)], grains.ids[static_cast<std::size_t>(j)]);
      if (drawn(bonding, seed, pairKey, kind, ids)) pairs.push_back({i, j});
    }
  }
  return pairs;
}

std::vector<WallFoot> bondableFeet(const Bonding& bonding, std::size_t kind, std::uint64_t seed, const BondableGrains& grains,
                                   const Wall& wall, const Pose& pose) {
  std::vector<WallFoot> feet;
  std::vector<std::uint32_t> features;
  WallContacts contacts;
  for (std::size_t g = 0; g < grains.ids.size(); ++g) {
    if (!bonding.first.holds(grains.ids[g], grains.materials[g])) continue;
    const GrainRow& row = grains.rows[g];
    const double reach = bonding.distance * row.radius;
    const Vec3 centre = pose.toLocal(positionOf(row));
    wall.surface->candidates(centre, reach, features);
    wall.surface->nearestPoints(centre, reach, features, contacts);
    const auto nearest = std::min_element(contacts.begin(), contacts.end(),
                                          [](const WallContact& a, const WallContact& b) { return a.distance < b.distance; });
    if (nearest == contacts.end() || !(nearest->distance > 0)) continue;
    if (drawn(bonding, seed, footKey, kind, grains.ids[g])) feet.push_back({static_cast<std::int32_t>(g), pose.toWorld(nearest->point)});
  }
  return feet;
}

BondInertia inertiaOf(const GrainRow& a, const GrainRow& b) {
  return {a.inverseMass + b.inverseMass,
          2.5 * (a.inverseMass * a.inverseRadius * a.inverseRadius + b.inverseMass * b.inverseRadius * b.inverseRadius)};
}

BondBody bodyOf(const Bonding& bonding, double smaller, double length, const BondInertia& inertia) {
  BondBody body{};
  body.radius = bonding.radius * smaller;
  body.length = length;
  const BondSprings springs = springsOf(kindOf(bonding), body);
  body.critical = 2 * std::sqrt(springs.along / inertia.inverseMass);
  body.bendCritical = 2 * std::sqrt(springs.bend / inertia.inverseMoment);
  return body;
}

}  // namespace tsubu::sim
