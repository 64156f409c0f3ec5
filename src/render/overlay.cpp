#include "render/overlay.h"
namespace tsubu::render {
void drawOverlay(Image&, const Style&, double, const std::optional<Legend>&) {}
}  // namespace tsubu::render
