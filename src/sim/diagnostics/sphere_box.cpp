#include "sim/diagnostics/sphere_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tsubu::sim {

// The divergence theorem gives the volume of a body that contains rays from the centre: a third of its area on the sphere, less a third
// of each plane's distance times the area in that plane. The area on the sphere follows from Gauss and Bonnet: 2π less the angles by which
// its border turns at the corners (π less the angle there) and on the way (a plane at distance a bends by a times the angle of its arc).

namespace {

constexpr double pi = std::numbers::pi;

double rootOf(double square) { return std::sqrt(std::max(0.0, square)); }
double arcCosine(double x) { return std::acos(std::clamp(x, -1.0, 1.0)); }

double cap(double a) {
  if (a >= 1) return 0;
  if (a <= -1) return 4 * pi / 3;
  return pi / 3 * (1 - a) * (1 - a) * (2 + a);
}

/// The angle between the borders of two caps where they cross.
double cornerAngle(double a, double b) { return arcCosine(a * b / (rootOf(1 - a * a) * rootOf(1 - b * b))); }

/// What the plane at distance a adds to three times the volume beyond two planes, that at b cutting its disc; with its part of the border.
double sideOfTwo(double a, double b) {
  const double disc2 = 1 - a * a, half = arcCosine(b / rootOf(disc2));
  const double area = disc2 * half - b * rootOf(disc2 - b * b);
  return -2 * a * half - a * area;
}

/// Beyond two planes at right angles.
double wedge(double a, double b) {
  if (a < 0) return cap(b) - wedge(-a, b);
  if (b < 0) return cap(a) - wedge(a, -b);
  if (a * a + b * b >= 1) return 0;
  return (2 * cornerAngle(a, b) + sideOfTwo(a, b) + sideOfTwo(b, a)) / 3;
}

/// The same for the plane at a and three planes.
double sideOfThree(double a, double b, double c) {
  const double disc2 = 1 - a * a, disc = rootOf(disc2);
  const double angle = arcCosine(b / disc) + arcCosine(c / disc) - pi / 2;
  const double area = 0.5 * (disc2 * angle - b * (rootOf(disc2 - b * b) - c) - c * (rootOf(disc2 - c * c) - b));
  return -a * angle - a * area;
}

}  // namespace

double volumeBeyond(double a, double b, double c) {
  if (a < 0) return wedge(b, c) - volumeBeyond(-a, b, c);
  if (b < 0) return wedge(a, c) - volumeBeyond(a, -b, c);
  if (c < 0) return wedge(a, b) - volumeBeyond(a, b, -c);
  if (a * a + b * b + c * c >= 1) return 0;
  const double border = cornerAngle(a, b) + cornerAngle(b, c) + cornerAngle(c, a) - pi;
  return (border + sideOfThree(a, b, c) + sideOfThree(b, c, a) + sideOfThree(c, a, b)) / 3;
}

double volumeWithin(const Box& box, const Vec3& centre, double radius) {
  // In radii, from the centre. A plane that misses the sphere is as good as one that touches it: the same value, and no infinities.
  std::array<std::array<double, 2>, 3> plane{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    plane[k] = {std::clamp((box.min()[axis] - centre[axis]) / radius, -1.0, 1.0),
                std::clamp((box.max()[axis] - centre[axis]) / radius, -1.0, 1.0)};
    if (!(plane[k][0] < plane[k][1])) return 0;
  }
  double volume = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t x = corner & 1, y = corner >> 1 & 1, z = corner >> 2 & 1;
    const double sign = (x + y + z) % 2 == 0 ? 1 : -1;
    volume += sign * volumeBeyond(plane[0][x], plane[1][y], plane[2][z]);
  }
  return std::max(0.0, volume) * radius * radius * radius;
}

}  // namespace tsubu::sim
