#pragma once
// All bonds of a simulation: made when their time comes, kept along the slabs of their grains, advanced and let go when they break.

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "sim/bonds/bond_columns.h"
#include "sim/bonds/wall_bonds.h"
#include "sim/kernel/kernels.h"
#include "sim/pass.h"

namespace tsubu::sim {

class BondPass : public ForcePass {
 public:
  explicit BondPass(const Model& model);

  std::string name() const override { return "bonds"; }
  void regroup(const World& world, const std::vector<std::int32_t>& newPlace) override;
  void addForces(const World& world) override;
  void account(const World& world, Ledger& ledger) const override;
  double storedIn(const World& world, const std::vector<char>& grains) const override;
  void addLinks(const World& world, std::vector<Link>& links) const override;
  void count(Counts& counts) const override;
  void show(const World& world, Snapshot& snapshot) const override;
  std::uint64_t hash(const State& state) const override;

 private:
  /// The bonds of one kind whose grain of the lower place lies in one slab.
  struct SlabBonds {
    BondColumns near;  ///< whose other grain lies in this slab or the next
    WallBonds wall;
    BondFindings found, foundAtWall;
  };

  struct Kind {
    const Bonding* bonding;
    BondKind constants;
    BondKernel kernel;
    std::vector<SlabBonds> slabs;
    BondColumns far;  ///< those that reach beyond the next slab or across the boundary: one thread does them
    BondFindings foundFar;
    bool made = false;  ///< for a kind that is made once
  };

  /// A pair whose bond broke while the grains were nearer than their radii: it touches at the distance at which it broke, which grows as
  /// they part. Otherwise a contact would spring from nothing, with energy that nobody spent.
  struct Scar {
    std::int32_t i, j;
    double touch;  ///< m
  };

  /// A bond that has broken, as long as it is shown.
  struct Break {
    Vec3 first, second;
    double radius, time;
  };

  static void collect(const Kind& kind, BondColumns& all, WallBonds& walls);
  void makeDue(const World& world);
  void make(const World& world, std::size_t kind);
  void evaluate(const World& world);
  void evaluateAcross(const World& world, Kind& kind, const BondRows& grains);
  void letGo(const World& world);
  void letGo(const World& world, const Kind& kind, const BondColumns& bonds, const std::vector<GrainRow>& second, BondFindings& found);
  void carryScars(const World& world);
  void settle(const World& world, Kind& kind, BondColumns& all, WallBonds& walls);
  double touchOf(const Kind& kind, double rest, double radiusSum) const;
  template <class Visit>
  void visit(const State& state, Visit&& visit) const;

  std::vector<Kind> kinds_;
  std::vector<BondStage> stages_;
  std::vector<Scar> scars_;
  std::vector<Break> breaks_;
  std::unordered_set<std::uint64_t> known_;  ///< pairs that have been bonded: a pair is bonded once
  std::unordered_set<std::uint64_t> knownAtWalls_;
  std::uint64_t step_ = 0, nextSearch_ = 0;
  double until_ = 0;             ///< s: no bonds are made after it
  std::optional<double> shown_;  ///< s: for how long breaks are
  std::uint64_t holding_ = 0, broken_ = 0;
  Tally loss_;  ///< J: dampers, per step
  double relaxed_ = 0, released_ = 0;
  double silenced_ = 0;  ///< J: what contacts held when their grains were bonded
};

}  // namespace tsubu::sim
