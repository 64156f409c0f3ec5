// draw_heap FILE: the bytes of a picture with everything in it, for comparing runs of different processes.

#include <cmath>
#include <fstream>
#include <iostream>

#include "core/random.h"
#include "scene_helpers.h"

int main(int count, char** arguments) {
  using namespace tsubu;
  using namespace tsubu::render;
  if (count != 2) {
    std::cerr << "draw_heap FILE\n";
    return 2;
  }
  Style style;
  style.picture = {320, 180, Quality::normal};
  style.grains.by = ColourBy::radius;
  style.grains.pattern = Pattern::stripes;
  style.overlay.title = "heap";
  Snapshot snapshot;
  Random random(7, 1);
  for (int k = 0; k < 3000; ++k) {
    // One number at a time: compilers evaluate arguments in different orders.
    const double x = random.normal() * 0.2, y = random.normal() * 0.2, top = 0.5 * std::exp(-5 * (x * x + y * y));
    const double z = random.uniform(0, top) + 0.02, radius = random.uniform(0.01, 0.02);
    Quat orientation;
    for (double& c : orientation.coeffs()) c = random.normal();
    addGrain(snapshot, Vec3(x, y, z), radius, 0, orientation.normalized());
  }
  WallLook ground, glass;
  ground.ground = true;
  glass.style = WallStyle::translucent;
  std::vector<VisibleWall> walls{{quadMesh({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}), ground}, {cubeMesh(0.4), glass}};
  const Image image = Renderer(style, walls, Box(Vec3(-0.5, -0.5, 0), Vec3(0.5, 0.5, 0.5))).draw(snapshot);
  std::ofstream file(arguments[1], std::ios::binary);
  file.write(reinterpret_cast<const char*>(image.rgb.data()), static_cast<std::streamsize>(image.rgb.size()));
  return file.good() ? 0 : 1;
}
