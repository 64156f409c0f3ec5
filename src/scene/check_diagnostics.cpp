#include <cmath>

#include <fmt/format.h>

#include "scene/check.h"

namespace tsubu::scene {

namespace {

constexpr std::uint64_t mostCells = 1000000;

std::string boxTrouble(const sim::BoxRegion& box) {
  for (int k = 0; k < 3; ++k)
    if (!std::isfinite(box.min[k]) || !std::isfinite(box.max[k])) return "The box is infinite: means need a volume.";
  for (int k = 0; k < 3; ++k)
    if (!(box.min[k] < box.max[k]))
      return fmt::format("The box is empty: its {} runs from {} m to {} m.", "xyz"[k], box.min[k], box.max[k]);
  return {};
}

}  // namespace

void checkDiagnostics(const Scene& scene, const PositionOf& positionOf, Findings& findings) {
  if (!scene.diagnostics) return;
  const auto complain = [&](const Path& path, std::string sentence, std::string hint = {}) {
    findings.errors.push_back({positionOf(path), std::move(sentence), std::move(hint)});
  };
  for (const DiagnosticRegion& region : scene.diagnostics->regions) {
    const Path path{"diagnostics", "regions", region.name};
    if (region.name == "whole")
      complain(path, "The region 'whole' is always there: it is around all grains.", "give this one another name");
    if (const std::string trouble = boxTrouble(region.box); !trouble.empty()) complain({path[0], path[1], path[2], "box"}, trouble);
  }
  const auto& grid = scene.diagnostics->grid;
  if (!grid) return;
  if (const std::string trouble = boxTrouble(grid->box); !trouble.empty()) complain({"diagnostics", "grid", "box"}, trouble);
  const std::uint64_t cells = grid->cells[0] * grid->cells[1] * grid->cells[2];
  if (cells > mostCells)
    complain({"diagnostics", "grid", "cells"}, fmt::format("The grid has {} cells, more than {}.", cells, mostCells), "make them larger");
}

}  // namespace tsubu::scene
