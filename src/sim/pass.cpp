#include "sim/pass.h"

namespace tsubu::sim {

std::vector<std::unique_ptr<ForcePass>> makePasses(const Model&) {
  std::vector<std::unique_ptr<ForcePass>> passes;
  return passes;
}

}  // namespace tsubu::sim
