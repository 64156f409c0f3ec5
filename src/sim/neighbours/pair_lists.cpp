#include "sim/neighbours/pair_lists.h"

#include <algorithm>

namespace tsubu::sim {

namespace {

bool nearer(const GrainRow& a, const GrainRow& b, double skin) {
  const double dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z, cut = a.radius + b.radius + skin;
  return dx * dx + dy * dy + dz * dz < cut * cut;
}

// Sorts (i, j) pairs that come flat, i0 j0 i1 j1 …, with i in [first, last): counting by i, then the few j of each i.
void sortPairs(const std::vector<std::int32_t>& flatA, const std::vector<std::int32_t>& flatB, std::int32_t first, std::int32_t last,
               std::vector<std::int32_t>& outI, std::vector<std::int32_t>& outJ) {
  const std::size_t pairs = (flatA.size() + flatB.size()) / 2;
  std::vector<std::int32_t> start(static_cast<std::size_t>(last - first) + 1, 0);
  for (const auto* flat : {&flatA, &flatB})
    for (std::size_t k = 0; k < flat->size(); k += 2) ++start[static_cast<std::size_t>((*flat)[k] - first) + 1];
  for (std::size_t g = 1; g < start.size(); ++g) start[g] += start[g - 1];
  outI.resize(pairs);
  outJ.resize(pairs);
  std::vector<std::int32_t> next(start.begin(), start.end() - 1);
  for (const auto* flat : {&flatA, &flatB}) {
    for (std::size_t k = 0; k < flat->size(); k += 2) {
      const auto place = static_cast<std::size_t>(next[static_cast<std::size_t>((*flat)[k] - first)]++);
      outI[place] = (*flat)[k];
      outJ[place] = (*flat)[k + 1];
    }
  }
  for (std::size_t g = 0; g + 1 < start.size(); ++g) std::sort(outJ.begin() + start[g], outJ.begin() + start[g + 1]);
}

}  // namespace

std::size_t PairLists::listed() const {
  std::size_t count = 0;
  for (const SlabPairs& pairs : slabs_) count += pairs.i.size();
  return count;
}

void PairLists::rememberContacts() {
  remembered_.clear();
  if (stateSize_ == 0) return;
  for (const SlabPairs& pairs : slabs_) {
    for (std::size_t k = 0; k < pairs.i.size(); ++k) {
      Remembered contact{pairs.i[k], pairs.j[k], {}};
      bool any = false;
      for (int c = 0; c < stateSize_; ++c) {
        contact.memory[c] = pairs.memory[static_cast<std::size_t>(c) * pairs.stride + k];
        any = any || contact.memory[c] != 0;
      }
      if (any) remembered_.push_back(contact);
    }
  }
}

// Brings what is remembered into the new order, (lower, higher) and sorted. Memory belongs to i as seen from j: it changes its sign
// when the pair turns round.
void PairLists::placeRemembered(const State& state, const std::vector<std::int32_t>& newPlace) {
  std::vector<std::int32_t> start(state.size() + 1, 0);
  std::size_t kept = 0;
  for (Remembered& contact : remembered_) {
    std::int32_t a = newPlace[static_cast<std::size_t>(contact.i)], b = newPlace[static_cast<std::size_t>(contact.j)];
    if (a < 0 || b < 0) continue;
    if (a > b) {
      std::swap(a, b);
      for (int c = 0; c < stateSize_; ++c)
        if (odd_ >> c & 1U) contact.memory[c] = -contact.memory[c];
    }
    contact.i = a;
    contact.j = b;
    remembered_[kept++] = contact;
    ++start[static_cast<std::size_t>(a) + 1];
  }
  remembered_.resize(kept);
  for (std::size_t g = 1; g < start.size(); ++g) start[g] += start[g - 1];
  std::vector<Remembered> sorted(kept);
  for (const Remembered& contact : remembered_) sorted[static_cast<std::size_t>(start[static_cast<std::size_t>(contact.i)]++)] = contact;
  remembered_.swap(sorted);
}

void PairLists::searchSlab(const State& state, const Slabs& slabs, const CellGrid& grid, int slab, std::vector<std::int32_t>& own,
                           std::vector<std::int32_t>& before) const {
  std::vector<std::int32_t> found;
  for (std::int32_t g = slabs.begin(slab); g < slabs.end(slab); ++g) {
    const GrainRow& row = state.rows[static_cast<std::size_t>(g)];
    found.clear();
    grid.near(Vec3(row.x, row.y, row.z), row.radius, g, false, found);
    const int level = grid.level(row.radius);
    for (const std::int32_t other : found) {
      // Partners in the same level find each other twice: the lower one speaks.
      if (other < g && grid.level(state.rows[static_cast<std::size_t>(other)].radius) == level) continue;
      const std::int32_t i = std::min(g, other), j = std::max(g, other);
      std::vector<std::int32_t>& list = i >= slabs.begin(slab) ? own : before;
      list.push_back(i);
      list.push_back(j);
    }
  }
}

void PairLists::build(const State& state, const Slabs& slabs, const CellGrid& grid, double innerSkin,
                      const std::vector<std::int32_t>& newPlace, ThreadTeam& team) {
  const int count = slabs.count();
  std::vector<std::vector<std::int32_t>> own(static_cast<std::size_t>(count)), before(static_cast<std::size_t>(count) + 1);
  team.run(count, [&](int slab, int) {
    searchSlab(state, slabs, grid, slab, own[static_cast<std::size_t>(slab)], before[static_cast<std::size_t>(slab)]);
  });
  slabs_.assign(static_cast<std::size_t>(count), SlabPairs{});
  placeRemembered(state, newPlace);
  team.run(count, [&](int slab, int) {
    const auto s = static_cast<std::size_t>(slab);
    SlabPairs& pairs = slabs_[s];
    sortPairs(own[s], before[s + 1], slabs.begin(slab), slabs.end(slab), pairs.outerI, pairs.outerJ);
    filterSlab(state, pairs, innerSkin);
    if (stateSize_ == 0 || pairs.i.empty()) return;
    const auto lower = [](const Remembered& contact, std::int32_t grain) { return contact.i < grain; };
    auto contact = std::lower_bound(remembered_.begin(), remembered_.end(), slabs.begin(slab), lower);
    const auto last = std::lower_bound(contact, remembered_.end(), slabs.end(slab), lower);
    std::size_t k = 0;
    for (; contact != last; ++contact) {
      while (k < pairs.i.size() && pairs.i[k] < contact->i) ++k;
      for (std::size_t here = k; here < pairs.i.size() && pairs.i[here] == contact->i; ++here) {
        if (pairs.j[here] != contact->j) continue;
        for (int c = 0; c < stateSize_; ++c) pairs.memory[static_cast<std::size_t>(c) * pairs.stride + here] = contact->memory[c];
      }
    }
  });
  remembered_.clear();
}

void PairLists::refilter(const State& state, double innerSkin, ThreadTeam& team) {
  team.run(static_cast<int>(slabs_.size()), [&](int slab, int) { filterSlab(state, slabs_[static_cast<std::size_t>(slab)], innerSkin); });
}

void PairLists::filterSlab(const State& state, SlabPairs& pairs, double innerSkin) const {
  const SlabPairs old{{}, {}, {}, {}, std::move(pairs.outerIndex), std::move(pairs.memory), pairs.stride};
  pairs.i.clear();
  pairs.j.clear();
  pairs.outerIndex.clear();
  for (std::size_t o = 0; o < pairs.outerI.size(); ++o) {
    const std::int32_t i = pairs.outerI[o], j = pairs.outerJ[o];
    if (!nearer(state.rows[static_cast<std::size_t>(i)], state.rows[static_cast<std::size_t>(j)], innerSkin)) continue;
    pairs.i.push_back(i);
    pairs.j.push_back(j);
    pairs.outerIndex.push_back(static_cast<std::int32_t>(o));
  }
  if (stateSize_ == 0) return;
  pairs.stride = pairs.i.size();
  pairs.memory.assign(pairs.stride * static_cast<std::size_t>(stateSize_), 0.0);
  // Both inner lists follow the order of the outer one.
  std::size_t was = 0;
  for (std::size_t k = 0; k < pairs.outerIndex.size(); ++k) {
    while (was < old.outerIndex.size() && old.outerIndex[was] < pairs.outerIndex[k]) ++was;
    if (was == old.outerIndex.size()) break;
    if (old.outerIndex[was] != pairs.outerIndex[k]) continue;
    for (int c = 0; c < stateSize_; ++c)
      pairs.memory[static_cast<std::size_t>(c) * pairs.stride + k] = old.memory[static_cast<std::size_t>(c) * old.stride + was];
  }
}

}  // namespace tsubu::sim
