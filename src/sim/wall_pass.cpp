#include "sim/wall_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace tsubu::sim {

namespace {

Vec3 centreOf(const GrainRow& row) { return {row.x, row.y, row.z}; }

// A contact lies at least this share of the radius away from the centre, so that its direction survives the arithmetic.
constexpr double leastDistance = 1e-9;

// Which features a grain may touch is found out for so many steps, within bounds in terms of its radius.
constexpr double roomSteps = 20, leastRoom = 0.01, mostRoom = 0.2;

}  // namespace

WallPass::WallPass(const std::vector<Wall>& walls, const LawTraits& law) : walls_(&walls), law_(law), places_(walls.size()) {
  for (const Wall& wall : walls) loadOf_.push_back(wall.body ? static_cast<int>(loaded_++) : -1);
}

std::vector<WallLoad> WallPass::loads() const {
  std::vector<WallLoad> sums(loaded_);
  for (const SlabWalls& slab : slabs_) {
    for (std::size_t l = 0; l < slab.loads.size(); ++l) {
      sums[l].force += slab.loads[l].force;
      sums[l].contacts += slab.loads[l].contacts;
    }
  }
  return sums;
}

double WallPass::moveTo(double t, double dt) {
  double travel = 0;
  for (std::size_t w = 0; w < walls_->size(); ++w) {
    const Wall& wall = (*walls_)[w];
    if (wall.body) continue;
    places_[w].pose = wall.motion.at(t);
    places_[w].twist = wall.motion.twistAt(t);
    if (wall.motion.still()) continue;
    if (const auto plane = wall.surface->asPlane()) {
      // An unbounded plane moves only along its normal, as far as grains can tell; turning out of itself was refused.
      const Vec3 normal = places_[w].pose.rotation * plane->normal;
      const Vec3 point = places_[w].pose.toWorld(plane->offset * plane->normal);
      travel = std::max(travel, std::abs(places_[w].twist.at(point).dot(normal)) * dt);
    } else {
      travel = std::max(travel, wall.motion.maxSpeed(wall.surface->bounds(), t, t + dt) * dt);
    }
  }
  return travel;
}

bool WallPass::touches(const Vec3& centre, double radius) const {
  std::vector<std::uint32_t> features;
  for (std::size_t w = 0; w < walls_->size(); ++w) {
    const Vec3 local = places_[w].pose.toLocal(centre);
    (*walls_)[w].surface->candidates(local, radius, features);
    if (!features.empty()) return true;
  }
  return false;
}

/// Contacts in force before the lists were made anew, by grain in the new order.
struct WallPass::Before {
  struct Contact {
    std::int32_t grain;
    std::uint16_t wall;
    Vec3 centre;  // of the grain, in the frame of the wall
    WallCandidate candidate;
  };
  std::vector<Contact> contacts;
  std::vector<double> memory;  // `stateSize` numbers for each
  std::size_t stateSize;
  std::vector<std::int32_t> first, order;  // where the contacts of each grain begin in `order`, and the end

  Before(const std::vector<SlabWalls>& slabs, std::size_t size, std::size_t grains, const std::vector<std::int32_t>& newPlace)
      : stateSize(size), first(grains + 1, 0) {
    for (const SlabWalls& slab : slabs) {
      for (std::size_t n = 0; n < slab.groups.size(); ++n) {
        const WallGroup& group = slab.groups[n];
        const std::int32_t grain = newPlace[static_cast<std::size_t>(group.grain)];
        if (grain < 0) continue;
        for (std::int32_t c = group.first; c < group.last; ++c) {
          const WallCandidate& candidate = slab.candidates[static_cast<std::size_t>(c)];
          if (!candidate.touching) continue;
          contacts.push_back({grain, group.wall, slab.ways[n].centre, candidate});
          memory.insert(memory.end(), slab.memoryOf(c), slab.memoryOf(c) + stateSize);
          ++first[static_cast<std::size_t>(grain) + 1];
        }
      }
    }
    for (std::size_t g = 1; g < first.size(); ++g) first[g] += first[g - 1];
    std::vector<std::int32_t> next = first;
    order.resize(contacts.size());
    for (std::size_t k = 0; k < contacts.size(); ++k)
      order[static_cast<std::size_t>(next[static_cast<std::size_t>(contacts[k].grain)]++)] = static_cast<std::int32_t>(k);
  }
};

void WallPass::build(const State& state, const Slabs& slabs, double wallSkin, double dt, const std::vector<std::int32_t>& newPlace,
                     ThreadTeam& team) {
  settle();
  double work = 0;
  for (const SlabWalls& slab : slabs_) work += slab.work;
  const Before before(slabs_, static_cast<std::size_t>(law_.stateSize), state.size(), newPlace);
  slabs_.assign(static_cast<std::size_t>(slabs.count()), SlabWalls{});
  near_.resize(slabs_.size());
  if (!slabs_.empty()) slabs_[0].work = work;
  team.run(slabs.count(),
           [&](int s, int) { buildSlab(state, slabs.begin(s), slabs.end(s), wallSkin, dt, before, slabs_[static_cast<std::size_t>(s)]); });
}

/// A few grains that lie beside each other, since grains lie in the order of cells.
struct WallPass::Few {
  std::int32_t begin, end;
  Box box;                         // of their centres, world
  double reach = 0, fastest2 = 0;  // the largest of theirs: m from the centre, m²/s²

  void take(const Few& more) {
    box.extend(more.box);
    reach = std::max(reach, more.reach);
    fastest2 = std::max(fastest2, more.fastest2);
  }
};

std::vector<WallPass::Few> WallPass::fewByFew(const State& state, std::int32_t begin, std::int32_t end, double wallSkin) {
  constexpr std::int32_t size = 8;
  std::vector<Few> all;
  for (std::int32_t from = begin; from < end; from += size) {
    Few few{from, std::min(end, from + size), {}};
    for (std::int32_t g = few.begin; g < few.end; ++g) {
      const GrainRow& row = state.rows[static_cast<std::size_t>(g)];
      few.box.extend(centreOf(row));
      few.reach = std::max(few.reach, row.radius + state.skin[static_cast<std::size_t>(g)] + wallSkin);
      few.fastest2 = std::max(few.fastest2, norm2(row.velocity()));
    }
    all.push_back(few);
  }
  return all;
}

// Where none of a few grains can be near the wall, each of them need not be looked at.
bool WallPass::mayMeet(std::size_t wall, const Few& few, double dt) const {
  const WallPlace& place = places_[wall];
  const Vec3 middle = few.box.center(), half = 0.5 * few.box.sizes();
  const double wallSpeed = place.twist.at(middle).norm() + place.twist.angularVelocity.norm() * half.norm();
  const double reach = few.reach + dt * (std::sqrt(few.fastest2) + wallSpeed);
  const Vec3 around = place.rotation.transpose().cwiseAbs() * half + Vec3::Constant(reach), local = place.toLocal(middle);
  return (*walls_)[wall].surface->mayMeet(Box(local - around, local + around));
}

void WallPass::buildSlab(const State& state, std::int32_t begin, std::int32_t end, double wallSkin, double dt, const Before& before,
                         SlabWalls& slab) const {
  slab.stateSize = static_cast<std::size_t>(law_.stateSize);
  std::vector<std::uint32_t> features;
  const std::vector<Few> all = fewByFew(state, begin, end, wallSkin);
  Few whole{begin, end, {}};
  for (const Few& few : all) whole.take(few);
  for (std::size_t w = 0; w < walls_->size(); ++w) {
    const WallPlace& place = places_[w];
    slab.firstGroup.push_back(static_cast<std::int32_t>(slab.groups.size()));
    if (!mayMeet(w, whole, dt)) continue;
    for (const Few& few : all) {
      if (!mayMeet(w, few, dt)) continue;
      for (std::int32_t g = few.begin; g < few.end; ++g) {
        const GrainRow& row = state.rows[static_cast<std::size_t>(g)];
        const Vec3 centre = centreOf(row), local = place.toLocal(centre),
                   travel = dt * (Vec3(row.vx, row.vy, row.vz) - place.twist.at(centre));
        const double reach = row.radius + state.skin[static_cast<std::size_t>(g)] + wallSkin + travel.norm();
        (*walls_)[w].surface->candidates(local, reach, features);
        if (!features.empty()) addGroup(state, g, w, local - place.rotation.transpose() * travel, features, before, slab);
      }
    }
  }
  slab.firstGroup.push_back(static_cast<std::int32_t>(slab.groups.size()));
  slab.awake.resize(slab.candidates.size());
  slab.awakeFeatures.resize(slab.candidates.size());
}

// `start`: where the grain was a step ago, if it was nowhere near the wall.
void WallPass::addGroup(const State& state, std::int32_t grain, std::size_t wall, const Vec3& start,
                        const std::vector<std::uint32_t>& features, const Before& before, SlabWalls& slab) const {
  WallGroup group;
  group.grain = grain;
  group.wall = static_cast<std::uint16_t>(wall);
  group.first = static_cast<std::int32_t>(slab.candidates.size());
  WallWay way{start, start, 0};
  for (const std::uint32_t feature : features) {
    slab.features.push_back(feature);
    slab.candidates.push_back({feature, false, Vec3::Zero(), 1});
  }
  slab.memory.resize(slab.candidates.size() * slab.stateSize);
  group.last = static_cast<std::int32_t>(slab.candidates.size());
  for (auto n = before.first[static_cast<std::size_t>(grain)]; n < before.first[static_cast<std::size_t>(grain) + 1]; ++n) {
    const auto k = static_cast<std::size_t>(before.order[static_cast<std::size_t>(n)]);
    const Before::Contact& old = before.contacts[k];
    if (old.wall != group.wall) continue;
    way.centre = old.centre;
    if (!state.wrap.empty()) way.centre += places_[wall].rotation.transpose() * state.wrap[static_cast<std::size_t>(grain)];
    const auto at = std::lower_bound(features.begin(), features.end(), old.candidate.feature);
    if (at == features.end() || *at != old.candidate.feature) continue;
    const std::int32_t candidate = group.first + static_cast<std::int32_t>(at - features.begin());
    slab.candidates[static_cast<std::size_t>(candidate)] = old.candidate;
    std::copy_n(before.memory.data() + k * slab.stateSize, slab.stateSize, slab.memoryOf(candidate));
    group.awake = 1;
  }
  slab.groups.push_back(group);
  slab.ways.push_back(way);
}

/// Contacts that are put on the bench, and where each came from. The arrays are filled as far as `count` says.
struct WallPass::Batch {
  Batch(WallKernel k, bool withAccounts, Stage& bench, Accounts& sums, std::vector<ActingContact>* notes)
      : kernel(k), account(withAccounts), stage(bench), accounts(sums), acting(notes) {}

  WallKernel kernel;
  bool account;
  Stage& stage;
  Accounts& accounts;
  std::vector<ActingContact>* acting;
  WallContacts contacts;  // of the group at hand: too large to be made anew for each
  int count = 0;
  std::array<std::int32_t, chunkSize> grain, candidate;
  std::array<std::uint16_t, chunkSize> wall;
  std::array<WallContactRow, chunkSize> rows;
};

void WallPass::settle() {
  for (std::size_t w = 0; w < places_.size(); ++w) {
    WallPlace& place = places_[w];
    place.rotation = place.pose.rotation.toRotationMatrix();
    place.turns = place.twist.angularVelocity != Vec3::Zero();
    // A wall that moves under load takes part with its mass; all others cannot be moved.
    place.inverseMass = (*walls_)[w].body ? 1 / (*walls_)[w].body->mass : 0;
    place.plane = (*walls_)[w].surface->asPlane();
    if (!place.plane) continue;
    place.plane->normal = place.rotation * place.plane->normal;
    place.plane->offset += place.plane->normal.dot(place.pose.translation);
  }
}

void WallPass::evaluateSlab(int slabNumber, const PassContext& context, WallKernel kernel, bool account, Stage& stage, Accounts& accounts,
                            std::vector<ActingContact>* acting) {
  SlabWalls& slab = slabs_[static_cast<std::size_t>(slabNumber)];
  slab.lastWork = 0;
  slab.loads.assign(loaded_, WallLoad{});
  slab.tunnelled.clear();
  if (slab.groups.empty()) return;
  Batch batch(kernel, account, stage, accounts, acting);
  std::vector<std::int32_t>& near = near_[static_cast<std::size_t>(slabNumber)];
  for (std::size_t w = 0; w < walls_->size(); ++w) {
    if (places_[w].plane) {
      evaluatePlane(slab, w, context, batch);
    } else {
      findNearMesh(slab, w, context, near);
      for (const std::int32_t n : near)
        evaluateGroup(slab, slab.groups[static_cast<std::size_t>(n)], slab.ways[static_cast<std::size_t>(n)], context, batch);
    }
  }
  flush(slab, context, batch);
  slab.work += slab.lastWork;
}

// Most groups need nothing. Which they are is found without a branch: it cannot be foreseen.
void WallPass::findNearMesh(const SlabWalls& slab, std::size_t wall, const PassContext& context, std::vector<std::int32_t>& found) const {
  const std::int32_t first = slab.firstGroup[wall], last = slab.firstGroup[wall + 1];
  found.resize(static_cast<std::size_t>(last - first));
  std::size_t count = 0;
  for (std::int32_t n = first; n < last; ++n) {
    const WallGroup& group = slab.groups[static_cast<std::size_t>(n)];
    const WallWay& way = slab.ways[static_cast<std::size_t>(n)];
    const double way2 = (places_[wall].toLocal(centreOf(context.rows[group.grain])) - way.start).squaredNorm();
    found[count] = n;
    count += !(way2 < way.room * way.room) | (group.awake != 0);
  }
  found.resize(count);
}

// Finds out which candidates the grain may touch before it has gone farther than the margin, at least.
void WallPass::wake(const Surface& surface, const Vec3& centre, double radius, double margin, SlabWalls& slab, WallGroup& group,
                    WallWay& way) {
  way.start = centre;
  way.room = std::numeric_limits<double>::infinity();
  group.awake = 0;
  for (std::int32_t c = group.first; c < group.last; ++c) {
    const WallCandidate& candidate = slab.candidates[static_cast<std::size_t>(c)];
    const double refusal = candidate.touching ? 0 : surface.refusal(candidate.feature, centre, radius);
    if (refusal > margin) {
      way.room = std::min(way.room, refusal);
      continue;
    }
    const auto k = static_cast<std::size_t>(group.first + group.awake++);
    slab.awake[k] = c;
    slab.awakeFeatures[k] = candidate.feature;
    if (!surface.isFace(candidate.feature)) continue;
    const double over = surface.stayOver(candidate.feature, centre, radius);
    if (over <= margin) continue;
    slab.awakeFeatures[k] |= Surface::surelyOver;
    way.room = std::min(way.room, over);
  }
}

void WallPass::evaluateGroup(SlabWalls& slab, WallGroup& group, WallWay& way, const PassContext& context, Batch& batch) {
  const GrainRow& row = context.rows[group.grain];
  const WallPlace& place = places_[group.wall];
  const Surface& surface = *(*walls_)[group.wall].surface;
  const Vec3 local = place.toLocal(centreOf(row));
  const double travel2 = (local - way.centre).squaredNorm();
  const bool anew = !((local - way.start).squaredNorm() < way.room * way.room);
  if (anew) {
    const double step = context.step.dt * (Vec3(row.vx, row.vy, row.vz) - place.twist.at(centreOf(row))).norm();
    wake(surface, local, row.radius, std::clamp(roomSteps * step, leastRoom * row.radius, mostRoom * row.radius), slab, group, way);
  }
  const std::span<const std::uint32_t> awake(slab.awakeFeatures.data() + group.first, group.awake);

  WallContacts& contacts = batch.contacts;
  surface.contacts(local, row.radius, awake, contacts);

  // Only a centre that is no farther from a face than it has moved can have gone through it.
  bool mayHaveCrossed = travel2 > 0.0625 * row.radius * row.radius;
  for (const WallContact& contact : contacts) mayHaveCrossed = mayHaveCrossed || contact.distance * contact.distance <= travel2;
  if (mayHaveCrossed && travel2 > 0 && surface.crossedFace(way.centre, local, slab.featuresOf(group)) != Surface::none)
    slab.tunnelled.push_back(group.grain);
  way.centre = local;
  if (law_.stateSize > 0) handOver(surface, slab, group, contacts, place.rotation);

  // Candidates and contacts both ascend by feature.
  int next = 0;
  for (int n = 0; n < group.awake; ++n) {
    const std::int32_t c = slab.awake[static_cast<std::size_t>(group.first + n)];
    const WallCandidate& candidate = slab.candidates[static_cast<std::size_t>(c)];
    while (next < contacts.size() && contacts[next].feature < candidate.feature) ++next;
    const bool touches = next < contacts.size() && contacts[next].feature == candidate.feature;
    if (touches) {
      const WallContact& contact = contacts[next];
      const Vec3 normal = place.rotation * contact.normal;
      note(slab, c, normal, contact.weight);
      put(slab, place, group, c, contact.weight, std::max(contact.distance, leastDistance * row.radius) * normal,
          place.turns ? place.twist.at(place.rotation * contact.point + place.pose.translation) : place.twist.velocity, context, batch);
    } else if (candidate.touching) {
      putEnded(slab, place, group, c, context, batch);
    }
  }
}

// An unbounded plane has one feature and needs no frame of its own; a group is awake while its grain touches.
void WallPass::evaluatePlane(SlabWalls& slab, std::size_t wall, const PassContext& context, Batch& batch) {
  const WallPlace place = places_[wall];  // a copy that no store can change
  const Vec3 normal = place.plane->normal;
  for (std::int32_t n = slab.firstGroup[wall]; n < slab.firstGroup[wall + 1]; ++n) {
    WallGroup& group = slab.groups[static_cast<std::size_t>(n)];
    const GrainRow& row = context.rows[group.grain];
    const Vec3 centre = centreOf(row);
    const double height = place.plane->signedDistance(centre);
    if (!((height < row.radius) | (group.awake != 0))) continue;
    if (height < 0) {
      WallWay& way = slab.ways[static_cast<std::size_t>(n)];
      const std::uint32_t feature = 0;
      const Vec3 local = place.toLocal(centre);
      if ((*walls_)[wall].surface->crossedFace(way.centre, local, {&feature, 1}) != Surface::none) slab.tunnelled.push_back(group.grain);
      way.centre = local;
    }
    const bool touched = group.awake != 0;
    group.awake = height < row.radius;
    if (group.awake) {
      if (!touched) note(slab, group.first, normal, 1);  // a plane keeps its normal
      put(slab, place, group, group.first, 1, std::max(height, leastDistance * row.radius) * normal,
          place.turns ? place.twist.at(centre - height * normal) : place.twist.velocity, context, batch);
    } else if (touched) {
      putEnded(slab, place, group, group.first, context, batch);
    }
  }
}

void WallPass::note(SlabWalls& slab, std::int32_t candidateIndex, const Vec3& normal, double weight) {
  WallCandidate& candidate = slab.candidates[static_cast<std::size_t>(candidateIndex)];
  candidate.normal = normal;
  candidate.touching = true;
  candidate.weight = weight;
}

// A contact that has just ended goes through the kernel once more, out of reach, so that its memory is cleared and what its spring held
// is booked.
void WallPass::putEnded(SlabWalls& slab, const WallPlace& place, const WallGroup& group, std::int32_t candidateIndex,
                        const PassContext& context, Batch& batch) {
  WallCandidate& candidate = slab.candidates[static_cast<std::size_t>(candidateIndex)];
  candidate.touching = false;
  candidate.weight = 1;
  const GrainRow& row = context.rows[group.grain];
  put(slab, place, group, candidateIndex, 1, 2 * row.radius * candidate.normal,
      place.turns ? place.twist.at(centreOf(row)) : place.twist.velocity, context, batch);
}

// Puts a contact on the bench: from the wall to the centre (m), and the velocity (m/s) of the wall where they touch, in the world.
void WallPass::put(SlabWalls& slab, const WallPlace& place, const WallGroup& group, std::int32_t candidateIndex, double weight,
                   const Vec3& d, const Vec3& velocity, const PassContext& context, Batch& batch) {
  if (batch.count == chunkSize) flush(slab, context, batch);
  const auto k = static_cast<std::size_t>(batch.count++);
  const Vec3& spin = place.twist.angularVelocity;
  batch.grain[k] = group.grain;
  batch.wall[k] = group.wall;
  batch.candidate[k] = candidateIndex;
  batch.rows[k] = {d.x(), d.y(), d.z(), 0, velocity.x(), velocity.y(), velocity.z(), place.inverseMass, spin.x(), spin.y(), spin.z(), 0};
  batch.stage.weight[k] = weight;
  batch.stage.pairClass[k] = static_cast<std::int32_t>(context.material[group.grain] * context.materials + (*walls_)[group.wall].material);
}

// A grain that rolls from one feature to the next stays in contact: the new contact starts with the memory of the old one, as far as
// their normals agree (at a right angle, where a second contact adds to the first, with nothing).
void WallPass::handOver(const Surface& surface, SlabWalls& slab, const WallGroup& group, const WallContacts& contacts,
                        const Mat3& rotation) {
  const auto isForce = [this](int component) { return (law_.odd >> component & 1U) != 0; };
  const auto touchesNow = [&](std::uint32_t feature) {
    return std::any_of(contacts.begin(), contacts.end(), [&](const WallContact& contact) { return contact.feature == feature; });
  };
  const std::span<const std::int32_t> awake(slab.awake.data() + group.first, group.awake);
  for (const WallContact& contact : contacts) {
    const auto at = std::find_if(awake.begin(), awake.end(),
                                 [&](std::int32_t c) { return slab.candidates[static_cast<std::size_t>(c)].feature == contact.feature; });
    if (slab.candidates[static_cast<std::size_t>(*at)].touching) continue;
    const Vec3 normal = rotation * contact.normal;
    std::int32_t giver = -1;
    double kinship = 0;
    for (const std::int32_t o : awake) {
      const WallCandidate& other = slab.candidates[static_cast<std::size_t>(o)];
      if (!other.touching || !surface.neighbours(contact.feature, other.feature)) continue;
      const double k = contactKinship(normal, other.normal);
      if (k > kinship) kinship = k, giver = o;
    }
    if (giver < 0) continue;
    double *const to = slab.memoryOf(*at), *const from = slab.memoryOf(giver);
    for (int component = 0; component < law_.stateSize; ++component) to[component] = (isForce(component) ? kinship : 1) * from[component];
    if (touchesNow(slab.candidates[static_cast<std::size_t>(giver)].feature)) continue;
    // The giver has ended; what it keeps is let go.
    for (int component = 0; component < law_.stateSize; ++component)
      if (isForce(component)) from[component] *= std::sqrt(std::max(0.0, 1 - kinship * kinship));
  }
}

void WallPass::flush(SlabWalls& slab, const PassContext& context, Batch& batch) {
  if (batch.count == 0) return;
  Stage& s = batch.stage;
  batch.kernel(context, {batch.grain.data(), batch.rows.data(), batch.count, slab.memory.data(), batch.candidate.data()}, s,
               batch.accounts);
  for (int q = 0; (batch.account || batch.acting || loaded_ > 0) && q < batch.count; ++q) {
    const auto k = static_cast<std::size_t>(q);
    const bool touching = slab.candidates[static_cast<std::size_t>(batch.candidate[k])].touching;
    if (batch.acting && touching)
      batch.acting->push_back(contactIn(s, q, batch.grain[k], ActingContact::ofWall(batch.wall[k]), law_.rolls));
    if (const int loadPlace = loadOf_[batch.wall[k]]; loadPlace >= 0) {
      WallLoad& load = slab.loads[static_cast<std::size_t>(loadPlace)];
      load.force -= Vec3(s.fx[q], s.fy[q], s.fz[q]);
      load.contacts += touching;
      continue;
    }
    if (!batch.account) continue;
    const WallContactRow& wall = batch.rows[k];
    double power = s.fx[q] * wall.vx + s.fy[q] * wall.vy + s.fz[q] * wall.vz;
    if (law_.rolls) power += s.mx[q] * wall.wx + s.my[q] * wall.wy + s.mz[q] * wall.wz;
    slab.lastWork += power * context.step.dt;
  }
  batch.count = 0;
}

}  // namespace tsubu::sim
