#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/laws/catalogue.h"
#include "sim/model.h"
#include "sim/pair_constants.h"
#include "sim/state.h"

namespace tsubu::sim {

namespace {

// Contacts of a grain among equals in the densest packing: what S3 assumes before any contact is known.
constexpr double mostNeighbours = 12;

std::vector<double> smallestMasses(const Model& model) {
  std::vector<double> mass(model.materials.size(), std::numeric_limits<double>::infinity());
  const auto meet = [&](std::uint16_t material, double radius) {
    const double m = massOf(model.materials[material].values[Property::density], radius);
    mass[material] = std::min(mass[material], m);
  };
  for (const Grain& grain : model.grains) meet(grain.material, grain.radius);
  for (const Stream& stream : model.streams) meet(stream.material, stream.radii.smallest());
  return mass;
}

}  // namespace

// S2: a damped mode ω, ζ is stable up to Δt = 2(√(1 + s²ζ²) − sζ)/ω, where s = 1 for symplectic Euler and 2 for velocity Verlet, whose
// dashpot sees an extrapolated velocity (I2). S3: ω² ≤ 12 k (1/m_a + 1/m_b) with k the larger of k_n and 7/2 k_t.
TimeStepChoice chooseTimeStep(const Model& model) {
  const std::size_t law = lawIndex(model.contact), n = model.materials.size();
  const std::vector<char> meet = pairsThatMeet(model);
  const std::vector<double> mass = smallestMasses(model);
  std::vector<char> isWall(n, 0);
  for (const Wall& wall : model.walls) isWall[wall.material] = 1;
  TimeStepChoice choice{std::numeric_limits<double>::infinity(), {}};
  const auto consider = [&](std::size_t a, std::size_t b, double inverseMasses, const std::string& what) {
    const PairStiffness pair = pairStiffness(model, law, a, b, 1 / inverseMasses);
    const double omega = std::sqrt(mostNeighbours * pair.stiffness * inverseMasses);
    const double zeta = pair.damping * omega / (2 * pair.normalStiffness);
    const double s = model.integrator == Integrator::velocityVerlet ? 2 : 1;
    const double limit = 2 * (std::sqrt(1 + s * s * zeta * zeta) - s * zeta) / omega;
    if (limit < choice.limit) choice = {limit, what};
  };
  for (std::size_t a = 0; a < n; ++a) {
    if (!std::isfinite(mass[a])) continue;
    for (std::size_t b = 0; b < n; ++b) {
      if (!meet[a * n + b]) continue;
      const std::string names = fmt::format("{}–{}", model.materials[a].name, model.materials[b].name);
      if (b >= a && std::isfinite(mass[b])) consider(a, b, 1 / mass[a] + 1 / mass[b], fmt::format("stiffness of {}, smallest grains", names));
      if (isWall[b]) consider(a, b, 1 / mass[a], fmt::format("stiffness of {} walls, smallest grains", names));
    }
  }
  if (!std::isfinite(choice.limit))
    throw Error(ErrorKind::scene, "There is nothing to derive a time step from: no grain meets a grain or a wall.", "give time_step");
  return choice;
}

}  // namespace tsubu::sim
