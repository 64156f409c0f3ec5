#pragma once
// Heat conduction between touching grains, and between grains and walls of fixed temperature (docs/physics.md, H1–H3).
//
//   H1   q = h (T_j − T_i),  h = 2 k* a,  k* = 2 k_i k_j/(k_i + k_j)        through a contact, W
//   H2   a = √(R* δ)                                                       radius of the contact, Hertz
//   H3   m c dT/dt = Σ q,  stable and monotonic for Δt Σh/(m c) ≤ 1         explicit Euler
//
// A grain has one temperature: right while its inside conducts better than its contacts, k*·a ≪ k·r, as it always does here. What one
// grain gains the other loses, bit by bit, so that heat is kept to rounding. Heat does not act back on the motion, and what friction
// dissipates does not warm. Source: Batchelor & O'Brien, Proc. R. Soc. A 355 (1977) 313; the same form in LIGGGHTS, with the square root
// of the area of two spheres cut through each other for the width of a contact.

#include <vector>

#include "sim/pass.h"

namespace tsubu::sim {

class HeatPass : public ForcePass {
 public:
  explicit HeatPass(const Model& model);
  std::string name() const override { return "heat conduction"; }
  /// Sets `State::warming`. Throws Error(simulation) when the step is too long for a grain (H3).
  void addForces(const World& world) override;
  void account(const World& world, Ledger& ledger) const override;
  std::uint64_t hash(const State& state) const override;

 private:
  void conduct(const World& world, int slab);
  void conductWalls(const World& world, int slab);
  void check(const World& world, std::size_t grain) const;

  std::vector<double> conductivity_, capacity_;  // by material: W/(m K), J/(kg K)
  std::vector<double> flow_, conductance_;       // by grain: W into it, and Σh, W/K
  struct Across {                                // what the owner of an image gets, added when all slabs are done
    std::int32_t owner;
    double flow, conductance;
  };
  std::vector<std::vector<Across>> across_;       // by slab
  std::vector<double> fromWalls_;                 // by slab, W
  double heatFromWalls_ = 0, lastFromWalls_ = 0;  // J
};

/// J/K
double heatCapacityOf(const Model& model, const State& state, std::size_t grain);

/// 1/s: Σh/(m c) of a grain of this size among twelve like it, pressed in by a tenth of the radius: what H3 expects of a packing.
double warmingRate(double conductivity, double capacity, double mass, double radius);

}  // namespace tsubu::sim
