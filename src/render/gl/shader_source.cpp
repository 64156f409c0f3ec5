#include "render/gl/shader_source.h"

#include <stdexcept>

namespace tsubu::render {

namespace {

std::string_view embedded(std::string_view name) {
  for (const EmbeddedFile& file : embeddedShaders()) {
    if (file.name == name) return file.text;
  }
  throw std::logic_error("shader file not embedded: " + std::string(name));
}

std::string withIncludes(std::string_view text) {
  constexpr std::string_view directive = "#include \"";
  std::string result;
  while (!text.empty()) {
    const auto end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    if (line.substr(0, directive.size()) == directive) {
      const std::string_view rest = line.substr(directive.size());
      result += withIncludes(embedded(rest.substr(0, rest.find('"'))));
    } else {
      result += line;
      result += '\n';
    }
  }
  return result;
}

}  // namespace

std::string shaderSource(std::string_view file, const std::vector<std::string>& defines) {
  std::string result = "#version 450 core\n";
  for (const std::string& define : defines) result += "#define " + define + "\n";
  return result + withIncludes(embedded(file));
}

}  // namespace tsubu::render
