#pragma once
// Who may touch whom. Two lists: the outer one (all pairs nearer than the sum of their skins) is searched for rarely; the inner one (nearer
// than a share of it) is what every step walks, refiltered from the outer one whenever one of its grains may have gone farther than that
// share of its skin (drift.h). The memory of contacts lies along the inner list.
//
// Across a periodic boundary (docs/physics.md, W5) a grain meets the image of its partner: a row beyond those of the grains, copied from
// its owner with a shift before every pass. The slab of the grain has its own images, so that no two slabs write to the same row;
// after the pass, what acted on images is added to their owners in a fixed order.

#include <cstdint>
#include <limits>
#include <vector>

#include "core/thread_team.h"
#include "sim/laws/memory.h"
#include "sim/neighbours/cell_grid.h"
#include "sim/neighbours/pair_memory.h"
#include "sim/neighbours/slabs.h"
#include "sim/periodic.h"
#include "sim/state.h"

namespace tsubu::sim {

/// A grain as it is seen across the boundary: at x + shift.
struct Image {
  std::int32_t owner;
  Vec3 shift;
};

/// The pairs whose first grain lies in one slab, ordered by first and second row (i < j). The second may be an image.
struct SlabPairs {
  std::vector<std::int32_t> outerI, outerJ;
  std::vector<std::int32_t> i, j;         ///< inner list
  std::vector<std::int32_t> outerIndex;   ///< where each of its pairs is in the outer list; empty when nothing is remembered
  PairMemory memory;                      ///< of the inner pairs
  std::vector<double> outerTouch, touch;  ///< m: see PairRangeIn::touch, along each list; empty: none
  bool stale = false;                     ///< pairs have begun or ceased to touch: the inner list must be made anew

  /// m: the distance of the centres at which pair k begins to touch, given the sum of its radii.
  double touchOf(std::size_t k, double radiusSum) const { return touch.empty() || touch[k] == 0 ? radiusSum : touch[k]; }
  std::vector<Image> images;
  std::int32_t firstImage = std::numeric_limits<std::int32_t>::max();  ///< row of the first

  /// The grain that a row belongs to.
  std::int32_t grainOf(std::int32_t row) const { return row < firstImage ? row : images[static_cast<std::size_t>(row - firstImage)].owner; }
};

class PairLists {
 public:
  /// `stateSize` numbers of memory per contact; `odd`: those that change sign when the order of a pair turns round, as bits; `single`: in
  /// single precision.
  PairLists(int stateSize, unsigned odd, bool single = false) : stateSize_(stateSize), odd_(odd), single_(single) {}

  /// Keeps the memory of contacts before the grains are put into a new order, and lets the lists go. `slabs`: those of the lists.
  void rememberContacts(const Slabs& slabs, ThreadTeam& team);
  /// Searches the outer lists anew (grains in slab order with their skins, grid built with these) and hands the memory to the same pairs.
  /// `share`: of the skins, for the inner lists. `newPlace`: old place → new place, −1 for grains that are gone.
  /// With `periods`, grains lie in the domain; images are made and the state gets rows for them.
  void build(State& state, const Slabs& slabs, const CellGrid& grid, double share, const std::vector<std::int32_t>& newPlace,
             ThreadTeam& team, const Periods& periods = {});
  /// Makes those inner lists anew from the outer ones; memory follows.
  void refilter(State& state, double share, const std::vector<int>& lists, ThreadTeam& team);
  /// For each list, the slabs whose grains are in it.
  std::vector<std::vector<int>> slabsInLists(const Slabs& slabs) const;

  /// Copies the present rows of the owners to the images of a slab.
  static void refreshImages(State& state, const SlabPairs& slab);
  /// Adds what acted on the images of a slab's grains to them, and clears it. `slab` counts the owners' slabs.
  void foldImages(State& state, int slab) const;
  bool hasImages() const { return !folds_.empty(); }

  /// Lets a listed pair (any order) touch at another distance of the centres (m) than the sum of its radii; 0: at that again; negative:
  /// never, then the inner list does without it.
  void setTouch(const Slabs& slabs, std::int32_t a, std::int32_t b, double distance);

  /// Copies the memory of a pair (any order) in the inner list; false when it is not there.
  bool copyMemory(const Slabs& slabs, std::int32_t a, std::int32_t b, double* memory) const;

  std::vector<SlabPairs>& slabs() { return slabs_; }
  const std::vector<SlabPairs>& slabs() const { return slabs_; }

 private:
  /// The last inner lists, while grains have a new order: of each slab, the second grains (owners, not images) and the memory.
  struct Remembered {
    struct Contacts {
      std::vector<std::int32_t> partner;
      std::vector<std::int32_t> first;  ///< where the pairs of each of its grains begin, and the end
      PairMemory memory;
    };
    std::vector<Contacts> slabs;
    std::vector<std::int32_t> begin;     ///< first grain of each slab
    std::vector<std::uint16_t> slab;     ///< of each grain
    std::vector<std::int32_t> oldPlace;  ///< by new place; −1: was not there

    void clear() { *this = Remembered{}; }
  };
  /// What a thread needs while it makes the lists of a slab: the pairs that it finds, and the last inner list.
  struct Room {
    std::vector<std::int32_t> partners, outerI, outerJ;
    std::vector<std::int32_t> near, lastIndex;
    PairMemory lastMemory;
  };
  /// A pair of a grain and an image, by its number in the slab.
  struct Across {
    std::int32_t grain, image;
  };
  static void searchSlab(const State& state, const Slabs& slabs, const CellGrid& grid, int slab, SlabPairs& pairs, Room& room);
  static void searchAcross(const State& state, const Slabs& slabs, const CellGrid& grid, const Periods& periods, int slab,
                           std::vector<Across>& across, std::vector<Image>& images);
  static void addAcross(const std::vector<Across>& across, SlabPairs& pairs);
  void placeImages(State& state, const Slabs& slabs);
  void findOldPlaces(std::size_t grains, const std::vector<std::int32_t>& newPlace);
  template <class Real>
  bool recall(std::int32_t seenFrom, std::int32_t partner, Real* memory) const;
  template <class Real>
  void handMemory(SlabPairs& pairs) const;
  void filterSlab(State& state, SlabPairs& pairs, double share, Room& room) const;
  template <class Real>
  void keepMemory(SlabPairs& pairs, const Room& room) const;

  int stateSize_;
  unsigned odd_;
  bool single_;
  std::vector<SlabPairs> slabs_;
  Remembered remembered_;
  std::vector<Room> rooms_;  // one per thread
  struct Fold {
    std::int32_t owner, image;
  };
  std::vector<Fold> folds_;             // by owner, then image
  std::vector<std::size_t> firstFold_;  // of each slab
};

}  // namespace tsubu::sim
