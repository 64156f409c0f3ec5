#include "render/style.h"

#include <gtest/gtest.h>

namespace tsubu::render {
namespace {

TEST(Colour, IsReadAsWritten) {
  EXPECT_EQ(parseColour("#12abEF"), (Colour{0x12, 0xab, 0xef}));
  EXPECT_EQ(parseColour("#1af"), (Colour{0x11, 0xaa, 0xff}));
}

TEST(Colour, NothingElseIsAColour) {
  for (const char* text : {"", "#", "12abef", "#12abe", "#12abeg", "#12abef0", "red", "# 2abef", "#-12345"}) {
    EXPECT_FALSE(parseColour(text)) << text;
  }
}

TEST(Colour, TextAndColourAreInverse) {
  for (const Colour c : {Colour{0, 0, 0}, Colour{255, 255, 255}, Colour{1, 20, 200}}) EXPECT_EQ(parseColour(toString(c)), c);
}

TEST(Style, IsComparedByValue) {
  Style a, b;
  EXPECT_EQ(a, b);
  b.camera = OrbitCamera{};
  EXPECT_NE(a, b);
  b = a;
  b.grains.range = Range{0, 2};
  EXPECT_NE(a, b);
}

}  // namespace
}  // namespace tsubu::render
