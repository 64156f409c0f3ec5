// What a step costs, per grain-step, for each of the features that a scene may ask for. A bed of 14 000 grains on a slightly compressed
// lattice with random velocities: every grain has its contacts, and they slide and roll. Times are for comparing lines with each other; a
// line names the one that it is compared with. bench/costs.py makes the table of them that `tsubu explain` shows.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

#include "core/error.h"
#include "core/random.h"
#include "sim/kernel/kernels.h"
#include "sim/laws/catalogue.h"
#include "sim/simulation.h"

namespace tsubu::sim {
namespace {

constexpr double radius = 1e-3;

constexpr int edge = 24;
constexpr double spacing = 1.99 * radius;

ContactChoice frictionless() { return {"linear", "none", "none", false}; }
ContactChoice friction() { return {"linear", "spring", "none", false}; }

Wall planeWall(const char* name, const Vec3& point, const Vec3& normal) {
  Wall plane;
  plane.name = name;
  plane.surface = std::make_shared<const Surface>(Surface::plane(name, point, normal));
  return plane;
}

Model bed(const ContactChoice& contact) {
  Model model;
  model.materials.push_back({"glass", {}});
  PropertyValues& glass = model.materials[0].values;
  glass[Property::density] = 2500;
  glass[Property::youngModulus] = 5e6;
  glass[Property::poissonRatio] = 0.25;
  PropertyValues values;
  values[Property::normalStiffness] = 1000;
  values[Property::restitution] = 0.5;
  values[Property::friction] = 0.5;
  values[Property::rollingFriction] = 0.1;
  values[Property::rollingViscosity] = 0.1;
  values[Property::twistingFriction] = 0.1;
  values[Property::tangentialDampingRate] = 500;
  model.pairs = PairTable(1);
  model.pairs.set(0, 0, values);
  model.contact = contact;
  model.integrator = Integrator::symplecticEuler;
  model.ledger = false;
  model.gravity = {0, 0, -9.81};
  model.timeStep = 5e-6;
  model.watch.stop = false;
  model.orientation = false;
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
  model.walls = {planeWall("floor", Vec3::Zero(), Vec3::UnitZ()), planeWall("left", Vec3::Zero(), Vec3::UnitX()),
                 planeWall("front", Vec3::Zero(), Vec3::UnitY()), planeWall("right", {side, 0, 0}, -Vec3::UnitX()),
                 planeWall("back", {0, side, 0}, -Vec3::UnitY())};
  return model;
}

/// A floor of triangles.
std::shared_ptr<const Surface> meshFloor() {
  TriangleMesh mesh;
  mesh.name = "floor";
  constexpr int cells = 20;
  const double side = spacing * (edge + 3), start = -spacing;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      mesh.vertices.emplace_back(start + side * i / cells, start + side * j / cells, 1e-5 * ((i * 7 + j * 3) % 5));
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const int a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return std::make_shared<const Surface>(mesh);
}

/// A line of the table: a bed, and the line that it is measured against.
struct Row {
  std::string feature, base;
  Model model;
};

std::vector<Row> rows() {
  std::vector<Row> all;
  const std::string plain = "contacts, motion, lists", rubbing = "tangential: spring";
  const auto law = [&](std::string_view family, std::string_view name, std::string base, ContactChoice contact) {
    const_cast<std::string&>(chosenIn(contact, family)) = name;
    all.push_back({std::string(family) + ": " + std::string(name), std::move(base), bed(contact)});
  };
  const auto change = [&](const std::string& feature, const auto& by, const std::string& base, const ContactChoice& contact) {
    Row row{feature, base, bed(contact)};
    by(row.model);
    all.push_back(std::move(row));
  };
  all.push_back({plain, "", bed(frictionless())});
  ContactChoice said = frictionless();
  said.tension = false, said.twisting = "none", said.rotation = true;
  change(
      "everything off, said so",
      [](Model& m) {
        m.fields = {}, m.magnets.reset(), m.heat = false, m.continuous = false, m.ledger = false, m.contactForces = false, m.periodic = {};
        m.bonds.clear(), m.streams.clear(), m.sinks.clear(), m.counters.clear();
      },
      plain, said);
  const auto works = [](const ContactChoice& contact) {
    try {
      lawIndex(contact);
      return true;
    } catch (const Error&) {
      return false;
    }
  };
  for (const LawFamily& family : lawFamilies()) {
    for (const LawInfo& info : family.laws) {
      if (info.name == "none" || (family.key == "normal" && info.name == "linear")) continue;
      const bool own = family.key == "normal" || family.key == "tangential";
      ContactChoice contact = own ? frictionless() : friction();
      const_cast<std::string&>(chosenIn(contact, family.key)) = info.name;
      const bool fits = works(contact);
      if (!fits) contact.normal = "hertz";
      law(family.key, info.name, own ? (fits ? plain : "normal: hertz") : rubbing, contact);
    }
  }
  const auto rub = [&](const std::string& feature, const auto& by) { change(feature, by, rubbing, friction()); };
  rub("orientation of grains", [](Model& m) { m.orientation = true; });
  rub("rotation held", [](Model& m) { m.contact.rotation = false; });
  for (const Integrator integrator : {Integrator::velocityVerlet, Integrator::explicitEuler, Integrator::leapfrog,
                                      Integrator::centralDifferences, Integrator::rungeKutta})
    rub("integrator: " + std::string(schemeOf(integrator).name), [integrator](Model& m) { m.integrator = integrator; });
  rub("energy ledger", [](Model& m) { m.ledger = true; });
  rub("bonds", [](Model& m) {
    Bonding glue;
    glue.name = "glue";
    glue.distance = 1.02;
    glue.stiffness = 1e8;
    glue.stiffnessRatio = 2.5;
    m.bonds = {glue};
  });
  rub("drag", [](Model& m) {
    m.fields.drag.emplace();
    m.fields.drag->viscosity = 1e-3;
    m.fields.drag->density = 1000;
  });
  rub("global damping", [](Model& m) {
    m.fields.damping.emplace();
    m.fields.damping->rate = 1;
  });
  rub("magnets", [](Model& m) {
    m.materials[0].values[Property::susceptibility] = 1;
    m.magnets.emplace();
    m.magnets->cutOff = 4 * radius;
    m.magnets->sources.push_back({UniformSource{{0, 0, 0.01}}, {}});
  });
  rub("heat conduction", [](Model& m) {
    m.heat = true;
    m.materials[0].values[Property::conductivity] = 1;
    m.materials[0].values[Property::heatCapacity] = 800;
    for (std::size_t g = 0; g < m.grains.size(); ++g) m.grains[g].temperature = 300 + static_cast<double>(g % 7);
  });
  rub("periodic domain", [](Model& m) {
    m.domain = Box(Vec3(0, 0, -1), Vec3(spacing * edge, spacing * edge, 1));
    m.periodic = {true, true, false};
    m.walls.resize(1);
  });
  rub("mesh wall", [](Model& m) { m.walls[0].surface = meshFloor(); });
  rub("moving wall", [](Model& m) { m.walls[0].motion = WallMotion({MotionPart{Oscillation{{0, 0, 1e-5}, 50, 0}, 0, 10}}); });
  rub("walls that move under load", [](Model& m) {
    m.walls[0].body.emplace();
    m.walls[0].body->mass = 1;
    m.walls[0].body->weight = false;
    m.walls[0].body->force = 1;
  });
  rub("sizes of grains", [](Model& m) {
    for (std::size_t g = 0; g < m.grains.size(); ++g) m.grains[g].radius *= 1 + 0.02 * (static_cast<double>(g * 2654435761U % 11) - 5) / 5;
  });
  rub("mixed precision", [](Model& m) { m.precision = Precision::mixed; });
  rub("continuous collisions", [](Model& m) { m.continuous = true; });
  return all;
}

/// ns of all threads together, in steps after those that were timed: of each stage for a grain, and of the pass over pairs for a contact.
void countStages(benchmark::State& state, Simulation& simulation, double contacts) {
  constexpr int steps = 40;
  const std::uint64_t before = simulation.grainSteps();
  simulation.startProfile();
  simulation.advance(steps);
  const auto grainSteps = static_cast<double>(simulation.grainSteps() - before);
  const Profile::Seconds seconds = simulation.profile();
  for (std::size_t part = 0; part < seconds.size(); ++part)
    if (seconds[part] > 0) state.counters["ns: " + std::string(nameOf(static_cast<ProfilePart>(part)))] = 1e9 * seconds[part] / grainSteps;
  if (contacts > 0) state.counters["ns/contact"] = 1e9 * seconds[static_cast<std::size_t>(ProfilePart::pairs)] / (contacts * steps);
}

void step(benchmark::State& state, const Model& model, int threads, const std::string& isa) {
  useKernels(isa);
  constexpr int portion = 20;
  const Plan plan = Simulation::plan(model);
  Simulation simulation(model, threads);
  simulation.advance(200);
  const auto contacts = static_cast<double>(simulation.contacts().touching);
  char hash[20];
  std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(simulation.stateHash()));
  const std::uint64_t before = simulation.grainSteps();
  for (auto _ : state) simulation.advance(portion);
  const auto grainSteps = static_cast<double>(simulation.grainSteps() - before);
  state.counters["grain_steps/s"] = benchmark::Counter(grainSteps, benchmark::Counter::kIsRate);
  state.counters["grain_steps"] = portion * static_cast<double>(simulation.grains());
  state.counters["contacts/grain"] = contacts / static_cast<double>(simulation.grains());
  state.counters["bytes/grain"] = static_cast<double>(plan.bytesPerGrain);
  state.counters["bytes/contact"] = static_cast<double>(plan.bytesPerContact);
  state.SetLabel(hash);
  countStages(state, simulation, contacts);
}

void addAll() {
  const auto add = [](const std::string& name, const Model& model, int threads, const std::string& isa) {
    const auto shared = std::make_shared<const Model>(model);
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { step(state, *shared, threads, isa); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  };
  const std::string widest(kernels().isa);
  // The name has the line that it is compared with: bench/costs.py takes the difference.
  for (const Row& row : rows()) add(row.feature + (row.base.empty() ? "" : " | " + row.base), row.model, 1, widest);
  add("two threads | tangential: spring", bed(friction()), 2, widest);
  for (const Kernels& kernels : availableKernels())
    add(std::string(kernels.isa) + " | tangential: spring", bed(friction()), 1, std::string(kernels.isa));
}

/// As Linux names it.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos) return line.substr(line.find(": ") + 2);
  return "unknown";
}

}  // namespace
}  // namespace tsubu::sim

int main(int argc, char** argv) {
  tsubu::sim::addAll();
  benchmark::AddCustomContext("isa", std::string(tsubu::sim::kernels().isa));
  benchmark::AddCustomContext("processor", tsubu::sim::processor());
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
