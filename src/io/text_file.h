#pragma once
// Whole text files.

#include <string>

namespace tsubu::io {

/// The bytes of a file. Throws Error(files), "The scene file 'x' cannot be read.", where `what` is "scene file".
std::string readTextFile(const std::string& path, const std::string& what);

}  // namespace tsubu::io
