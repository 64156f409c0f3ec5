#pragma once
// The files of src/render/shaders, embedded in the program at build time.

#include <string>
#include <string_view>
#include <vector>

namespace tsubu::render {

/// The text of a shader file for the compiler: version line, one "#define" per entry of `defines` ("NAME value"), and every
/// `#include "file"` replaced by that file. Throws std::logic_error for a file that was not embedded.
std::string shaderSource(std::string_view file, const std::vector<std::string>& defines);

struct EmbeddedFile {
  std::string_view name, text;
};

/// All embedded files; written by embed_shaders.cmake.
const std::vector<EmbeddedFile>& embeddedShaders();

}  // namespace tsubu::render
