#include "render/grain_colours.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "render/colour_map.h"

namespace tsubu::render {

namespace {

void require(bool present, std::string_view what, std::string_view why) {
  if (present) return;
  throw Error(ErrorKind::scene, fmt::format("The grains cannot be coloured by {}: {}.", what, why), "choose another colouring");
}

std::vector<double> valuesOf(const Grains& style, const Snapshot& snapshot) {
  const ColourBy by = style.by;
  const std::size_t n = snapshot.grains();
  std::vector<double> values(n);
  if (by == ColourBy::radius) {
    values = snapshot.radius;
    for (double& radius : values) radius /= style.scale;  // what is drawn may be smaller
  } else if (by == ColourBy::speed) {
    require(snapshot.velocity.size() == n, "speed", "the snapshot has no velocities");
    for (std::size_t k = 0; k < n; ++k) values[k] = snapshot.velocity[k].norm();
  } else if (by == ColourBy::angularVelocity) {
    require(snapshot.angularVelocity.size() == n, "angular velocity", "the scene does not model rotation");
    for (std::size_t k = 0; k < n; ++k) values[k] = snapshot.angularVelocity[k].norm();
  } else if (by == ColourBy::temperature) {
    require(snapshot.temperature.size() == n, "temperature", "the scene does not model heat");
    values = snapshot.temperature;
  } else {
    require(snapshot.load.size() == n, "force", "the snapshot has no contact forces");
    values = snapshot.load;
  }
  return values;
}

Range rangeOf(ColourBy by, const std::vector<double>& values) {
  double low = INFINITY, high = 0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    low = std::min(low, v), high = std::max(high, v);
  }
  if (!(high > 0) || (by != ColourBy::radius && by != ColourBy::temperature)) return rangeUpTo(high);
  return low < high ? Range{low, high} : Range{0.5 * low, 1.5 * high};
}

Legend legendOf(const Grains& style, const std::vector<double>& values) {
  Legend legend;
  legend.map = style.map;
  legend.fixed = style.range.has_value();
  legend.range = style.range ? *style.range : rangeOf(style.by, values);
  const double size = std::max(std::abs(legend.range.low), std::abs(legend.range.high));
  switch (style.by) {
    case ColourBy::speed:
      legend.quantity = "speed", legend.unit = size < 0.1 ? "mm/s" : "m/s", legend.scale = size < 0.1 ? 1e-3 : 1;
      break;
    case ColourBy::radius:
      legend.quantity = "radius", legend.unit = size < 1e-3 ? "µm" : "mm", legend.scale = size < 1e-3 ? 1e-6 : 1e-3;
      break;
    case ColourBy::force:
      legend.quantity = "force", legend.unit = size < 1 ? "mN" : "N", legend.scale = size < 1 ? 1e-3 : 1;
      break;
    case ColourBy::temperature:
      legend.quantity = "temperature", legend.unit.assign(1, 'K');
      break;  // g++ 12 mistakes = "K"
    default:
      legend.quantity = "angular velocity", legend.unit = "rad/s";
      break;
  }
  return legend;
}

}  // namespace

// 1, 1.5, 2, 3, 5 or 7 times a power of ten.
Range rangeUpTo(double largest) {
  if (!(largest > 0)) return {0, 1};
  const double power = std::pow(10, std::floor(std::log10(largest)));
  for (const double step : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0}) {
    if (step * power >= largest) return {0, step * power};
  }
  return {0, 10 * power};
}

GrainColours grainColours(const Grains& style, const Snapshot& snapshot) {
  GrainColours result;
  const std::size_t n = snapshot.grains();
  result.colours.resize(n, style.uniform);
  if (style.by == ColourBy::uniform) return result;
  if (style.by == ColourBy::material) {
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t material = k < snapshot.material.size() ? snapshot.material[k] : 0;
      result.colours[k] = material < style.materials.size() ? style.materials[material] : materialColour(material);
    }
    return result;
  }
  const std::vector<double> values = valuesOf(style, snapshot);
  result.legend = legendOf(style, values);
  const auto [low, high] = result.legend->range;
  for (std::size_t k = 0; k < n; ++k) result.colours[k] = mapped(style.map, (values[k] - low) / (high - low));
  return result;
}

}  // namespace tsubu::render
