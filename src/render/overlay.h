#pragma once
// Words and colour bars on a finished picture.

#include <optional>

#include "core/image.h"
#include "render/grain_colours.h"
#include "render/style.h"

namespace tsubu::render {

/// Draws the time stamp (s), the title and the legend as `style.overlay` asks. Sizes follow the height of the picture.
void drawOverlay(Image& image, const Style& style, double time, const std::optional<Legend>& legend);

}  // namespace tsubu::render
