#pragma once
// Colours for numbers and for materials, and the way between sRGB bytes and light.

#include <cstddef>

#include "render/style.h"

namespace tsubu::render {

/// The colour of `t` in [0, 1]; values outside are clamped, not-a-number is mid grey.
Colour mapped(ColourMap map, double t);

/// Default colour of material number `index`: eight that stay distinct for colour-blind eyes, then from the start again.
Colour materialColour(std::size_t index);

/// Linear light, 0 to 1, of an sRGB-encoded colour (IEC 61966-2-1).
Vec3 toLinear(Colour colour);

/// Perceived lightness L* of CIE 1976, 0 (black) to 100 (white).
double lightness(Colour colour);

}  // namespace tsubu::render
