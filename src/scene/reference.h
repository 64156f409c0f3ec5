#pragma once
// The reference of the scene format, made from the description that also reads scenes: it cannot be out of date.

#include <string>

namespace tsubu::scene {

/// docs/scene_reference.md, in Markdown.
std::string writeReference();

}  // namespace tsubu::scene
