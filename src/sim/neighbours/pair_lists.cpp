#include "sim/neighbours/pair_lists.h"

#include <algorithm>
#include <utility>

#include "sim/kernel/grain_kernels.h"
#include "sim/kernel/kernels.h"

namespace tsubu::sim {

void PairLists::rememberContacts(const Slabs& slabs, ThreadTeam& team) {
  Remembered& r = remembered_;
  r.clear();
  if (stateSize_ == 0 || slabs_.empty()) {
    slabs_.clear();
    return;
  }
  r.slabs.resize(slabs_.size());
  r.begin = slabs.first;
  r.slab.resize(static_cast<std::size_t>(slabs.first.back()));
  team.run(slabs.count(), [&](int s, int) {
    SlabPairs& pairs = slabs_[static_cast<std::size_t>(s)];
    Remembered::Contacts& contacts = r.slabs[static_cast<std::size_t>(s)];
    std::fill(r.slab.begin() + slabs.begin(s), r.slab.begin() + slabs.end(s), static_cast<std::uint16_t>(s));
    contacts.first.reserve(static_cast<std::size_t>(slabs.end(s) - slabs.begin(s)) + 1);
    std::size_t k = 0;
    for (std::int32_t g = slabs.begin(s); g < slabs.end(s); ++g) {
      contacts.first.push_back(static_cast<std::int32_t>(k));
      while (k < pairs.i.size() && pairs.i[k] == g) ++k;
    }
    contacts.first.push_back(static_cast<std::int32_t>(k));
    if (!pairs.images.empty())
      for (std::int32_t& j : pairs.j) j = pairs.grainOf(j);
    contacts.partner = std::move(pairs.j);
    contacts.memory = std::move(pairs.memory);
    pairs = SlabPairs{};
  });
}

void PairLists::findOldPlaces(std::size_t grains, const std::vector<std::int32_t>& newPlace) {
  remembered_.oldPlace.assign(grains, -1);
  for (std::size_t old = 0; old < remembered_.slab.size(); ++old)
    if (newPlace[old] >= 0) remembered_.oldPlace[static_cast<std::size_t>(newPlace[old])] = static_cast<std::int32_t>(old);
}

// Copies what is remembered of a pair (old places) as it was seen from that grain.
template <class Real>
bool PairLists::recall(std::int32_t seenFrom, std::int32_t partner, Real* memory) const {
  const auto slab = static_cast<std::size_t>(remembered_.slab[static_cast<std::size_t>(seenFrom)]);
  const Remembered::Contacts& contacts = remembered_.slabs[slab];
  const auto grain = static_cast<std::size_t>(seenFrom - remembered_.begin[slab]);
  for (auto k = static_cast<std::size_t>(contacts.first[grain]); k < static_cast<std::size_t>(contacts.first[grain + 1]); ++k) {
    if (contacts.partner[k] != partner) continue;
    const Real* const columns = contacts.memory.columns<Real>();
    for (int c = 0; c < stateSize_; ++c) memory[c] = columns[static_cast<std::size_t>(c) * contacts.memory.stride() + k];
    return true;
  }
  return false;
}

// What is remembered goes to the same pairs in the new lists. Forces in the memory belong to i as seen from j: they change their sign when
// the pair is now seen from the other side.
template <class Real>
void PairLists::handMemory(SlabPairs& pairs) const {
  const std::vector<std::int32_t>& oldPlace = remembered_.oldPlace;
  Real* const columns = pairs.memory.columns<Real>();
  const std::size_t stride = pairs.memory.stride();
  Real seen[mostMemory];
  for (std::size_t pair = 0; pair < pairs.i.size(); ++pair) {
    const std::int32_t i = oldPlace[static_cast<std::size_t>(pairs.i[pair])],
                       j = oldPlace[static_cast<std::size_t>(pairs.grainOf(pairs.j[pair]))];
    if (i < 0 || j < 0) continue;
    const bool same = recall(i, j, seen);
    if (!same && !recall(j, i, seen)) continue;
    for (int c = 0; c < stateSize_; ++c) {
      const bool turns = !same && (odd_ >> c & 1U) != 0;
      columns[static_cast<std::size_t>(c) * stride + pair] = turns && seen[c] != 0 ? -seen[c] : seen[c];
    }
  }
}

void PairLists::searchSlab(const State& state, const Slabs& slabs, const CellGrid& grid, int slab, SlabPairs& pairs, Room& room) {
  room.outerI.clear();
  room.outerJ.clear();
  for (std::int32_t g = slabs.begin(slab); g < slabs.end(slab); ++g) {
    const GrainRow& row = state.rows[static_cast<std::size_t>(g)];
    const std::size_t count =
        grid.partners(Vec3(row.x, row.y, row.z), row.radius + state.skin[static_cast<std::size_t>(g)], g, room.partners);
    const auto begin = room.partners.begin(), end = begin + static_cast<std::ptrdiff_t>(count);
    std::sort(begin, end);
    room.outerI.insert(room.outerI.end(), count, g);
    room.outerJ.insert(room.outerJ.end(), begin, end);
  }
  // As long as they are, no longer: a list that grows may be there twice.
  pairs.outerI.assign(room.outerI.begin(), room.outerI.end());
  pairs.outerJ.assign(room.outerJ.begin(), room.outerJ.end());
}

// Of the two ways to see a pair across the boundary one is taken: shifts with a positive number.
void PairLists::searchAcross(const State& state, const Slabs& slabs, const CellGrid& grid, const Periods& periods, int slab,
                             std::vector<Across>& across, std::vector<Image>& images) {
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
    across.push_back({found[k].grain, static_cast<std::int32_t>(images.size()) - 1});
  }
  std::sort(across.begin(), across.end(),
            [](const Across& a, const Across& b) { return a.grain != b.grain ? a.grain < b.grain : a.image < b.image; });
}

// Merges them into the outer list from its end: rows of images come after those of grains.
void PairLists::addAcross(const std::vector<Across>& across, SlabPairs& pairs) {
  std::size_t from = pairs.outerI.size(), to = from + across.size();
  for (auto* column : {&pairs.outerI, &pairs.outerJ}) column->resize(to);
  for (auto next = across.rbegin(); next != across.rend(); ++next) {
    for (; from > 0 && pairs.outerI[from - 1] > next->grain; --from) {
      --to;
      pairs.outerI[to] = pairs.outerI[from - 1];
      pairs.outerJ[to] = pairs.outerJ[from - 1];
    }
    --to;
    pairs.outerI[to] = next->grain;
    pairs.outerJ[to] = pairs.firstImage + next->image;
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
  std::vector<std::vector<Across>> across(static_cast<std::size_t>(count));
  SlabPairs none;
  none.memory = PairMemory(single_);
  slabs_.assign(static_cast<std::size_t>(count), none);
  rooms_.resize(static_cast<std::size_t>(team.threads()), Room{{}, {}, {}, {}, {}, PairMemory(single_)});
  const bool remembers = !remembered_.slabs.empty();
  if (remembers) findOldPlaces(state.size(), newPlace);
  team.run(count, [&](int slab, int thread) {
    const auto s = static_cast<std::size_t>(slab);
    searchSlab(state, slabs, grid, slab, slabs_[s], rooms_[static_cast<std::size_t>(thread)]);
    if (periods.any()) searchAcross(state, slabs, grid, periods, slab, across[s], slabs_[s].images);
  });
  if (periods.any()) placeImages(state, slabs);
  team.run(count, [&](int slab, int thread) {
    const auto s = static_cast<std::size_t>(slab);
    addAcross(across[s], slabs_[s]);
    filterSlab(state, slabs_[s], share, rooms_[static_cast<std::size_t>(thread)]);
    if (!remembers) return;
    if (single_)
      handMemory<float>(slabs_[s]);
    else
      handMemory<double>(slabs_[s]);
  });
  remembered_.clear();
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
    return loop(rows.data(), state.skin.data(), share, pairs.outerI.data(), pairs.outerJ.data(), static_cast<std::int64_t>(outer),
                room.near.data());
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
  const std::size_t count = pairs.outerIndex.size(), stride = pairs.memory.stride();
  const std::size_t before = room.lastIndex.size(), lastStride = room.lastMemory.stride();
  Real* const now = pairs.memory.columns<Real>();
  const Real* const last = room.lastMemory.columns<Real>();
  const auto components = static_cast<std::size_t>(stateSize_);
  std::size_t was = 0;
  for (std::size_t k = 0; k < count; ++k) {
    while (was < before && room.lastIndex[was] < pairs.outerIndex[k]) ++was;
    const bool known = was < before && room.lastIndex[was] == pairs.outerIndex[k];
    for (std::size_t c = 0; c < components; ++c) now[c * stride + k] = known ? last[c * lastStride + was] : 0;
  }
}

}  // namespace tsubu::sim
