#pragma once
// Drag towards a flow, buoyancy, and global damping (docs/physics.md, F2–F4).
//
//   F2   F = −(c + ½ρ_f C_d πr² |w|) w,  w = v − u(x),  c = 6πμr + c₀       T = −8πμr³ (ω − ½∇×u)
//   F3   F = −ρ_f V g
//   F4   F = −C v,  T = −D ω                                              Article's C_i and D_i
//
// Of the power F·v the part −F·w is dissipated, the rest F·u is work of the flow; of T·ω alike. Buoyancy is work of the flow.
// Sources: Stokes 1851 (creeping flow about a single sphere, Re ≪ 1); Newton's quadratic law, C_d ≈ 0.44 for 1e3 < Re < 2e5; Article.
// Grains do not shield each other and the fluid does not feel them: dilute suspensions.

#include <memory>
#include <vector>

#include "sim/fields/flow.h"
#include "sim/fields/slab_sums.h"
#include "sim/pass.h"

namespace tsubu::sim {

/// How fast drag and damping slow a lone grain down: 1/s of its velocity and of its spin (linearised about the speed `slip` against the
/// fluid, m/s).
struct DampingRates {
  double linear = 0, rotary = 0;
  bool fluid = false;  ///< the fluid has the larger share in it
};
DampingRates dampingRates(const Fields& fields, double mass, double radius, double slip, bool turns);

class DragPass : public ForcePass {
 public:
  /// `limit`: of c Δt/m, for a grain by itself.
  DragPass(const Drag& drag, bool turns, double limit);
  std::string name() const override;
  /// Throws Error(simulation) when the quadratic drag has become too strong for the time step.
  void addForces(const World& world) override;
  bool evaluatesAnew() const override { return true; }
  void account(const World& world, Ledger& ledger) const override;

 private:
  Drag drag_;
  FlowField flow_;
  bool turns_;
  double limit_;  ///< largest share of the speed that a step may take (S2 without a spring)
  std::vector<FieldShare> shares_;
  Tally dissipated_, work_;
};

class DampingPass : public ForcePass {
 public:
  DampingPass(const GlobalDamping& damping, bool turns) : damping_(damping), turns_(turns) {}
  std::string name() const override { return "global damping"; }
  void addForces(const World& world) override;
  bool evaluatesAnew() const override { return true; }
  void account(const World& world, Ledger& ledger) const override;

 private:
  GlobalDamping damping_;
  bool turns_;
  std::vector<FieldShare> shares_;
  Tally dissipated_;
};

}  // namespace tsubu::sim
