// Whatever the text, a reader answers with a scene or with tsubu::Error; under sanitizers this test says more.

#include <gtest/gtest.h>

#include "core/random.h"
#include "scene/reader.h"
#include "scene/writer.h"
#include "scenes.h"

namespace tsubu::scene {
namespace {

// Reads, and prints what could be read.
void tryToRead(const std::string& text) {
  try {
    write(readText(text, "scene.toml"));
  } catch (const Error& error) {
    EXPECT_FALSE(error.diagnostics().empty());
    for (const Diagnostic& d : error.diagnostics()) EXPECT_FALSE(d.message.empty());
  }
}

TEST(Robustness, EveryTruncation) {
  for (std::size_t length = 0; length <= richScene.size(); length += 3) tryToRead(richScene.substr(0, length));
}

TEST(Robustness, EveryMissingLine) {
  for (std::size_t begin = 0; begin < richScene.size();) {
    const std::size_t end = richScene.find('\n', begin) + 1;
    tryToRead(richScene.substr(0, begin) + richScene.substr(end));
    begin = end;
  }
}

TEST(Robustness, RandomBytes) {
  Random random(1, 2);
  for (int i = 0; i < 1500; ++i) {
    std::string text = richScene;
    const int changes = 1 + static_cast<int>(random.uniform(0, 4));
    for (int k = 0; k < changes; ++k)
      text[static_cast<std::size_t>(random.uniform() * static_cast<double>(text.size()))] = static_cast<char>(random.bits() & 0xFF);
    tryToRead(text);
  }
}

// Right words and values in wrong places.
TEST(Robustness, RandomValues) {
  const char* values[] = {"-1",
                          "0",
                          "1e308",
                          "nan",
                          "inf",
                          "-inf",
                          "\"\"",
                          "\"1e400 m\"",
                          "\"2 mm\"",
                          "[]",
                          "[1]",
                          "[1,2,3]",
                          "[[1,2,3],[]]",
                          "{}",
                          "{x = 1}",
                          "true",
                          "1979-05-27",
                          "\"auto\"",
                          "9223372036854775807",
                          "-9223372036854775808",
                          "[\"a\", {}, 1]"};
  std::vector<std::pair<std::size_t, std::size_t>> places;  // of what is right of each =
  for (std::size_t at = richScene.find(" = "); at != std::string::npos; at = richScene.find(" = ", at + 1)) {
    places.emplace_back(at + 3, richScene.find('\n', at) - at - 3);
  }
  for (const auto& [begin, length] : places) {
    for (const char* value : values) {
      std::string text = richScene;
      tryToRead(text.replace(begin, length, value));
    }
  }
}

TEST(Robustness, DeepNesting) {
  tryToRead("a = " + std::string(10000, '['));
  tryToRead("a = " + std::string(200, '[') + std::string(200, ']'));
  std::string path = "a";
  for (int i = 0; i < 5000; ++i) path += ".a";
  tryToRead(path + " = 1");
  tryToRead("[simulation]\nend = \"1 " + std::string(5000, '(') + "s\"");
}

}  // namespace
}  // namespace tsubu::scene
