// One bad file for each message: tests/scenes/bad/*.toml. Their first lines say what tsubu must answer,
//   # expect: 3:10: The sentence. (the hint)
// one such line for each complaint, in order. What concerns the file as a whole has no line and column.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scene/build.h"
#include "scene/reader.h"

namespace tsubu::scene {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> badFiles() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(TSUBU_SOURCE_DIR "/tests/scenes/bad")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string expectedOf(const fs::path& file) {
  std::ifstream stream(file);
  std::string expected;
  const std::string mark = "# expect: ";
  for (std::string line; std::getline(stream, line) && line.starts_with(mark);) expected += line.substr(mark.size()) + "\n";
  return expected;
}

// What tsubu says, without the folder and the name of the file.
std::string answerOf(const fs::path& file) {
  try {
    build(read(file.string()));
    return "accepted\n";
  } catch (const Error& error) {
    std::string answer;
    for (const Diagnostic& d : error.diagnostics()) {
      std::string text = toString(d);
      for (const std::string& prefix : {file.string() + ":", file.parent_path().string() + "/"}) {
        for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) text.erase(at, prefix.size());
      }
      answer += (text.starts_with(" ") ? text.substr(1) : text) + "\n";
    }
    return answer;
  }
}

class BadScene : public testing::TestWithParam<fs::path> {};

TEST_P(BadScene, IsRefusedWithItsMessage) {
  const std::string expected = expectedOf(GetParam());
  ASSERT_FALSE(expected.empty()) << "no line '# expect: …'";
  EXPECT_EQ(answerOf(GetParam()), expected);
}

INSTANTIATE_TEST_SUITE_P(Files, BadScene, testing::ValuesIn(badFiles()), [](const testing::TestParamInfo<fs::path>& file) {
  std::string name = file.param.stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
});

TEST(BadScenes, AreThere) { EXPECT_GT(badFiles().size(), 60u); }

}  // namespace
}  // namespace tsubu::scene
