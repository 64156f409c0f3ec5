#include "sim/time_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/bonds/bond_limit.h"
#include "sim/fields/drag.h"
#include "sim/fields/magnet_pass.h"
#include "sim/heat.h"
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
// S9: of a grain that the network does not know yet.
constexpr double firstNeighbours = 2;

// By material; infinite where there are no grains of it.
std::vector<double> smallestRadii(const Model& model) {
  std::vector<double> radius(model.materials.size(), std::numeric_limits<double>::infinity());
  const auto meet = [&](std::uint16_t material, double r) { radius[material] = std::min(radius[material], r); };
  for (const Grain& grain : model.grains) meet(grain.material, grain.radius);
  for (const Stream& stream : model.streams) meet(stream.material, stream.radii.smallest());
  return radius;
}

// S4: a stiffness that depends on the overlap is taken at `expectedOverlap`.
// S3: in a packing ω² and 2ζω are at most `neighbours` times those of one contact. `rate`: what drag and damping add to 2ζω of a
// grain by itself.
ContactMode inPacking(ContactMode contact, double neighbours, double rate) {
  return {neighbours * contact.stiffness, neighbours * contact.damping + rate};
}

// Explicit Euler: λ² − (2 − 2ζW) λ + (1 − 2ζW + W²); the product of the roots reaches 1 at W = 2ζ, the larger of two real ones −1 before.
double stableEulerStep(ContactMode mode) {
  const double omega = std::sqrt(mode.stiffness), half = 0.5 * mode.damping;
  if (half < omega) return mode.damping / mode.stiffness;
  return 2 / (half + std::sqrt(half * half - mode.stiffness));
}
// Where that is shorter than this share of 1/ω, this is taken: the energy of an undamped contact then grows by exp(πW) − 1 = 3 %.
constexpr double leastEulerStep = 0.01;

// Runge–Kutta: |1 + z + z²/2 + z³/6 + z⁴/24| ≤ 1 with z = Δt (−ζω ± iω √(1−ζ²)).
double stableRungeKuttaStep(ContactMode mode) {
  const double omega = std::sqrt(mode.stiffness), half = 0.5 * mode.damping;
  if (half >= omega) return schemeOf(Integrator::rungeKutta).dragLimit / (half + std::sqrt(half * half - mode.stiffness));
  const std::complex<double> direction(-half, std::sqrt(mode.stiffness - half * half));
  const auto stable = [&](double dt) {
    const std::complex<double> z = dt * direction;
    return std::norm(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)))) <= 1 + 1e-12;
  };
  double low = 2 / omega, high = 4 / omega;  // stable and unstable for any ζ
  for (int n = 0; n < 50; ++n) (stable(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  return low;
}

// By material: the fastest that drag and damping slow down any of its grains at the speed it starts with.
std::vector<DampingRates> fastestDamping(const Model& model) {
  std::vector<DampingRates> rates(model.materials.size());
  if (!model.fields.drag && !model.fields.damping) return rates;
  const FlowField flow(model.fields.drag ? model.fields.drag->flow : Flow{});
  const bool turns = grainsTurn(model);
  const auto meet = [&](std::uint16_t material, double radius, const Vec3& x, const Vec3& v) {
    const V3 u = flow.at({x.x(), x.y(), x.z()}).velocity;
    const double slip = (v - Vec3(u.x, u.y, u.z)).norm();
    const DampingRates rate =
        dampingRates(model.fields, massOf(model.materials[material].values[Property::density], radius), radius, slip, turns);
    DampingRates& most = rates[material];
    if (std::max(rate.linear, rate.rotary) > std::max(most.linear, most.rotary)) most.fluid = rate.fluid;
    most.linear = std::max(most.linear, rate.linear);
    most.rotary = std::max(most.rotary, rate.rotary);
  };
  for (const Grain& grain : model.grains) meet(grain.material, grain.radius, grain.position, grain.velocity);
  for (const Stream& stream : model.streams)
    meet(stream.material, stream.radii.smallest(), stream.region.bounds().center(), stream.velocity);
  return rates;
}

// H3, as far as it can be known before any contact is.
void considerHeat(const Model& model, TimeStepChoice& choice) {
  if (!model.heat) return;
  const auto meet = [&](std::uint16_t material, double radius) {
    const PropertyValues& values = model.materials[material].values;
    const double mass = massOf(values[Property::density], radius);
    const double rate = warmingRate(values[Property::conductivity], values[Property::heatCapacity], mass, radius);
    if (rate * choice.limit > 1)
      choice = {1 / rate, fmt::format("heat conduction of {}, smallest grains", model.materials[material].name), {}};
  };
  for (const Grain& grain : model.grains) meet(grain.material, grain.radius);
  for (const Stream& stream : model.streams) meet(stream.material, stream.radii.smallest());
}

// Needles swing; S2 without a dashpot.
void considerMagnets(const Model& model, TimeStepChoice& choice) {
  const double square = fastestMagnet(model);
  if (square > 0 && 2 / std::sqrt(square) < choice.limit) choice = {2 / std::sqrt(square), "magnets that swing", {}};
}

// S5. Contacts that act beside the bonds of the same pairs add their share; otherwise a neighbour is either bonded or touched.
void considerBonds(const Model& model, bool laterOnly, TimeStepChoice& choice) {
  const BondSwing swing = swingOfBonds(model, laterOnly);
  if (!(swing.stiffness > 0)) return;
  double limit = stableStep({swing.stiffness, swing.damping}, model.integrator, true);
  bool both = false;
  for (const Bonding& bonding : model.bonds) both = both || bonding.contactBeyondRest;
  if (both) limit = 1 / std::sqrt(1 / (limit * limit) + 1 / (choice.limit * choice.limit));
  if (limit < choice.limit) choice = {limit, fmt::format("stiffness of the bonds '{}'", swing.of), {}};
}

}  // namespace

// S2: a mode ω, ζ is stable up to Δt = 2(√(1 + s²ζ²) − sζ)/ω, where s = 1 for symplectic Euler, leapfrog and central differences, and 2
// for velocity Verlet, whose dashpot sees a velocity carried on by half a step (I2). Its tangential and rolling springs do so too: for
// them also Δt ≤ √2/ω.
double stableStep(ContactMode mode, Integrator integrator, bool alongNormal) {
  if (integrator == Integrator::explicitEuler)
    return mode.stiffness > 0 ? std::max(stableEulerStep(mode), leastEulerStep / std::sqrt(mode.stiffness)) : 2 / mode.damping;
  if (integrator == Integrator::rungeKutta) return stableRungeKuttaStep(mode);
  const bool verlet = integrator == Integrator::velocityVerlet;
  const double omega = std::sqrt(mode.stiffness), s = verlet ? 2 : 1;
  // 2(√(ω² + (s·2ζω/2)²) − s·2ζω/2)/ω² without the difference, which a strong dashpot would leave to rounding.
  const double half = 0.5 * s * mode.damping, bound = 2 / (std::sqrt(omega * omega + half * half) + half);
  return verlet && !alongNormal ? std::min(bound, std::numbers::sqrt2 / omega) : bound;
}

ContactMode stiffestContact(const Model& model, std::size_t law, std::size_t wall) {
  ContactMode stiffest;
  const std::vector<double> radius = smallestRadii(model);
  const PairConstants constants = preparePairs(model, law);
  for (std::size_t a = 0; a < radius.size(); ++a) {
    if (!std::isfinite(radius[a])) continue;
    const double mass = massOf(model.materials[a].values[Property::density], radius[a]);
    const double* const pair = constants.of(a * radius.size() + model.walls[wall].material);
    const ContactMode mode = lawFunctions(law).modes(pair, expectedOverlap * radius[a], radius[a], 1 / mass)[0];
    stiffest.stiffness = std::max(stiffest.stiffness, mode.stiffness * mass);
    stiffest.damping = std::max(stiffest.damping, mode.damping * mass);
  }
  return stiffest;
}

double stableStep(const MovingWall& wall, ContactMode contact, Integrator integrator) {
  const double n = wall.contacts(), inverseMass = 1 / wall.body().mass;
  return stableStep({n * contact.stiffness * inverseMass, (n * contact.damping + wall.body().damping) * inverseMass}, integrator, true);
}

namespace {

TimeStepChoice choose(const Model& model, double neighbours) {
  const std::size_t law = lawIndex(model.contact), n = model.materials.size();
  const std::vector<char> meet = pairsThatMeet(model);
  const PairConstants constants = preparePairs(model, law);
  const std::vector<double> radius = smallestRadii(model);
  const std::vector<DampingRates> damping = fastestDamping(model);
  std::vector<char> isWall(n, 0);
  std::vector<double> inverseWallMass(n, 0);
  for (const Wall& wall : model.walls) {
    isWall[wall.material] = 1;
    if (wall.body) inverseWallMass[wall.material] = std::max(inverseWallMass[wall.material], 1 / wall.body->mass);
  }
  TimeStepChoice choice{std::numeric_limits<double>::infinity(), {}, {}};
  bool grows = false;
  const auto inverseMass = [&](std::size_t a) { return 1 / massOf(model.materials[a].values[Property::density], radius[a]); };
  const auto rateOf = [&](std::size_t a, std::size_t b, bool turning) {
    const double linear = std::max(damping[a].linear, damping[b].linear), rotary = std::max(damping[a].rotary, damping[b].rotary);
    return turning ? std::max(linear, rotary) : linear;
  };
  const auto consider = [&](std::size_t a, std::size_t b, double inverseMasses, double effectiveRadius, double smallerRadius,
                            const std::string& what) {
    auto modes = lawFunctions(law).modes(constants.of(a * n + b), expectedOverlap * smallerRadius, effectiveRadius, inverseMasses);
    if (!model.contact.rotation)
      modes[1] = {modes[1].stiffness / 3.5, modes[1].damping / 3.5};  // a sphere that turns slips with 2/7 of its mass
    for (std::size_t mode = 0; mode < modes.size(); ++mode) {
      const ContactMode packed = inPacking(modes[mode], neighbours, rateOf(a, b, mode > 0));
      if (packed.stiffness == 0 && packed.damping == 0) continue;
      const double limit = stableStep(packed, model.integrator, mode == 0);
      grows = grows || (model.integrator == Integrator::explicitEuler && stableEulerStep(packed) < limit);
      constexpr std::array names{"stiffness", "tangential stiffness", "rolling stiffness", "twisting stiffness"};
      if (limit < choice.limit) choice = {limit, fmt::format("{} of {}", names[mode], what), {}};
    }
  };
  for (std::size_t a = 0; a < n; ++a) {
    if (!std::isfinite(radius[a])) continue;
    for (std::size_t b = 0; b < n; ++b) {
      if (!meet[a * n + b]) continue;
      const std::string names = fmt::format("{}–{}", model.materials[a].name, model.materials[b].name);
      if (b >= a && std::isfinite(radius[b])) {
        consider(a, b, inverseMass(a) + inverseMass(b), 1 / (1 / radius[a] + 1 / radius[b]), std::min(radius[a], radius[b]),
                 fmt::format("{}, smallest grains", names));
      }
      if (isWall[b])
        consider(a, b, inverseMass(a) + inverseWallMass[b], radius[a], radius[a], fmt::format("{} walls, smallest grains", names));
    }
    const double rate = std::max(damping[a].linear, damping[a].rotary);
    // Where drag alone allows hardly more than together with the stiffest contact, it is the drag that sets the step.
    if (const double limit = schemeOf(model.integrator).dragLimit / rate; rate > 0 && 0.9 * limit < choice.limit)
      choice = {std::min(limit, choice.limit),
                fmt::format("{} of {}, smallest grains", damping[a].fluid ? "drag" : "damping", model.materials[a].name),
                {}};
  }
  if (!model.bonds.empty()) considerBonds(model, neighbours == firstNeighbours, choice);
  considerMagnets(model, choice);
  considerHeat(model, choice);
  if (!std::isfinite(choice.limit))
    throw Error(ErrorKind::scene, "There is nothing to derive a time step from: no grain meets a grain or a wall.", "give time_step");
  if (grows)
    choice.warning =
        "Explicit Euler has no stable step for contacts that are hardly damped: their energy grows, by some per cent in each at the "
        "step that is taken for the limit.";
  return choice;
}

}  // namespace

TimeStepChoice chooseTimeStep(const Model& model) { return choose(model, mostNeighbours); }
TimeStepChoice chooseStepForNewContacts(const Model& model) { return choose(model, firstNeighbours); }

}  // namespace tsubu::sim
