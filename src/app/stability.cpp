#include "app/stability.h"

#include <fmt/format.h>

#include "app/interrupt.h"
#include "study/stability.h"

namespace tsubu::app {

int stability(const RunOptions& options) {
  study::StabilityRequest request;
  request.scene = options.scene;
  request.overrides = options.overrides;
  request.at = options.until;
  watchForInterrupt();
  const auto found = study::findStability(request, [] { return interrupted(); });
  if (!found) return 130;
  fmt::print("{}", study::tableOf(*found));
  return 0;
}

}  // namespace tsubu::app
