// How far the energy of elastic contacts drifts: one grain between two walls, for each integrator.
//
//   drift [contact times] [ω Δt]       (1e6 and 0.1 when absent)
//
// "Held": the walls press the grain, the contact is smooth and lasts; "bouncing": contacts begin and end. Prints the largest error of the
// energy that swings to and fro, and the one at the end, over the energy at the start.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>

#include "sim/simulation.h"

namespace {

using namespace tsubu;
using namespace tsubu::sim;

constexpr double stiffness = 1000, mass = 1e-5, radius = 2e-3, pi = std::numbers::pi;

Wall planeAt(double z, double normal) {
  Wall wall;
  wall.name = fmt::format("plane at {}", z);
  wall.surface = std::make_shared<const Surface>(Surface::plane(wall.name, {0, 0, z}, {0, 0, normal}));
  return wall;
}

struct Drift {
  double largest = 0, last = 0;
};

/// `W`: ω Δt of the contact.
Drift driftOf(Integrator integrator, bool held, double contactTimes, double W) {
  Model model;
  model.integrator = integrator;
  model.materials.push_back({"elastic", {}});
  model.materials[0].values[Property::density] = mass / (4.0 / 3.0 * pi * radius * radius * radius);
  PropertyValues values;
  values[Property::normalStiffness] = stiffness;
  values[Property::restitution] = 1;
  model.pairs = PairTable(1);
  model.pairs.set(0, 0, values);
  model.contact = {"linear", "none", "none"};
  const double half = held ? 0.95 * radius : 1.01 * radius, omega = std::sqrt((held ? 2 : 1) * stiffness / mass);
  model.walls = {planeAt(-half, 1), planeAt(half, -1)};
  Grain grain;
  grain.radius = radius;
  grain.velocity = {0, 0, 0.3};
  model.grains.push_back(grain);
  model.timeStep = W / omega;
  model.watch.stop = false;
  Simulation simulation(std::move(model), 1);
  // What the walls hold when the grain stands in the middle takes no part.
  const double rest = held ? stiffness * (radius - half) * (radius - half) : 0, start = simulation.ledger().mechanical() - rest;
  const double steps = contactTimes * pi / W;
  Drift drift;
  for (double done = 0; done < steps && std::abs(drift.last) < 1;) {
    const double run = std::min(steps - done, 9973.0);
    simulation.advance(static_cast<std::uint64_t>(std::ceil(run)));
    done += std::ceil(run);
    drift.last = (simulation.ledger().mechanical() - rest) / start - 1;
    drift.largest = std::max(drift.largest, std::abs(drift.last));
  }
  return drift;
}

}  // namespace

int main(int argc, char** argv) {
  const double contactTimes = argc > 1 ? std::atof(argv[1]) : 1e6, W = argc > 2 ? std::atof(argv[2]) : 0.1;
  fmt::print("{:g} contact times, ω Δt = {:g}\n{:<20} {:>24} {:>24}\n", contactTimes, W, "", "held: largest, last",
             "bouncing: largest, last");
  for (const auto integrator : {Integrator::explicitEuler, Integrator::symplecticEuler, Integrator::leapfrog,
                                Integrator::centralDifferences, Integrator::velocityVerlet, Integrator::rungeKutta}) {
    const Drift held = driftOf(integrator, true, contactTimes, W), bouncing = driftOf(integrator, false, contactTimes, W);
    fmt::print("{:<20} {:>12.1e}, {:>10.1e} {:>12.1e}, {:>10.1e}\n", schemeOf(integrator).name, held.largest, held.last, bouncing.largest,
               bouncing.last);
  }
}
