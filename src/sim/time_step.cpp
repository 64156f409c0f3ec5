#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/laws/catalogue.h"
#include "sim/model.h"
#include "sim/pair_constants.h"
#include "sim/state.h"

namespace tsubu::sim {

namespace {

// What S3 assumes before any contact is known. Twelve contacts of a grain among equals pull in different directions: the stiffest
// mode of a pressed closest packing, with friction and between walls, measures as that of 5.3 to 6 contacts in one direction
// (tests/verification/stability_test.cpp).
constexpr double mostNeighbours = 8;

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

// S2: a mode ω, ζ is stable up to Δt = 2(√(1 + s²ζ²) − sζ)/ω, where s = 1 for symplectic Euler and 2 for velocity Verlet, whose
// dashpot sees a velocity carried on by half a step (I2). Its tangential and rolling springs do so too: for them also Δt ≤ √2/ω.
// S3: in a packing ω² and 2ζω are at most `mostNeighbours` times those of one contact.
double stableStep(ContactMode contact, bool verlet, bool alongNormal) {
  const double omega = std::sqrt(mostNeighbours * contact.stiffness), damping = mostNeighbours * contact.damping;
  const double s = verlet ? 2 : 1;
  // 2(√(ω² + (s·2ζω/2)²) − s·2ζω/2)/ω² without the difference, which a strong dashpot would leave to rounding.
  const double half = 0.5 * s * damping, bound = 2 / (std::sqrt(omega * omega + half * half) + half);
  return verlet && !alongNormal ? std::min(bound, std::numbers::sqrt2 / omega) : bound;
}

}  // namespace

TimeStepChoice chooseTimeStep(const Model& model) {
  const std::size_t law = lawIndex(model.contact), n = model.materials.size();
  const std::vector<char> meet = pairsThatMeet(model);
  const std::vector<double> mass = smallestMasses(model);
  std::vector<char> isWall(n, 0);
  for (const Wall& wall : model.walls) isWall[wall.material] = 1;
  TimeStepChoice choice{std::numeric_limits<double>::infinity(), {}};
  const auto consider = [&](std::size_t a, std::size_t b, double inverseMasses, const std::string& what) {
    const std::array<ContactMode, 3> modes = contactModes(model, law, a, b, inverseMasses);
    for (std::size_t mode = 0; mode < modes.size(); ++mode) {
      const double limit = stableStep(modes[mode], model.integrator == Integrator::velocityVerlet, mode == 0);
      constexpr std::array names{"stiffness", "tangential stiffness", "rolling stiffness"};
      if (limit < choice.limit) choice = {limit, fmt::format("{} of {}", names[mode], what)};
    }
  };
  for (std::size_t a = 0; a < n; ++a) {
    if (!std::isfinite(mass[a])) continue;
    for (std::size_t b = 0; b < n; ++b) {
      if (!meet[a * n + b]) continue;
      const std::string names = fmt::format("{}–{}", model.materials[a].name, model.materials[b].name);
      if (b >= a && std::isfinite(mass[b])) consider(a, b, 1 / mass[a] + 1 / mass[b], fmt::format("{}, smallest grains", names));
      if (isWall[b]) consider(a, b, 1 / mass[a], fmt::format("{} walls, smallest grains", names));
    }
  }
  if (!std::isfinite(choice.limit))
    throw Error(ErrorKind::scene, "There is nothing to derive a time step from: no grain meets a grain or a wall.", "give time_step");
  return choice;
}

}  // namespace tsubu::sim
