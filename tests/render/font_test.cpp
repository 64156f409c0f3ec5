#include "render/font.h"

#include <gtest/gtest.h>

#include <cctype>
#include <set>
#include <string>

#include "render/font_glyphs.h"

namespace tsubu::render {
namespace {

Image written(std::string_view text, double capHeight, int width = 60, int height = 40) {
  Image image(width, height);
  Pen pen;
  pen.x = 6;
  pen.y = 0.7 * height;
  pen.capHeight = capHeight;
  pen.ink = {255, 255, 255};
  pen.halo = {0, 0, 0};
  drawText(image, text, pen);
  return image;
}

double inked(const Image& image) {
  double sum = 0;
  for (const auto byte : image.rgb) sum += byte / 765.0;
  return sum;
}

TEST(Font, HasAllOfAsciiAndItsStrokesAreWellFormed) {
  const Glyph& box = glyphOf(U'\u4e2d');
  for (char32_t code = 32; code < 127; ++code) {
    const Glyph& glyph = glyphOf(code);
    EXPECT_EQ(glyph.code, code);
    EXPECT_NE(&glyph, &box);
    // "xy" or "~xy", separated by one space or by "|".
    for (std::size_t k = 0; k < glyph.strokes.size();) {
      if (glyph.strokes[k] == ' ' || glyph.strokes[k] == '|') {
        ++k;
        continue;
      }
      k += glyph.strokes[k] == '~';
      ASSERT_LT(k + 1, glyph.strokes.size()) << static_cast<char>(code);
      for (int c = 0; c < 2; ++c, ++k) {
        const auto digit = static_cast<unsigned char>(glyph.strokes[k]);
        ASSERT_TRUE(std::isdigit(digit) || std::islower(digit)) << static_cast<char>(code);
      }
    }
  }
  for (const char32_t code : {U'\u00b5', U'\u00b0', U'\u00d7', U'\u00b2'}) EXPECT_EQ(glyphOf(code).code, code);
}

TEST(Font, EveryLetterLooksDifferent) {
  std::set<std::vector<std::uint8_t>> seen;
  for (char c = '!'; c < 127; ++c) EXPECT_TRUE(seen.insert(written(std::string(1, c), 14).rgb).second) << c;
}

TEST(Font, LettersStayWithinTheirWidth) {
  for (char c = '!'; c < 127; ++c) {
    const Image image = written(std::string(1, c), 16);
    const double right = 6 + textWidth(std::string(1, c), 16) + 1;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        if (image.pixel(x, y)[0] == 0) continue;
        ASSERT_GE(x, 5) << c;
        ASSERT_LE(x, right) << c;
      }
    }
  }
}

TEST(Font, InkGrowsWithTheSquareOfTheSize) { EXPECT_NEAR(inked(written("E", 24)) / inked(written("E", 12)), 4, 0.4); }

TEST(Font, DigitsAreEquallyWideSoThatAClockDoesNotJump) {
  for (char c = '0'; c <= '9'; ++c) EXPECT_EQ(textWidth(std::string(1, c), 10), textWidth("0", 10));
}

TEST(Font, TextBeyondTheEdgeIsCut) {
  EXPECT_NO_THROW(written("a long line that leaves the picture", 30));
  Image tiny(3, 3);
  EXPECT_NO_THROW(drawText(tiny, "W", Pen{-5, -5, 40}));
}

TEST(Utf8, IsDecodedAndBrokenBytesAreMarked) {
  EXPECT_EQ(codePoints("aµ×\u20ac"), (std::vector<char32_t>{U'a', U'\u00b5', U'\u00d7', U'\u20ac'}));
  EXPECT_EQ(codePoints("\xff"
                       "a\xc2"),
            (std::vector<char32_t>{U'\ufffd', U'a', U'\ufffd'}));
  EXPECT_EQ(codePoints("\xf0\x9f\x8c\xbe"), (std::vector<char32_t>{U'\U0001f33e'}));
}

}  // namespace
}  // namespace tsubu::render
