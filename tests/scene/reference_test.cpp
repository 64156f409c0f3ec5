#include "scene/reference.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace tsubu::scene {
namespace {

TEST(Reference, TheCommittedPageIsUpToDate) {
  std::ifstream file(TSUBU_SOURCE_DIR "/docs/scene_reference.md");
  std::ostringstream committed;
  committed << file.rdbuf();
  EXPECT_TRUE(committed.str() == writeReference()) << "run: tsubu reference > docs/scene_reference.md";
}

TEST(Reference, ExplainsKeysInAndOutsideOfAlternatives) {
  const std::string text = writeReference();
  for (const char* part :
       {"| `end` | a time | required |", "**source = \"stream\"**", "| `rate` | a frequency or a mass per time | required |",
        "`\"velocity_verlet\"`", "## `[walls.NAME.motion]`", "| `friction` |"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
}

}  // namespace
}  // namespace tsubu::scene
