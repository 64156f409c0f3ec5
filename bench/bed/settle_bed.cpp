// Makes the grains that bench/peers starts from.
//   settle_bed BED.csv [THREADS]          30,420 spheres of 2 mm that fell into a box and came to rest
//   settle_bed BED.csv THREADS SCENE      the grains of any scene, as they are at its end
// Deterministic: the same bytes on every machine, with any number of threads.

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <memory>

#include "core/random.h"
#include "scene/build.h"
#include "scene/reader.h"
#include "sim/simulation.h"

namespace {

using namespace tsubu;

constexpr double side = 0.084;  // m, of the box in x and y
constexpr double radius = 0.001;
constexpr int across = 39, layers = 20;
constexpr double timeStep = 1e-5;        // s
constexpr std::uint64_t steps = 20'000;  // 0.2 s: ten times what the top layer takes to fall

// Layers of a loose square lattice, each grain off its place by up to the free gap, so that no two overlap and no order is left.
std::vector<sim::Grain> looseLayers() {
  constexpr double spacing = side / across, slack = 0.98 * (spacing - 2 * radius) / 2;
  std::vector<sim::Grain> grains;
  for (int layer = 0; layer < layers; ++layer) {
    for (int row = 0; row < across; ++row) {
      for (int column = 0; column < across; ++column) {
        Random random(1, 0, grains.size());
        const Vec3 place = spacing * Vec3(column + 0.5, row + 0.5, layer + 0.5);
        sim::Grain grain;
        grain.radius = radius;
        grain.position = sim::spreadAround(place, slack, random);
        grain.velocity = sim::spreadAround(Vec3::Zero(), 0.1, random);
        grains.push_back(grain);
      }
    }
  }
  return grains;
}

sim::Wall planeWall(const char* name, const Vec3& point, const Vec3& normal) {
  sim::Wall wall;
  wall.name = name;
  wall.surface = std::make_shared<const sim::Surface>(sim::Surface::plane(name, point, normal));
  return wall;
}

sim::Model looseBed() {
  sim::Model model;
  model.materials.resize(1);
  model.materials[0].name = "glass";
  model.materials[0].values[sim::Property::density] = 2500;
  sim::PropertyValues pair;  // as bench/peers/bed.py has them
  pair[sim::Property::normalStiffness] = 1000;
  pair[sim::Property::tangentialStiffness] = 285.7;
  pair[sim::Property::normalDampingRate] = 3118;
  pair[sim::Property::tangentialDampingRate] = 1559;
  pair[sim::Property::friction] = 0.5;
  model.pairs = sim::PairTable(1);
  model.pairs.set(0, 0, pair);
  model.contact.tension = true;
  model.gravity = {0, 0, -9.81};
  model.timeStep = timeStep;
  model.ledger = false;
  model.walls = {planeWall("floor", Vec3::Zero(), Vec3::UnitZ()), planeWall("left", Vec3::Zero(), Vec3::UnitX()),
                 planeWall("right", Vec3(side, 0, 0), -Vec3::UnitX()), planeWall("front", Vec3::Zero(), Vec3::UnitY()),
                 planeWall("back", Vec3(0, side, 0), -Vec3::UnitY())};
  model.grains = looseLayers();
  return model;
}

void write(const Snapshot& bed, const std::string& path) {
  std::ofstream file(path);
  file << "x,y,z,radius,vx,vy,vz,wx,wy,wz\n";
  for (std::size_t i = 0; i < bed.grains(); ++i) {
    const Vec3 &x = bed.position[i], &v = bed.velocity[i], &w = bed.angularVelocity[i];
    fmt::print(file, "{},{},{},{},{},{},{},{},{},{}\n", x.x(), x.y(), x.z(), bed.radius[i], v.x(), v.y(), v.z(), w.x(), w.y(), w.z());
  }
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) {
    std::cerr << "usage: settle_bed BED.csv [THREADS [SCENE]]\n";
    return 2;
  }
  try {
    sim::Model model;
    std::uint64_t count = steps;
    if (argc == 4) {
      scene::Built built = scene::build(scene::read(argv[3], {}, nullptr));
      model = std::move(built.model);
      count = built.plan.steps;
    } else {
      model = looseBed();
    }
    sim::Simulation simulation(std::move(model), argc >= 3 ? std::atoi(argv[2]) : 1);
    simulation.advance(count);
    Snapshot bed;
    simulation.fill(bed);
    write(bed, argv[1]);
    const sim::ContactSummary contacts = simulation.contacts();
    fmt::print("{} grains, {} contacts, kinetic energy {:.3g} J, state {:016x}\n", bed.grains(), contacts.touching,
               simulation.ledger().kinetic(), simulation.stateHash());
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
