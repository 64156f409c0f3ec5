#include "scene/form.h"

#include <fmt/format.h>

#include <cmath>

namespace tsubu::scene {

bool Bounds::allow(double value) const {
  if (std::isnan(value) || (std::isinf(value) && !infinite)) return false;
  return (lowerIncluded ? value >= lower : value > lower) && value <= upper;
}

std::string Bounds::description() const {
  const bool below = std::isfinite(lower), above = std::isfinite(upper);
  if (below && above) return fmt::format("{} {} and at most {}", lowerIncluded ? "at least" : "more than", lower, upper);
  if (above) return fmt::format("at most {}", upper);
  if (!below) return "finite";
  if (lower == 0 && !lowerIncluded) return "positive";
  return fmt::format("{} {}", lowerIncluded ? "at least" : "more than", lower);
}

}  // namespace tsubu::scene
