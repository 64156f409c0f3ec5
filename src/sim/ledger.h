#pragma once
// Where the energy is and where it went (docs/physics.md, E1–E6), with both momenta.

#include <algorithm>
#include <cmath>

#include "core/vec.h"

namespace tsubu::sim {

/// An energy that grows by a share per step. In velocity Verlet the share of the present step runs half a step beyond the present
/// instant, as the memory of contacts does.
struct Tally {
  double total = 0, last = 0;  ///< J: so far, and in the last step

  void add(double share) {
    last = share;
    total += share;
  }
  double now(double lead) const { return total - (1 - lead) * last; }
};

/// Heat, apart from the mechanical account: it does not act back on the motion.
struct HeatLedger {
  double stored = 0;                 ///< Σ m c T, J
  double fromWalls = 0;              ///< so far, J
  double inserted = 0, removed = 0;  ///< with grains, so far, J
};

/// All energies in joules. "Dissipated" and "work" count from the start of the run.
struct Ledger {
  double time = 0;

  double kineticBulk = 0;         ///< ½ M V_G²
  double kineticFluctuation = 0;  ///< Σ ½ m |v − V_G|²
  double kineticRotation = 0;     ///< Σ ½ I ω²
  double kineticWalls = 0;        ///< Σ ½ M s′² of walls that move under load
  double gravitational = 0;       ///< −Σ m g·x, such walls included
  double elasticNormal = 0;
  double elasticTangential = 0;
  double elasticRolling = 0;
  double elasticBonds = 0;
  double potentialFields = 0;  ///< of grains in each other's field (magnets)

  double dissipatedNormal = 0;      ///< by normal dashpots
  double dissipatedTangential = 0;  ///< by tangential dashpots
  double dissipatedFriction = 0;    ///< by sliding, and springs that were let go at the end of a contact
  double dissipatedRolling = 0;     ///< by rolling resistance
  double dissipatedBonds = 0;       ///< by the damping of bonds, with what contacts held that a bond replaced
  double dissipatedBreakage = 0;    ///< what bonds held when they broke
  double dissipatedDrag = 0;        ///< by drag and global damping

  double workWalls = 0;   ///< done by walls that move as they are told on the grains, and by the forces on those that move under load
  double workFields = 0;  ///< done by gravity that changes, flows and magnetic fields
  double inserted = 0;    ///< energy brought by grains that came in
  double removed = 0;     ///< energy taken by grains that were taken out or lost

  HeatLedger heat;

  Vec3 momentum = Vec3::Zero();             ///< kg m/s
  Vec3 angularMomentumBulk = Vec3::Zero();  ///< X_G × P about the origin, kg m²/s
  Vec3 angularMomentumRest = Vec3::Zero();  ///< about the centre of mass, spin included

  double initial = 0;  ///< total mechanical energy at the start

  double kinetic() const { return kineticBulk + kineticFluctuation + kineticRotation + kineticWalls; }
  double elastic() const { return elasticNormal + elasticTangential + elasticRolling + elasticBonds; }
  double mechanical() const { return kinetic() + gravitational + elastic() + potentialFields; }
  double dissipated() const {
    return dissipatedNormal + dissipatedTangential + dissipatedFriction + dissipatedRolling + dissipatedBonds + dissipatedBreakage +
           dissipatedDrag;
  }
  double work() const { return workWalls + workFields; }
  /// What no account explains.
  double residual() const { return mechanical() + dissipated() - initial - work() - inserted + removed; }
  /// Energy that changed hands so far: the measure of the residual.
  double turnover = 0;
  double residualFraction() const { return turnover > 0 ? std::abs(residual()) / turnover : 0; }
};

}  // namespace tsubu::sim
