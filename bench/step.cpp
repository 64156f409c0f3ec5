// What a step costs, per grain-step, for the features that a scene may ask for. A bed of 30 000 grains on a slightly compressed lattice
// with random velocities: every grain has its contacts, and they slide and roll. Times are for comparing lines with each other.

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <string>

#include "core/random.h"
#include "sim/kernel/kernels.h"
#include "sim/simulation.h"

namespace tsubu::sim {
namespace {

constexpr double radius = 1e-3;

Model bed(const ContactChoice& contact, Integrator integrator, bool ledger, int edge) {
  Model model;
  model.materials.push_back({"glass", {}});
  model.materials[0].values[Property::density] = 2500;
  PropertyValues values;
  values[Property::normalStiffness] = 1000;
  values[Property::restitution] = 0.5;
  values[Property::friction] = 0.5;
  values[Property::rollingFriction] = 0.1;
  model.pairs = PairTable(1);
  model.pairs.set(0, 0, values);
  model.contact = contact;
  model.integrator = integrator;
  model.ledger = ledger;
  model.gravity = {0, 0, -9.81};
  model.timeStep = 5e-6;
  model.watch.stop = false;
  const double spacing = 1.99 * radius;
  for (int i = 0; i < edge; ++i)
    for (int j = 0; j < edge; ++j)
      for (int k = 0; k < edge; ++k) {
        Random random(1, 2, static_cast<std::uint64_t>((i * edge + j) * edge + k));
        Grain grain;
        grain.radius = radius;
        grain.position = spacing * Vec3(i + 0.5 * (k % 2), j + 0.5 * (k % 2), std::sqrt(0.5) * k) + Vec3::Constant(radius);
        grain.velocity = 0.02 * Vec3(random.normal(), random.normal(), random.normal());
        model.grains.push_back(grain);
      }
  const double side = spacing * (edge + 1.5);
  const auto wall = [&](const char* name, const Vec3& point, const Vec3& normal) {
    Wall plane;
    plane.name = name;
    plane.surface = std::make_shared<const Surface>(Surface::plane(name, point, normal));
    model.walls.push_back(std::move(plane));
  };
  wall("floor", Vec3::Zero(), Vec3::UnitZ());
  wall("left", Vec3::Zero(), Vec3::UnitX());
  wall("front", Vec3::Zero(), Vec3::UnitY());
  wall("right", {side, 0, 0}, -Vec3::UnitX());
  wall("back", {0, side, 0}, -Vec3::UnitY());
  return model;
}

void step(benchmark::State& state, const ContactChoice& contact, Integrator integrator, bool ledger, int threads, const std::string& isa) {
  useKernels(isa);
  Simulation simulation(bed(contact, integrator, ledger, 31), threads);
  simulation.advance(200);
  const auto contacts = static_cast<double>(simulation.contacts().touching);
  const std::uint64_t before = simulation.grainSteps();
  for (auto _ : state) simulation.advance(20);
  const auto grainSteps = static_cast<double>(simulation.grainSteps() - before);
  state.counters["grain_steps/s"] = benchmark::Counter(grainSteps, benchmark::Counter::kIsRate);
  state.counters["contacts/grain"] = contacts / static_cast<double>(simulation.grains());
}

void addAll() {
  const auto add = [](const std::string& name, const ContactChoice& contact, Integrator integrator, bool ledger, int threads, const std::string& isa) {
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { step(state, contact, integrator, ledger, threads, isa); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  };
  const std::string widest(kernels().isa);
  const ContactChoice frictionless{"linear", "none", "none", false}, friction{"linear", "spring", "none", false};
  add("frictionless", frictionless, Integrator::symplecticEuler, false, 1, widest);
  add("friction", friction, Integrator::symplecticEuler, false, 1, widest);
  add("friction, two threads", friction, Integrator::symplecticEuler, false, 2, widest);
  add("friction, velocity Verlet", friction, Integrator::velocityVerlet, false, 1, widest);
  add("friction, ledger", friction, Integrator::symplecticEuler, true, 1, widest);
  add("friction, constant rolling resistance", {"linear", "spring", "constant", false}, Integrator::symplecticEuler, false, 1, widest);
  add("friction, elastic-plastic rolling resistance", {"linear", "spring", "elastic_plastic", false}, Integrator::symplecticEuler, false, 1, widest);
  for (const Kernels& kernels : availableKernels())
    add("friction, " + std::string(kernels.isa), friction, Integrator::symplecticEuler, false, 1, std::string(kernels.isa));
}

}  // namespace
}  // namespace tsubu::sim

int main(int argc, char** argv) {
  tsubu::sim::addAll();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
