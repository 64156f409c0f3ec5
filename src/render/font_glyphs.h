#pragma once
// The shapes of the letters.

#include <string_view>

namespace tsubu::render {

/// `strokes`: lines through points "xy", two base-36 digits each, separated by spaces; "~xy" is the control point of a quadratic curve
/// between its neighbours; "|" lifts the pen. The base line is y = 3, small letters reach 10 (a), capitals 13 (d), descenders 0.
struct Glyph {
  char32_t code;
  int width;  ///< of the strokes' middle lines
  std::string_view strokes;
};

/// The glyph of a code point, or the box that stands for what the font lacks.
const Glyph& glyphOf(char32_t code);

}  // namespace tsubu::render
