#include "scene/description.h"

#include <filesystem>

namespace tsubu::scene {

double frameInterval(const Output& output) {
  return output.frameInterval ? *output.frameInterval : 1 / (output.fps * output.slowMotion.value_or(1));
}

double slowMotion(const Output& output) {
  return output.frameInterval ? 1 / (output.fps * *output.frameInterval) : output.slowMotion.value_or(1);
}

double ledgerInterval(const Output& output) { return output.ledgerInterval.value_or(frameInterval(output)); }

std::string resolved(const Scene& scene, const std::string& file) {
  return (std::filesystem::path(scene.folder) / file).lexically_normal().string();
}

}  // namespace tsubu::scene
