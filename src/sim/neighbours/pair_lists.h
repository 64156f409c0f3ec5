#pragma once
// Who may touch whom. Two lists: the outer one (all pairs nearer than the outer skin) is searched for rarely; the inner one (nearer
// than the inner skin) is what every step walks, refiltered from the outer one whenever grains may have moved half the inner skin.
// The memory of contacts lies along the inner list.

#include <cstdint>
#include <vector>

#include "core/thread_team.h"
#include "sim/neighbours/cell_grid.h"
#include "sim/neighbours/slabs.h"
#include "sim/laws/memory.h"
#include "sim/state.h"

namespace tsubu::sim {

/// The pairs whose first grain lies in one slab, ordered by first and second grain (i < j).
struct SlabPairs {
  std::vector<std::int32_t> outerI, outerJ;
  std::vector<std::int32_t> i, j, outerIndex;  ///< inner list, and where each pair is in the outer one
  std::vector<double> memory;                  ///< component c of inner pair k at memory[c * stride + k]
  std::size_t stride = 0;
};

class PairLists {
 public:
  /// `stateSize` doubles of memory per contact; `odd`: those that change sign when the order of a pair turns round, as bits.
  PairLists(int stateSize, unsigned odd) : stateSize_(stateSize), odd_(odd) {}

  /// Notes which contacts carry memory before the grains are put into a new order.
  void rememberContacts();
  /// Searches the outer lists anew (grains in slab order, grid built) and hands the remembered memory to the same pairs.
  /// `newPlace`: old place → new place, −1 for grains that are gone.
  void build(const State& state, const Slabs& slabs, const CellGrid& grid, double innerSkin,
             const std::vector<std::int32_t>& newPlace, ThreadTeam& team);
  /// Makes the inner lists from the outer ones; memory follows.
  void refilter(const State& state, double innerSkin, ThreadTeam& team);

  std::vector<SlabPairs>& slabs() { return slabs_; }
  const std::vector<SlabPairs>& slabs() const { return slabs_; }
  std::size_t listed() const;

 private:
  struct Remembered {
    std::int32_t i, j;
    double memory[mostMemory];
  };
  void searchSlab(const State& state, const Slabs& slabs, const CellGrid& grid, int slab, std::vector<std::int32_t>& own,
                  std::vector<std::int32_t>& before) const;
  void placeRemembered(const State& state, const std::vector<std::int32_t>& newPlace);
  void filterSlab(const State& state, SlabPairs& pairs, double innerSkin) const;

  int stateSize_;
  unsigned odd_;
  std::vector<SlabPairs> slabs_;
  std::vector<Remembered> remembered_;
};

}  // namespace tsubu::sim
