#pragma once
// Pictures that were looked at once and must stay as they are. A golden is a PNG that remembers which renderer made it: the same renderer
// must reproduce it byte by byte, any other must look the same. TSUBU_UPDATE_GOLDEN=1 in the environment writes the goldens anew.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "io/png_file.h"
#include "support/image_compare.h"

namespace tsubu::test {

/// Compares a picture with the golden file. On failure the picture and the difference are written to `reports` under the golden's name,
/// and the answer says what differs and where to look.
inline testing::AssertionResult matchesGolden(const std::filesystem::path& golden, const Image& actual, const std::string& renderer,
                                              const std::filesystem::path& reports) {
  const char* update = std::getenv("TSUBU_UPDATE_GOLDEN");
  if (update && std::string(update) == "1") {
    std::filesystem::create_directories(golden.parent_path());
    io::writePng(golden, actual, {{"renderer", renderer}});
    return testing::AssertionSuccess() << "written anew: " << golden;
  }
  if (!std::filesystem::exists(golden)) {
    return testing::AssertionFailure() << golden << " does not exist; look at the picture and run with TSUBU_UPDATE_GOLDEN=1 to keep it";
  }
  const io::PngPicture expected = io::readPng(golden);
  const auto made = expected.text.find("renderer");
  const bool sameRenderer = made != expected.text.end() && made->second == renderer;
  const Comparison comparison = compareImages(expected.image, actual);
  if (comparison.reaches(sameRenderer ? Tier::exact : Tier::perceptual)) return testing::AssertionSuccess() << comparison.text();
  std::filesystem::create_directories(reports);
  const std::string name = golden.stem().string();
  io::writePng(reports / (name + ".actual.png"), actual, {{"renderer", renderer}});
  io::writePng(reports / (name + ".difference.png"), differencePicture(expected.image, actual));
  return testing::AssertionFailure() << golden << " is not matched ("
                                     << (sameRenderer ? "same renderer: must be exact" : "another renderer: must look the same") << "). "
                                     << comparison.text() << ". See " << reports / (name + ".difference.png");
}

}  // namespace tsubu::test
