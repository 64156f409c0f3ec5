#pragma once
// A small font of our own: strokes of a round pen, drawn smoothly at any size, the same on every machine.

#include <optional>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "render/style.h"

namespace tsubu::render {

/// Where and how to write. `capHeight` (pixels) is the height of a capital letter; `x` and `y` place the left end of the base line.
struct Pen {
  double x = 0, y = 0;
  double capHeight = 12;
  Colour ink{0, 0, 0}, halo{255, 255, 255};  ///< the halo keeps the words legible on anything
};

/// Width of a line of UTF-8 text in pixels.
double textWidth(std::string_view utf8, double capHeight);

/// Writes one line. Knows ASCII and µ ° × ² · – −; anything else becomes a box.
void drawText(Image& image, std::string_view utf8, const Pen& pen);

/// The code points of UTF-8 text; bytes that are none count as U+FFFD.
std::vector<char32_t> codePoints(std::string_view utf8);

}  // namespace tsubu::render
