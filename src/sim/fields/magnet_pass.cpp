#include "sim/fields/magnet_pass.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/integrate.h"
#include "sim/neighbours/cell_grid.h"
#include "sim/wall_pass.h"

namespace tsubu::sim {

namespace {

constexpr double pi = std::numbers::pi;

V3 v3(const Vec3& a) { return {a.x(), a.y(), a.z()}; }
Vec3 vec3(V3 a) { return {a.x, a.y, a.z}; }
double volumeOf(double radius) { return 4.0 / 3.0 * pi * radius * radius * radius; }

/// F8, of a volume V.
double polarisabilityOf(double susceptibility, double volume) {
  return volume / (4 * pi * magneticConstant) * 3 * susceptibility / (3 + susceptibility);
}

/// From j to i, on the shortest way.
V3 between(const World& world, std::size_t i, std::size_t j) {
  const V3 d = world.state.rows[i].position() - world.state.rows[j].position();
  return world.periods.any() ? v3(world.periods.nearest(vec3(d))) : d;
}

double magnetisationOf(const Model& model, std::uint16_t material) {
  return model.materials[material].values.valueOr(Property::magnetisation, 0);
}

}  // namespace

bool hasPermanentMagnets(const Model& model) {
  if (!model.magnets) return false;
  const auto carries = [&](const auto& source) { return magnetisationOf(model, source.material) != 0; };
  return std::any_of(model.grains.begin(), model.grains.end(), carries) || std::any_of(model.streams.begin(), model.streams.end(), carries);
}

// A moment p in the field B₀ of the sources and among twelve that touch it: T ≤ p (B₀ + 12·2κp/d³) per radian.
double fastestMagnet(const Model& model) {
  if (!model.magnets) return 0;
  double most = 0;
  const auto meet = [&](std::uint16_t material, double radius, const Vec3& x) {
    const double p = magnetisationOf(model, material) * volumeOf(radius);
    if (p == 0) return;
    FieldAt at;
    for (const FieldSource& source : model.magnets->sources) addField(source, x, at);
    const double mass = model.materials[material].values[Property::density] * volumeOf(radius), inertia = 0.4 * mass * radius * radius;
    const double neighbours = 24 * magneticConstant * std::abs(p) / (8 * radius * radius * radius);
    most = std::max(most, std::abs(p) * (at.field.norm() + neighbours) / inertia);
  };
  for (const Grain& grain : model.grains) meet(grain.material, grain.radius, grain.position);
  for (const Stream& stream : model.streams) meet(stream.material, stream.radii.smallest(), stream.region.bounds().center());
  return most;
}

MagnetPass::MagnetPass(const Model& model) : magnets_(*model.magnets), fixed_(hasPermanentMagnets(model)), cut_(magnets_.cutOff) {
  for (const Material& material : model.materials) {
    magnetisation_.push_back(material.values.valueOr(Property::magnetisation, 0));
    susceptibility_.push_back(material.values.valueOr(Property::susceptibility, 0));
    magnetic_.push_back(magnetisation_.back() != 0 || susceptibility_.back() != 0);
  }
}

void MagnetPass::regroup(const World& world, const std::vector<std::int32_t>&) {
  const State& state = world.state;
  std::vector<GrainRow> points;  // the magnets, as points
  std::vector<std::int32_t> place;
  for (std::size_t g = 0; g < state.size(); ++g) {
    if (!isMagnetic(state, g)) continue;
    GrainRow point = state.rows[g];
    point.radius = 0;
    points.push_back(point);
    place.push_back(static_cast<std::int32_t>(g));
  }
  const double reach = magnets_.cutOff + world.skin;
  for (int axis = 0; axis < 3; ++axis) {
    if (world.periods.along(axis) && world.periods.length(axis) < 2 * reach)
      throw Error(ErrorKind::scene,
                  fmt::format("Magnets that reach {:.4g} m would meet twice in a domain that repeats after {:.4g} m.", magnets_.cutOff,
                              world.periods.length(axis)),
                  "a shorter cut_off or a larger domain");
  }
  CellGrid grid;
  grid.build(points, reach);
  near_.assign(static_cast<std::size_t>(world.slabs.count()), {});
  world.team.run(world.slabs.count(), [&](int slab, int) {
    Neighbours& near = near_[static_cast<std::size_t>(slab)];
    std::vector<std::int32_t> found;
    auto self = std::lower_bound(place.begin(), place.end(), world.slabs.begin(slab)) - place.begin();
    for (std::int32_t g = world.slabs.begin(slab); g < world.slabs.end(slab); ++g) {
      near.start.push_back(static_cast<std::int32_t>(near.list.size()));
      if (!isMagnetic(state, static_cast<std::size_t>(g))) continue;
      const GrainRow& row = state.rows[static_cast<std::size_t>(g)];
      found.clear();
      const Vec3 x(row.x, row.y, row.z);
      grid.near(x, 0, static_cast<std::int32_t>(self++), found);
      world.periods.forImages(x, reach, [&](int shift) { grid.near(x + world.periods.shift(shift), 0, -1, found); });
      std::sort(found.begin(), found.end());
      for (const std::int32_t point : found) near.list.push_back(place[static_cast<std::size_t>(point)]);
    }
    near.start.push_back(static_cast<std::int32_t>(near.list.size()));
  });
}

MagnetPass::Magnet MagnetPass::magnetAt(const World& world, std::size_t g) const {
  const State& state = world.state;
  const GrainRow& row = state.rows[g];
  const std::uint16_t material = state.material[g];
  const double volume = volumeOf(row.radius);
  const Vec3 x(row.x, row.y, row.z);
  Magnet magnet{};
  for (const FieldSource& source : magnets_.sources) {
    if (source.wall) {
      const WallPlace& place = world.walls.places()[*source.wall];
      addMovedField(source, place.pose, place.twist, x, magnet.source);
    } else {
      addField(source, x, magnet.source);
    }
  }
  magnet.polarisability = polarisabilityOf(susceptibility_[material], volume);
  if (magnetisation_[material] != 0) magnet.fixed = v3(magnetisation_[material] * volume * (orientationNow(state, g) * Vec3::UnitZ()));
  magnet.moment = magnet.fixed + v3(magnet.polarisability * magnet.source.field);
  return magnet;
}

void MagnetPass::act(const World& world, int slab, Share& share) {
  const Neighbours& near = near_[static_cast<std::size_t>(slab)];
  const std::int32_t first = world.slabs.begin(slab);
  for (std::int32_t g = first; g < world.slabs.end(slab); ++g) {
    const auto i = static_cast<std::size_t>(g), local = static_cast<std::size_t>(g - first);
    if (!isMagnetic(world.state, i)) continue;
    const GrainRow& row = world.state.rows[i];
    const Magnet& magnet = now_[i];
    const Point self = points_[i];
    const bool periodic = world.periods.any();
    V3 force{0, 0, 0}, field{0, 0, 0};
    double energy = 0;
    for (auto k = static_cast<std::size_t>(near.start[local]); k < static_cast<std::size_t>(near.start[local + 1]); ++k) {
      const Point& other = points_[static_cast<std::size_t>(near.list[k])];
      V3 d = self.position - other.position;
      if (periodic) d = v3(world.periods.nearest(vec3(d)));
      const DipolePair pair = dipolePair(d, self.moment, other.moment, cut_);
      force = force + pair.force;
      field = field + pair.field;
      energy += 0.5 * pair.energy;
    }
    const Vec3 pulled = vec3(magnet.moment) + magnet.polarisability * vec3(field);
    force = force + v3(magnet.source.gradient * pulled);
    const V3 torque = cross(magnet.fixed, v3(magnet.source.field) + field);
    ForceRow& sum = world.state.forces[i];
    sum.fx += force.x, sum.fy += force.y, sum.fz += force.z;
    sum.qx -= row.inverseRadius * torque.x, sum.qy -= row.inverseRadius * torque.y, sum.qz -= row.inverseRadius * torque.z;
    share.energy += energy - vec3(magnet.fixed).dot(magnet.source.field) - 0.5 * magnet.polarisability * magnet.source.field.squaredNorm();
    share.power -= pulled.dot(magnet.source.change);
  }
}

void MagnetPass::addForces(const World& world) {
  now_.resize(world.state.size());
  points_.resize(world.state.size());
  shares_.assign(static_cast<std::size_t>(world.slabs.count()), Share{});
  world.team.run(world.slabs.count(), [&](int slab, int) {
    for (std::int32_t g = world.slabs.begin(slab); g < world.slabs.end(slab); ++g) {
      const auto i = static_cast<std::size_t>(g);
      if (!isMagnetic(world.state, i)) continue;
      now_[i] = magnetAt(world, i);
      points_[i] = {world.state.rows[i].position(), now_[i].moment};
    }
  });
  world.team.run(world.slabs.count(), [&](int slab, int) { act(world, slab, shares_[static_cast<std::size_t>(slab)]); });
  energy_ = 0;
  double power = 0;
  for (const Share& share : shares_) energy_ += share.energy, power += share.power;
  work_.add(power * world.step.dt);
}

void MagnetPass::account(const World& world, Ledger& ledger) const {
  ledger.potentialFields += energy_;
  ledger.workFields += work_.now(world.step.lead);
}

double MagnetPass::storedIn(const World& world, const std::vector<char>& grains) const {
  double energy = 0;
  for (int slab = 0; slab < world.slabs.count(); ++slab) {
    const Neighbours& near = near_[static_cast<std::size_t>(slab)];
    const std::int32_t first = world.slabs.begin(slab);
    for (std::int32_t g = first; g < world.slabs.end(slab); ++g) {
      const auto i = static_cast<std::size_t>(g), local = static_cast<std::size_t>(g - first);
      if (!grains[i] || !isMagnetic(world.state, i)) continue;
      const Magnet magnet = magnetAt(world, i);
      energy -= vec3(magnet.fixed).dot(magnet.source.field) + 0.5 * magnet.polarisability * magnet.source.field.squaredNorm();
      for (auto k = static_cast<std::size_t>(near.start[local]); k < static_cast<std::size_t>(near.start[local + 1]); ++k) {
        const auto j = static_cast<std::size_t>(near.list[k]);
        const double pair = dipolePair(between(world, i, j), magnet.moment, magnetAt(world, j).moment, cut_).energy;
        energy += grains[j] ? 0.5 * pair : pair;  // a pair of two marked grains is met twice
      }
    }
  }
  return energy;
}

}  // namespace tsubu::sim
