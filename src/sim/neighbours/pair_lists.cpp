#include "sim/neighbours/pair_lists.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "sim/kernel/grain_kernels.h"
#include "sim/kernel/kernels.h"

namespace tsubu::sim {

namespace {

// Sorts (i, j) pairs that come flat, i0 j0 i1 j1 …, with i in [first, last): counting by i, then the few j of each i.
void sortPairs(std::initializer_list<const std::vector<std::int32_t>*> flats, std::int32_t first, std::int32_t last,
               std::vector<std::int32_t>& outI, std::vector<std::int32_t>& outJ) {
  std::size_t pairs = 0;
  for (const auto* flat : flats) pairs += flat->size() / 2;
  std::vector<std::int32_t> start(static_cast<std::size_t>(last - first) + 1, 0);
  for (const auto* flat : flats)
    for (std::size_t k = 0; k < flat->size(); k += 2) ++start[static_cast<std::size_t>((*flat)[k] - first) + 1];
  for (std::size_t g = 1; g < start.size(); ++g) start[g] += start[g - 1];
  outI.resize(pairs);
  outJ.resize(pairs);
  std::vector<std::int32_t> next(start.begin(), start.end() - 1);
  for (const auto* flat : flats) {
    for (std::size_t k = 0; k < flat->size(); k += 2) {
      const auto place = static_cast<std::size_t>(next[static_cast<std::size_t>((*flat)[k] - first)]++);
      outI[place] = (*flat)[k];
      outJ[place] = (*flat)[k + 1];
    }
  }
  for (std::size_t g = 0; g + 1 < start.size(); ++g) std::sort(outJ.begin() + start[g], outJ.begin() + start[g + 1]);
}

}  // namespace

void PairLists::rememberContacts() {
  const auto components = static_cast<std::size_t>(stateSize_);
  const auto carries = [&](const SlabPairs& pairs, std::size_t k) {
    for (std::size_t c = 0; c < components; ++c)
      if (pairs.memory.at(c, k) != 0) return true;
    return false;
  };
  std::size_t count = 0;
  for (const SlabPairs& pairs : slabs_)
    for (std::size_t k = 0; k < pairs.i.size(); ++k) count += carries(pairs, k);
  Remembered& r = remembered_;
  r.i.reserve(count);
  r.j.reserve(count);
  r.memory.reserve(count * components);
  for (SlabPairs& pairs : slabs_) {
    for (std::size_t k = 0; k < pairs.i.size(); ++k) {
      if (!carries(pairs, k)) continue;
      r.i.push_back(pairs.i[k]);
      r.j.push_back(pairs.grainOf(pairs.j[k]));
      for (std::size_t c = 0; c < components; ++c) r.memory.push_back(pairs.memory.at(c, k));
    }
    pairs = SlabPairs{};
  }
}

// Forces in the memory belong to i as seen from j: they change their sign when the pair turns round.
void PairLists::turnRound(double* memory) const {
  for (int c = 0; c < stateSize_; ++c)
    if (odd_ >> c & 1U) memory[c] = -memory[c];
}

// Brings what is remembered into the new order: (lower, higher), and those of grains that are gone left out.
void PairLists::placeRemembered(std::size_t grains, const std::vector<std::int32_t>& newPlace) {
  Remembered& r = remembered_;
  r.first.assign(grains + 1, 0);
  for (std::size_t k = 0; k < r.i.size(); ++k) {
    r.i[k] = newPlace[static_cast<std::size_t>(r.i[k])];
    r.j[k] = newPlace[static_cast<std::size_t>(r.j[k])];
    if (r.i[k] < 0 || r.j[k] < 0) continue;
    if (r.i[k] > r.j[k]) {
      std::swap(r.i[k], r.j[k]);
      turnRound(&r.memory[k * static_cast<std::size_t>(stateSize_)]);
    }
    ++r.first[static_cast<std::size_t>(r.i[k]) + 1];
  }
  for (std::size_t g = 1; g < r.first.size(); ++g) r.first[g] += r.first[g - 1];
  r.order.resize(static_cast<std::size_t>(r.first.back()));
  // Counts each beginning up to that of the next grain, and puts them back.
  for (std::size_t k = 0; k < r.i.size(); ++k)
    if (r.i[k] >= 0 && r.j[k] >= 0)
      r.order[static_cast<std::size_t>(r.first[static_cast<std::size_t>(r.i[k])]++)] = static_cast<std::int32_t>(k);
  std::copy_backward(r.first.begin(), r.first.end() - 1, r.first.end());
  r.first.front() = 0;
}

void PairLists::searchSlab(const State& state, const Slabs& slabs, const CellGrid& grid, int slab, FlatPairs& own,
                           FlatPairs& before) const {
  const std::int32_t first = slabs.begin(slab);
  std::vector<std::int32_t> partners;
  // About what there will be: a list that grows is there twice for a moment.
  own.reserve(8 * static_cast<std::size_t>(slabs.end(slab) - first));
  before.reserve(3 * static_cast<std::size_t>(slabs.end(slab) - first));
  for (std::int32_t g = first; g < slabs.end(slab); ++g) {
    const GrainRow& row = state.rows[static_cast<std::size_t>(g)];
    const std::size_t count = grid.partners(Vec3(row.x, row.y, row.z), row.radius + state.skin[static_cast<std::size_t>(g)], g, partners);
    for (std::size_t k = 0; k < count; ++k) {
      const std::int32_t i = std::min(g, partners[k]), j = std::max(g, partners[k]);
      FlatPairs& list = i >= first ? own : before;
      list.push_back(i);
      list.push_back(j);
    }
  }
}

// Of the two ways to see a pair across the boundary one is taken: shifts with a positive number.
void PairLists::searchAcross(const State& state, const Slabs& slabs, const CellGrid& grid, const Periods& periods, int slab,
                             FlatPairs& across, std::vector<Image>& images) {
  struct Found {
    std::int32_t grain, partner;
    int shift;
  };
  std::vector<Found> found;
  std::vector<std::int32_t> partners;
  for (std::int32_t g = slabs.begin(slab); g < slabs.end(slab); ++g) {
    const GrainRow& row = state.rows[static_cast<std::size_t>(g)];
    const Vec3 x(row.x, row.y, row.z);
    const double radius = row.radius + state.skin[static_cast<std::size_t>(g)];
    periods.forImages(x, grid.farthest(radius), [&](int shift) {
      if (shift < 0) return;
      partners.clear();
      grid.near(x + periods.shift(shift), radius, g, partners);
      for (const std::int32_t partner : partners) found.push_back({g, partner, -shift});
    });
  }
  const auto byImage = [](const Found& a, const Found& b) {
    if (a.partner != b.partner) return a.partner < b.partner;
    return a.shift != b.shift ? a.shift < b.shift : a.grain < b.grain;
  };
  std::sort(found.begin(), found.end(), byImage);
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (k == 0 || found[k].partner != found[k - 1].partner || found[k].shift != found[k - 1].shift)
      images.push_back({found[k].partner, periods.shift(found[k].shift)});
    across.push_back(found[k].grain);
    across.push_back(static_cast<std::int32_t>(images.size()) - 1);
  }
}

// Gives every image its row, and notes for each slab which rows are images of its grains.
void PairLists::placeImages(State& state, const Slabs& slabs) {
  std::size_t count = 0;
  for (const SlabPairs& slab : slabs_) count += slab.images.size();
  const auto grains = static_cast<std::int32_t>(state.size());
  state.setImages(count);
  folds_.clear();
  for (SlabPairs& slab : slabs_) {
    slab.firstImage = grains + static_cast<std::int32_t>(folds_.size());
    for (const Image& image : slab.images) {
      const std::int32_t row = grains + static_cast<std::int32_t>(folds_.size());
      folds_.push_back({image.owner, row});
      state.material[static_cast<std::size_t>(row)] = state.material[static_cast<std::size_t>(image.owner)];
      state.skin[static_cast<std::size_t>(row)] = state.skin[static_cast<std::size_t>(image.owner)];
    }
  }
  std::stable_sort(folds_.begin(), folds_.end(), [](const Fold& a, const Fold& b) { return a.owner < b.owner; });
  const auto lower = [](const Fold& fold, std::int32_t grain) { return fold.owner < grain; };
  firstFold_.clear();
  for (const std::int32_t first : slabs.first)
    firstFold_.push_back(static_cast<std::size_t>(std::lower_bound(folds_.begin(), folds_.end(), first, lower) - folds_.begin()));
}

void PairLists::refreshImages(State& state, const SlabPairs& slab) {
  for (std::size_t k = 0; k < slab.images.size(); ++k) {
    const Image& image = slab.images[k];
    GrainRow row = state.rows[static_cast<std::size_t>(image.owner)];
    row.x += image.shift.x(), row.y += image.shift.y(), row.z += image.shift.z();
    const std::size_t at = static_cast<std::size_t>(slab.firstImage) + k;
    state.rows[at] = row;
    if (!state.single.empty()) state.toSingle(at);
  }
}

void PairLists::foldImages(State& state, int slab) const {
  const auto s = static_cast<std::size_t>(slab);
  for (std::size_t k = firstFold_[s]; k < firstFold_[s + 1]; ++k) {
    ForceRow& owner = state.forces[static_cast<std::size_t>(folds_[k].owner)];
    ForceRow& image = state.forces[static_cast<std::size_t>(folds_[k].image)];
    owner.fx += image.fx, owner.fy += image.fy, owner.fz += image.fz;
    owner.qx += image.qx, owner.qy += image.qy, owner.qz += image.qz;
    image = ForceRow{};
  }
}

void PairLists::build(State& state, const Slabs& slabs, const CellGrid& grid, double share, const std::vector<std::int32_t>& newPlace,
                      ThreadTeam& team, const Periods& periods) {
  const int count = slabs.count();
  std::vector<FlatPairs> own(static_cast<std::size_t>(count)), before(static_cast<std::size_t>(count) + 1),
      across(static_cast<std::size_t>(count));
  SlabPairs none;
  none.memory = PairMemory(single_);
  slabs_.assign(static_cast<std::size_t>(count), none);
  rooms_.resize(static_cast<std::size_t>(team.threads()), Room{{}, {}, PairMemory(single_)});
  team.run(count, [&](int slab, int) {
    const auto s = static_cast<std::size_t>(slab);
    searchSlab(state, slabs, grid, slab, own[s], before[s]);
    if (periods.any()) searchAcross(state, slabs, grid, periods, slab, across[s], slabs_[s].images);
  });
  if (periods.any()) placeImages(state, slabs);
  placeRemembered(state.size(), newPlace);
  team.run(count, [&](int slab, int thread) {
    const auto s = static_cast<std::size_t>(slab);
    SlabPairs& pairs = slabs_[s];
    for (std::size_t k = 1; k < across[s].size(); k += 2) across[s][k] += pairs.firstImage;
    sortPairs({&own[s], &before[s + 1], &across[s]}, slabs.begin(slab), slabs.end(slab), pairs.outerI, pairs.outerJ);
    for (FlatPairs* sorted : {&own[s], &before[s + 1], &across[s]}) *sorted = FlatPairs();
    filterSlab(state, pairs, share, rooms_[static_cast<std::size_t>(thread)]);
    if (stateSize_ > 0) handMemory(pairs);
  });
  remembered_ = Remembered();
}

namespace {

// What a pair that never touches is given as long as it is still in the inner list, m.
constexpr double hardlyEver = 1e-12;

// A grain has few partners: they are gone through, images included.
template <class Visit>
void visitPair(const SlabPairs& slab, const std::vector<std::int32_t>& is, const std::vector<std::int32_t>& js, std::int32_t i,
               std::int32_t j, Visit&& visit) {
  for (auto at = std::lower_bound(is.begin(), is.end(), i); at != is.end() && *at == i; ++at) {
    const auto k = static_cast<std::size_t>(at - is.begin());
    if (slab.grainOf(js[k]) == j) visit(k);
  }
}

}  // namespace

void PairLists::setTouch(const Slabs& slabs, std::int32_t a, std::int32_t b, double distance) {
  const auto set = [&](std::int32_t i, std::int32_t j) {
    SlabPairs& pairs = slabs_[static_cast<std::size_t>(slabs.of(i))];
    visitPair(pairs, pairs.outerI, pairs.outerJ, i, j, [&](std::size_t k) {
      if (pairs.outerTouch.empty()) pairs.outerTouch.assign(pairs.outerI.size(), 0.0);
      pairs.stale = pairs.stale || (pairs.outerTouch[k] < 0) != (distance < 0);
      pairs.outerTouch[k] = distance;
    });
    visitPair(pairs, pairs.i, pairs.j, i, j, [&](std::size_t k) {
      if (pairs.touch.empty()) pairs.touch.assign(pairs.i.size(), 0.0);
      pairs.touch[k] = distance < 0 ? hardlyEver : distance;
    });
  };
  set(std::min(a, b), std::max(a, b));
  if (hasImages()) set(std::max(a, b), std::min(a, b));
}

bool PairLists::copyMemory(const Slabs& slabs, std::int32_t a, std::int32_t b, double* memory) const {
  bool found = false;
  const auto find = [&](std::int32_t i, std::int32_t j) {
    const SlabPairs& pairs = slabs_[static_cast<std::size_t>(slabs.of(i))];
    visitPair(pairs, pairs.i, pairs.j, i, j, [&](std::size_t k) {
      for (std::size_t c = 0; c < static_cast<std::size_t>(stateSize_); ++c) memory[c] = pairs.memory.at(c, k);
      found = true;
    });
  };
  find(std::min(a, b), std::max(a, b));
  if (!found && hasImages()) find(std::max(a, b), std::min(a, b));
  return found;
}

// What is remembered goes to the same pairs in the new lists: seen from the lower grain, also where the pair is seen from the higher one
// (across the boundary).
void PairLists::handMemory(SlabPairs& pairs) const {
  const Remembered& r = remembered_;
  const auto components = static_cast<std::size_t>(stateSize_);
  double seen[mostMemory];
  for (std::size_t pair = 0; pair < pairs.i.size(); ++pair) {
    const std::int32_t i = pairs.i[pair], j = pairs.grainOf(pairs.j[pair]), low = std::min(i, j), high = std::max(i, j);
    const auto first = static_cast<std::size_t>(r.first[static_cast<std::size_t>(low)]);
    const auto last = static_cast<std::size_t>(r.first[static_cast<std::size_t>(low) + 1]);
    for (std::size_t n = first; n < last; ++n) {
      const auto k = static_cast<std::size_t>(r.order[n]);
      if (r.j[k] != high) continue;
      std::copy_n(&r.memory[k * components], components, seen);
      if (i != low) turnRound(seen);
      for (std::size_t c = 0; c < components; ++c) pairs.memory.set(c, pair, seen[c]);
    }
  }
}

void PairLists::refilter(State& state, double share, const std::vector<int>& lists, ThreadTeam& team) {
  team.run(static_cast<int>(lists.size()), [&](int n, int thread) {
    SlabPairs& list = slabs_[static_cast<std::size_t>(lists[static_cast<std::size_t>(n)])];
    filterSlab(state, list, share, rooms_[static_cast<std::size_t>(thread)]);
  });
}

std::vector<std::vector<int>> PairLists::slabsInLists(const Slabs& slabs) const {
  std::vector<std::vector<int>> all;
  for (int s = 0; s < slabs.count(); ++s) {
    std::vector<int> of{s};
    if (s + 1 < slabs.count()) of.push_back(s + 1);
    for (const Image& image : slabs_[static_cast<std::size_t>(s)].images) of.push_back(slabs.of(image.owner));
    std::sort(of.begin(), of.end());
    of.erase(std::unique(of.begin(), of.end()), of.end());
    all.push_back(std::move(of));
  }
  return all;
}

void PairLists::filterSlab(State& state, SlabPairs& pairs, double share, Room& room) const {
  pairs.stale = false;
  refreshImages(state, pairs);
  const std::size_t outer = pairs.outerI.size();
  if (room.near.size() < outer + 3) room.near.resize(outer + 3);
  const GrainKernels& loops = *kernels().grains;
  const auto nearAmong = [&](auto* loop, const auto& rows) {
    return loop(rows.data(), state.skin.data(), share, pairs.outerI.data(), pairs.outerJ.data(), static_cast<std::int64_t>(outer), room.near.data());
  };
  const std::int64_t found = state.single.empty() ? nearAmong(loops.nearPairs, state.rows) : nearAmong(loops.nearSinglePairs, state.single);
  const auto begin = room.near.begin();
  auto end = begin + found;
  if (!pairs.outerTouch.empty())
    end = std::remove_if(begin, end, [&](std::int32_t o) { return pairs.outerTouch[static_cast<std::size_t>(o)] < 0; });

  const auto count = static_cast<std::size_t>(end - begin);
  for (auto* column : {&pairs.i, &pairs.j}) fit(*column, count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto o = static_cast<std::size_t>(room.near[k]);
    pairs.i[k] = pairs.outerI[o];
    pairs.j[k] = pairs.outerJ[o];
  }
  pairs.touch.clear();
  if (!pairs.outerTouch.empty())
    for (auto o = begin; o != end; ++o) pairs.touch.push_back(pairs.outerTouch[static_cast<std::size_t>(*o)]);
  if (stateSize_ == 0) return;
  pairs.outerIndex.swap(room.lastIndex);
  fit(pairs.outerIndex, count);
  std::copy(begin, end, pairs.outerIndex.begin());
  std::swap(pairs.memory, room.lastMemory);
  pairs.memory.fit(count, static_cast<std::size_t>(stateSize_));
  if (single_)
    keepMemory<float>(pairs, room);
  else
    keepMemory<double>(pairs, room);
}

// Memory goes from the last inner list to the present one. Both follow the order of the outer list.
template <class Real>
void PairLists::keepMemory(SlabPairs& pairs, const Room& room) const {
  const std::size_t count = pairs.outerIndex.size(), before = room.lastMemory.stride();
  Real* const now = pairs.memory.columns<Real>();
  const Real* const last = room.lastMemory.columns<Real>();
  const auto components = static_cast<std::size_t>(stateSize_);
  std::size_t was = 0;
  for (std::size_t k = 0; k < count; ++k) {
    while (was < before && room.lastIndex[was] < pairs.outerIndex[k]) ++was;
    const bool known = was < before && room.lastIndex[was] == pairs.outerIndex[k];
    for (std::size_t c = 0; c < components; ++c) now[c * count + k] = known ? last[c * before + was] : 0;
  }
}

}  // namespace tsubu::sim
