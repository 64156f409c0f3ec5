#pragma once
// Words and colour bars on a finished picture.

#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "render/grain_colours.h"
#include "render/style.h"

namespace tsubu::render {

/// Draws the time stamp (s), the title and the legend as `style.overlay` asks. Sizes follow the height of the picture.
void drawOverlay(Image& image, const Style& style, double time, const std::optional<Legend>& legend);

/// The rectangle of the colour bar in a picture of that size, in pixels. Column k of its `width` shows the colour of (k + ½)/width.
struct BarPlace {
  int x, y, width, height;
};
BarPlace legendBar(int pictureWidth, int pictureHeight, LegendPlace place = LegendPlace::bottomRight);

/// Round numbers (1, 2 or 5 times a power of ten apart) in [low, high], at most `most` of them.
std::vector<double> roundTicks(double low, double high, int most);

/// "t = 1.25 s", and the slow motion when there is one.
std::string timeStamp(const Overlay& overlay, double time);

}  // namespace tsubu::render
