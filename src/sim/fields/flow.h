#pragma once
// The velocity fields of a fluid (docs/physics.md, F2). No function of a library: the same bits everywhere.
//
//   uniform   u = U                              ∇×u = 0
//   shear     u = γ ((x − p)·n) d                ∇×u = γ n × d
//   vortex    u = Ω × (x − p)                    ∇×u = 2Ω
//   pipe      u = U (1 − ρ²/R²) a for ρ < R      ∇×u = −(2U/R²) ρ × a

#include "sim/fields/fields.h"
#include "sim/laws/arithmetic.h"

namespace tsubu::sim {

/// What a grain feels of a fluid at a point.
struct FlowAt {
  V3 velocity;  ///< m/s
  V3 turning;   ///< ½ ∇×u, rad/s
};

/// One flow made ready: any of the four is u = U + A (x − p) − K |x⊥|² a, so that the loop over grains has no branches but the pipe's wall.
class FlowField {
 public:
  explicit FlowField(const Flow& flow);
  FlowAt at(V3 x) const;

 private:
  V3 point_{}, uniform_{}, turning_{};     // p, U, and half the curl where it is constant
  V3 gradient_{}, direction_{};            // A = direction ⊗ gradient (shear)
  V3 spin_{};                              // A = Ω × (vortex)
  V3 axis_{};                              // a
  double inverseRadius2_ = 0, speed_ = 0;  // of a pipe; 0: none
};

}  // namespace tsubu::sim
