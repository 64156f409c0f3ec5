// Contact forces of a frame: bars as thick as the force is large. Drawn for the contacts above the mean, they are the force chains.

#include <algorithm>

#include "render/frame_bars.h"

namespace tsubu::render {

namespace {

// A few contacts may carry far more than all others (where a grain lands): the range of a frame leaves out this share of them.
constexpr double beyondRange = 0.02;

/// The forces that are drawn.
std::vector<const SeenForce*> drawnOf(const std::vector<SeenForce>& forces, ShownForces which) {
  double sum = 0;
  for (const SeenForce& force : forces) sum += force.force;
  const double least = which == ShownForces::chains ? sum / static_cast<double>(forces.size()) : 0;
  std::vector<const SeenForce*> drawn;
  for (const SeenForce& force : forces)
    if (force.force > std::max(0.0, least)) drawn.push_back(&force);
  return drawn;
}

Range rangeOf(std::vector<const SeenForce*> drawn) {
  if (drawn.empty()) return rangeUpTo(0);
  const auto beyond = static_cast<std::ptrdiff_t>(beyondRange * static_cast<double>(drawn.size()));
  std::nth_element(drawn.begin(), drawn.begin() + beyond, drawn.end(), [](const auto* a, const auto* b) { return a->force > b->force; });
  return rangeUpTo(drawn[static_cast<std::size_t>(beyond)]->force);
}

}  // namespace

void addForces(Frame& frame, const std::vector<SeenForce>& forces, const Style& style, int firstLook, int side) {
  const std::vector<const SeenForce*> drawn = drawnOf(forces, style.forces.which);
  const Range range = style.forces.range ? *style.forces.range : rangeOf(drawn);
  Bars bars(frame, style, true, side);
  for (const SeenForce* force : drawn) {
    const double thick = std::min(1.0, force->force / range.high);
    bars.add(force->first, force->second, thick * style.forces.radius, firstLook + barLook(force->force, range));
  }
  const bool small = range.high < 1;
  frame.legend = Legend{"contact force", small ? "mN" : "N", style.forces.map, range, small ? 1e-3 : 1, style.forces.range.has_value()};
}

}  // namespace tsubu::render
