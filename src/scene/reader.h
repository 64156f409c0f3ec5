#pragma once
// From a scene file to a Scene: every complaint about a file at once.

#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "scene/description.h"

namespace tsubu::scene {

/// Overrides of the command line: "path.to.key=value".
using Overrides = std::vector<std::string>;

/// \brief Reads and checks a scene.
/// Throws Error(files) when the file cannot be read, else Error(scene) with all complaints in the order of the file. What is odd but
/// possible is added to `warnings`, when given.
Scene read(const std::string& path, const Overrides& overrides = {}, std::vector<Diagnostic>* warnings = nullptr);

/// The same from a text; `name` stands for the file in messages and, by its folder, for paths.
Scene readText(std::string_view text, const std::string& name, const Overrides& overrides = {},
               std::vector<Diagnostic>* warnings = nullptr);

}  // namespace tsubu::scene
