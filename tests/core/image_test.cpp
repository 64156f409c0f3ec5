#include "core/image.h"

#include <gtest/gtest.h>

namespace tsubu {
namespace {

TEST(Image, IsBlackAndTightlyPacked) {
  const Image image(5, 3);
  EXPECT_EQ(image.rgb.size(), 5u * 3u * 3u);
  for (const std::uint8_t byte : image.rgb) EXPECT_EQ(byte, 0);
}

TEST(Image, RowsRunFromTheTopAndPixelsFromTheLeft) {
  Image image(5, 3);
  EXPECT_EQ(image.pixel(0, 0), image.rgb.data());
  EXPECT_EQ(image.pixel(1, 0), image.rgb.data() + 3);
  EXPECT_EQ(image.pixel(0, 1), image.rgb.data() + 15);
  image.pixel(4, 2)[2] = 200;
  EXPECT_EQ(image.rgb.back(), 200);
  EXPECT_EQ(static_cast<const Image&>(image).pixel(4, 2)[2], 200);
}

}  // namespace
}  // namespace tsubu
