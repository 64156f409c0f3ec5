#include "render/colour_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tsubu::render {
namespace {

void expectNear(Colour actual, Colour expected, int levels) {
  EXPECT_NEAR(actual.red, expected.red, levels);
  EXPECT_NEAR(actual.green, expected.green, levels);
  EXPECT_NEAR(actual.blue, expected.blue, levels);
}

TEST(ColourMap, PassesThroughPublishedColours) {
  // viridis at eighths, as matplotlib publishes it; entries 21 and 24 of cividis lie in its sharp bend.
  const Colour viridis[] = {{0x44, 0x01, 0x54}, {0x47, 0x2d, 0x7b}, {0x3b, 0x52, 0x8b}, {0x2c, 0x72, 0x8e}, {0x21, 0x91, 0x8c},
                            {0x28, 0xae, 0x80}, {0x5e, 0xc9, 0x62}, {0xad, 0xdc, 0x30}, {0xfd, 0xe7, 0x25}};
  for (int k = 0; k <= 8; ++k) expectNear(mapped(ColourMap::viridis, k / 8.0), viridis[k], 3);
  expectNear(mapped(ColourMap::cividis, 0), {0x00, 0x22, 0x4e}, 1);
  expectNear(mapped(ColourMap::cividis, 21 / 255.0), {0, 49, 112}, 2);
  expectNear(mapped(ColourMap::cividis, 24 / 255.0), {5, 51, 113}, 2);
  expectNear(mapped(ColourMap::cividis, 1), {0xfe, 0xe8, 0x38}, 1);
  expectNear(mapped(ColourMap::batlow, 0), {0x01, 0x19, 0x59}, 0);
  expectNear(mapped(ColourMap::batlow, 1), {0xfa, 0xcc, 0xfa}, 0);
  expectNear(mapped(ColourMap::vik, 0), {0x00, 0x12, 0x61}, 0);
}

TEST(ColourMap, SequentialMapsGetLighterAllTheWay) {
  for (const ColourMap map : {ColourMap::viridis, ColourMap::cividis, ColourMap::batlow}) {
    double last = -1;
    for (int k = 0; k <= 64; ++k) {
      const double now = lightness(mapped(map, k / 64.0));
      EXPECT_GT(now, last - 0.6) << static_cast<int>(map) << ' ' << k;  // rounding to bytes may take half a unit back
      last = now;
    }
  }
}

TEST(ColourMap, TheDivergingMapIsLightestInTheMiddle) {
  for (int k = 1; k <= 8; ++k) {
    EXPECT_LT(lightness(mapped(ColourMap::vik, 0.5 - k / 16.0)), lightness(mapped(ColourMap::vik, 0.5 - (k - 1) / 16.0)));
    EXPECT_LT(lightness(mapped(ColourMap::vik, 0.5 + k / 16.0)), lightness(mapped(ColourMap::vik, 0.5 + (k - 1) / 16.0)));
  }
}

TEST(ColourMap, OutsideIsTheNearestEndAndNoNumberIsGrey) {
  EXPECT_EQ(mapped(ColourMap::viridis, -3), mapped(ColourMap::viridis, 0));
  EXPECT_EQ(mapped(ColourMap::viridis, 7), mapped(ColourMap::viridis, 1));
  EXPECT_EQ(mapped(ColourMap::viridis, std::numeric_limits<double>::quiet_NaN()), (Colour{128, 128, 128}));
}

TEST(Light, FollowsTheSrgbCurve) {
  EXPECT_DOUBLE_EQ(toLinear({0, 0, 0}).x(), 0);
  EXPECT_DOUBLE_EQ(toLinear({255, 0, 0}).x(), 1);
  EXPECT_NEAR(toLinear({188, 0, 0}).x(), 0.5029, 1e-4);  // IEC 61966-2-1: ((188/255 + 0.055)/1.055)^2.4
  EXPECT_NEAR(lightness({119, 119, 119}), 50, 0.1);      // middle grey
  EXPECT_NEAR(lightness({255, 255, 255}), 100, 1e-9);
}

TEST(Palette, NeighbouringMaterialsDiffer) {
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const Vec3 difference = toLinear(materialColour(a)) - toLinear(materialColour(b));
      EXPECT_GT(difference.norm(), 0.08) << a << ' ' << b;
    }
  }
  EXPECT_EQ(materialColour(8), materialColour(0));
}

}  // namespace
}  // namespace tsubu::render
