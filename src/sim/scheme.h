#pragma once
// The integrators by name, and what the rest of the step must know of them (docs/physics.md, I1–I7).

#include <string_view>

namespace tsubu::sim {

enum class Integrator { symplecticEuler, velocityVerlet, explicitEuler, leapfrog, centralDifferences, rungeKutta };

struct Scheme {
  std::string_view name;
  double lead;       ///< StepOf::lead: steps by which forces are taken beyond the old memory of contacts
  double behind;     ///< steps by which velocities lag behind positions: ½ where they live at half steps
  double ahead;      ///< steps by which contacts see velocities carried on with the last acceleration
  double dragLimit;  ///< largest stable c Δt/m of a drag by itself (S2)
};

constexpr Scheme schemeOf(Integrator integrator) {
  switch (integrator) {
    case Integrator::velocityVerlet:
      return {"velocity Verlet", 0.5, 0.5, 0.5, 1};
    case Integrator::explicitEuler:
      return {"explicit Euler", 0, 0, 0, 2};
    case Integrator::leapfrog:
      return {"leapfrog", 1, 0.5, 0, 2};
    case Integrator::centralDifferences:
      return {"central differences", 1, 0.5, 0, 2};
    case Integrator::rungeKutta:
      return {"Runge-Kutta", 0, 0, 0, 2.785293563405282};
    case Integrator::symplecticEuler:
      break;
  }
  return {"symplectic Euler", 1, 0, 0, 2};
}

}  // namespace tsubu::sim
