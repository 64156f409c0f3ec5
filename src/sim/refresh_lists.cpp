// The neighbour lists of a running simulation: when they no longer hold, and how they are made anew (docs/decisions/0011-skins.md).

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/neighbours/skins.h"
#include "sim/simulation_impl.h"

namespace tsubu::sim {

namespace {

// Neighbour lists: the steps that a skin is to last, and its bounds in terms of the smallest radius. Magnets reach farther by it, and lists
// of them are longer. Then the share of it that belongs to the inner lists, and the bounds of that in terms of the radius.
constexpr double skinSteps = 250, leastSkin = 0.1, mostSkin = 1.3, mostSkinOfMagnets = 0.6;
constexpr double usualInnerShare = 0.1, mostInnerShare = 0.5, leastInner = 0.01, mostInner = 0.15;
// A little more than 1: what is rounded to a single number is then not too small.
constexpr double roundedUp = 1 + 1e-6;

}  // namespace

// Lists that hold for a step must hold at all its stages.
void Simulation::Impl::findDueLists() {
  const int ahead = rungeKutta ? 1 : 0;
  if (wallTravel + ahead * std::max(wallStep, bodyStep) > wallSkin) rebuildNeeded = true;
  due.clear();
  if (rebuildNeeded) return;
  for (int list = 0; list < drift.lists(); ++list)
    if (pairs.slabs()[static_cast<std::size_t>(list)].stale || drift.beyond(list, innerShare, ahead)) due.push_back(list);
}

// An outer list holds as long as no pair that the inner list must have can be missing from it.
bool Simulation::Impl::outerListsHold() {
  std::vector<char> holds(static_cast<std::size_t>(slabs.count()), 1);
  team.run(slabs.count(), [&](int slab, int) { holds[static_cast<std::size_t>(slab)] = slabHolds(slab); });
  return std::find(holds.begin(), holds.end(), 0) == holds.end();
}

bool Simulation::Impl::slabHolds(int slab) {
  double& way = drift.sinceSearch(slab);
  if (way + innerShare <= 1) return true;
  // The sum of the largest steps says too much: look how far grains really are from where they were.
  double most2 = 0;
  for (auto g = static_cast<std::size_t>(slabs.begin(slab)); g < static_cast<std::size_t>(slabs.end(slab)); ++g) {
    const GrainRow& row = state.rows[g];
    most2 = std::max(most2, (Vec3(row.x, row.y, row.z) - state.reference[g]).squaredNorm() * state.perSkin2[g]);
  }
  way = std::sqrt(most2);
  return way + innerShare <= 0.9;
}

void Simulation::Impl::refreshLists() {
  if (rebuildNeeded || (!due.empty() && !outerListsHold())) {
    rebuildLists();
    return;
  }
  pairs.refilter(state, innerShare, due, team);
  for (const int list : due) drift.filtered(list);
}

void Simulation::Impl::giveSkins() {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0;
  for (std::size_t g = 0; g < state.size(); ++g) {
    smallest = std::min(smallest, state.rows[g].radius);
    largest = std::max(largest, state.rows[g].radius);
  }
  if (state.size() == 0) smallest = largest = 1;
  SkinRule rule{skinSteps * model.timeStep, leastSkin * smallest, (model.magnets ? mostSkinOfMagnets : mostSkin) * smallest};
  if (model.skin > 0) rule.least = rule.most = 0.5 * model.skin;
  const bool moves =
      !moving.empty() || std::any_of(model.walls.begin(), model.walls.end(), [](const Wall& wall) { return !wall.motion.still(); });
  wallSkin = moves ? std::clamp(skinSteps * std::max(wallStep, bodyStep), rule.least, rule.most) : 0;
  // In a periodic domain no pair may be listed twice: half a period is as far as lists may reach.
  for (int axis = 0; axis < 3; ++axis)
    if (periods.along(axis)) rule.most = std::min(rule.most, 0.25 * periods.length(axis) - largest);
  // Nor may magnets meet twice: the pass refuses a domain that is too short for their reach and the least skin.
  for (int axis = 0; axis < 3; ++axis)
    if (model.magnets && periods.along(axis))
      rule.most = std::min(rule.most, std::max(rule.least, 0.25 * periods.length(axis) - 0.5 * model.magnets->cutOff));
  rule.least = std::min(rule.least, rule.most);
  state.skin = chooseSkins(state.rows, rule, team);
  largestSkin = state.skin.empty() ? 0.0 : static_cast<double>(*std::max_element(state.skin.begin(), state.skin.end()));
  innerShare =
      std::min({std::max(usualInnerShare, leastInner * smallest / rule.least), mostInnerShare, mostInner * smallest / largestSkin});
}

// Grains that have left a periodic domain go on at its other end. Under gravity that is work (E5): they may fall for ever.
void Simulation::Impl::wrapGrains() {
  state.wrap.assign(state.size(), Vec3::Zero());
  for (std::size_t g = 0; g < state.size(); ++g) {
    GrainRow& row = state.rows[g];
    const Vec3 x(row.x, row.y, row.z), shift = periods.shiftInto(x);
    if (shift == Vec3::Zero()) continue;
    state.wrap[g] = shift;
    if (!state.previous.empty()) {
      PlaceRow& before = state.previous[g];
      before.x += shift.x(), before.y += shift.y(), before.z += shift.z();
    }
    row.x += shift.x(), row.y += shift.y(), row.z += shift.z();
    wrapWork -= gravity.now().dot(shift) / row.inverseMass;
    if (model.counters.empty()) continue;
    // For counters that the shift passes, the grain comes from just outside the face through which it comes in.
    Vec3 before = x + shift;
    for (int axis = 0; axis < 3; ++axis)
      if (shift[axis] != 0) before[axis] = 2 * (shift[axis] < 0 ? model.domain.min() : model.domain.max())[axis] - before[axis];
    for (std::size_t c = 0; c < model.counters.size(); ++c)
      if (model.counters[c].normal.dot(shift) != 0) state.sides[g] = (state.sides[g] & ~(1U << c)) | (sidesOf(before) & (1U << c));
    countCrossing(g);
  }
}

void Simulation::Impl::rebuildLists() {
  if (periods.any()) {
    state.setImages(0);
    wrapGrains();
  }
  pairs.rememberContacts(slabs, team);
  giveSkins();
  std::vector<std::int32_t> order;
  double reach = 0;
  for (std::size_t g = 0; g < state.size(); ++g) reach = std::max(reach, 2 * (state.rows[g].radius + state.skin[g]));
  slabs = sortIntoSlabs(state.rows, reach, order, team);
  std::vector<std::int32_t> newPlace(order.size());
  for (std::size_t g = 0; g < order.size(); ++g) newPlace[static_cast<std::size_t>(order[g])] = static_cast<std::int32_t>(g);
  state.reorder(order);
  if (!placeAfterRemoval.empty()) {
    for (std::int32_t& place : placeAfterRemoval)
      if (place >= 0) place = newPlace[static_cast<std::size_t>(place)];
    newPlace.swap(placeAfterRemoval);
    placeAfterRemoval.clear();
  }
  grid.build(state.rows, 0, state.skin);
  pairs.build(state, slabs, grid, innerShare, newPlace, team, periods);
  // From here on only those look into the grid who arrive or are swept; it is as large as what is made next.
  if (model.streams.empty() && !model.continuous) grid = CellGrid();
  drift.restart(pairs.slabsInLists(slabs));
  state.clearForces();
  state.allToSingle();
  // What has been swept has not come by the straight way, and not through a wall.
  walls.build(state, slabs, wallSkin, steps > 0 && !model.continuous ? model.timeStep : 0.0, newPlace, team);
  state.reference.resize(state.size());
  state.perSkin2.resize(state.size());
  team.runParts(state.size(), [&](std::size_t from, std::size_t to) {
    for (std::size_t g = from; g < to; ++g) {
      state.reference[g] = positionOf(state.rows[g]);
      const double skin = state.skin[g];
      state.perSkin2[g] = static_cast<float>(roundedUp / (skin * skin));
    }
  });
  state.wrap.clear();
  for (const auto& pass : passes) pass->regroup(world(time(), model.timeStep), newPlace);
  wallTravel = 0;
  rebuildNeeded = false;
}

}  // namespace tsubu::sim
