#include "sim/periodic.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/model.h"

namespace tsubu::sim {

void checkPeriods(const Model& model) {
  double largest = 0;
  for (const Grain& grain : model.grains) largest = std::max(largest, grain.radius);
  for (const Stream& stream : model.streams) largest = std::max(largest, stream.radii.largest());
  for (int axis = 0; axis < 3; ++axis) {
    if (!model.periodic[static_cast<std::size_t>(axis)]) continue;
    const double length = model.domain.isEmpty() ? 0 : model.domain.sizes()[axis];
    if (!std::isfinite(length) || !(length > 0))
      throw Error(ErrorKind::scene, fmt::format("The domain is periodic along {} and has no end there.", "xyz"[axis]),
                  "give its min and max");
    if (length < leastPeriod * largest)
      throw Error(
          ErrorKind::scene,
          fmt::format("The domain is {:.4g} m long along {}, where it is periodic: grains of radius {:.4g} m need at least {:.4g} m.",
                      length, "xyz"[axis], largest, leastPeriod * largest),
          "a grain must not meet another one twice");
  }
}

}  // namespace tsubu::sim
