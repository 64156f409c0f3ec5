#pragma once
// What every normal law returns.

#include "sim/laws/contact.h"

namespace tsubu::sim {

/// What the normal law hands to the laws after it.
struct NormalForce {
  double force;      ///< F_n, N; positive pushes apart
  double elastic;    ///< the part that is stored, N
  double energy;     ///< stored, J
  double stiffness;  ///< dF/dδ at this overlap, N/m
  double damping;    ///< η_n, kg/s
};

}  // namespace tsubu::sim
