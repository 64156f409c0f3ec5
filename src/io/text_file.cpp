#include "io/text_file.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "core/error.h"

namespace tsubu::io {

std::string readTextFile(const std::string& path, const std::string& what) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  // A folder opens like a file and fails at the first byte; copying nothing out of an empty file would count as a failure.
  if (stream && stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (!stream.is_open() || stream.bad()) {
    throw Error(ErrorKind::files, fmt::format("The {} '{}' cannot be read.", what, path), "is the path right?");
  }
  return text.str();
}

}  // namespace tsubu::io
