#pragma once
// Is a style one that can be drawn?

#include "render/style.h"

namespace tsubu::render {

/// Throws Error(scene) with every value of the style that is out of range.
void checkStyle(const Style& style);

}  // namespace tsubu::render
