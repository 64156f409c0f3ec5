#include "render/overlay.h"

#include <gtest/gtest.h>

#include "render/colour_map.h"
#include "scene_helpers.h"

namespace tsubu::render {
namespace {

TEST(TimeStamp, HasTheDecimalsAskedForAndTheSlowMotion) {
  Overlay overlay;
  EXPECT_EQ(timeStamp(overlay, 1.25), "t = 1.25 s");
  overlay.timeDecimals = 4;
  overlay.slowMotion = 10;
  EXPECT_EQ(timeStamp(overlay, 0.5), "t = 0.5000 s   slow motion 10×");
  overlay.slowMotion = 0.2;
  EXPECT_EQ(timeStamp(overlay, 0), "t = 0.0000 s   time lapse 5×");
  overlay.slowMotion = 1;
  EXPECT_EQ(timeStamp(overlay, 0), "t = 0.0000 s");
}

TEST(Ticks, AreRoundAndWithinTheRange) {
  EXPECT_EQ(roundTicks(0, 1, 6), (std::vector<double>{0, 0.2, 0.4, 0.6000000000000001, 0.8, 1}));
  EXPECT_EQ(roundTicks(0, 1.5, 6), (std::vector<double>{0, 0.5, 1, 1.5}));
  EXPECT_EQ(roundTicks(2.1, 4.9, 3), (std::vector<double>{3, 4}));
  EXPECT_EQ(roundTicks(-1, 1, 5), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
  EXPECT_TRUE(roundTicks(1, 1, 5).empty());
  for (const double scale : {1e-9, 3e-4, 7.0, 2e8}) {
    const auto ticks = roundTicks(0.1 * scale, scale, 6);
    EXPECT_GE(ticks.size(), 2u);
    EXPECT_LE(ticks.size(), 6u);
    for (const double t : ticks) EXPECT_TRUE(t >= 0.0999999 * scale && t <= 1.0000001 * scale);
  }
}

Style speedStyle(int width, int height) {
  Style style = plainStyle(width, height);
  style.overlay.legend = true;
  style.grains.by = ColourBy::speed;
  return style;
}

TEST(Legend, ShowsTheColoursOfTheMap) {
  for (const ColourMap map : {ColourMap::viridis, ColourMap::cividis, ColourMap::batlow, ColourMap::vik}) {
    Style style = speedStyle(640, 360);
    style.grains.map = map;
    style.grains.range = Range{0, 1};
    if (map == ColourMap::vik) style.overlay.legendPlace = LegendPlace::topRight;
    const Image image = Renderer(style, {}).draw({});
    const BarPlace bar = legendBar(640, 360, style.overlay.legendPlace);
    for (int k = 0; k < bar.width; ++k) {
      const Colour expected = mapped(map, (k + 0.5) / bar.width);
      for (const int y : {bar.y, bar.y + bar.height - 1}) {
        const std::uint8_t* p = image.pixel(bar.x + k, y);
        ASSERT_EQ((Colour{p[0], p[1], p[2]}), expected) << k;
      }
    }
  }
}

TEST(Legend, LiesWithinThePicture) {
  for (const auto& [width, height] : {std::pair(1280, 720), {320, 180}, {200, 400}, {64, 48}, {1080, 1920}}) {
    const BarPlace bar = legendBar(width, height), top = legendBar(width, height, LegendPlace::topRight);
    for (const BarPlace& each : {bar, top}) {
      EXPECT_GT(each.x, 0);
      EXPECT_GT(each.y, 0);
      EXPECT_LT(each.x + each.width, width);
      EXPECT_LT(each.y + each.height, height);
    }
    if (height >= 180) {
      EXPECT_LT(top.y + top.height, height / 4);
    }
  }
}

// A name that is longer than the bar of a tall picture does not run out of it.
TEST(Legend, NameEndsWithinTheMargin) {
  Style style = speedStyle(240, 400);
  style.grains.by = ColourBy::angularVelocity;
  style.grains.range = Range{0, 1};
  const Image with = Renderer(style, {}).draw({});
  style.overlay.legend = false;
  const Image without = Renderer(style, {}).draw({});
  const BarPlace bar = legendBar(240, 400);
  int before = 0;
  for (int y = 0; y < bar.y - 2; ++y) {
    for (int x = 0; x < 240; ++x) {
      if (std::equal(with.pixel(x, y), with.pixel(x, y) + 3, without.pixel(x, y))) continue;
      EXPECT_LT(x, 230);
      before += x < bar.x - 3;
    }
  }
  EXPECT_GT(before, 10) << "the name is longer than the bar";
}

TEST(Legend, SaysWhenItsRangeIsThatOfOneFrame) {
  Snapshot snapshot;
  addGrain(snapshot, Vec3::Zero(), 0.1);
  snapshot.velocity[0] = {0.9, 0, 0};  // rounded up, the frame's own range is 0 to 1
  Style style = speedStyle(640, 360);
  const Image own = Renderer(style, {}).draw(snapshot);
  style.grains.range = Range{0, 1};
  const Image fixed = Renderer(style, {}).draw(snapshot);
  int differing = 0;
  const BarPlace bar = legendBar(640, 360);
  for (int y = 0; y < 360; ++y) {
    for (int x = 0; x < 640; ++x) {
      if (std::equal(own.pixel(x, y), own.pixel(x, y) + 3, fixed.pixel(x, y))) continue;
      ++differing;
      EXPECT_LT(y, bar.y) << "only the words above the bar";
    }
  }
  EXPECT_GT(differing, 100);
}

TEST(Legend, GrainsHaveTheColourTheLegendSays) {
  Snapshot snapshot;
  addGrain(snapshot, Vec3(-1, 0, 0), 0.5);
  addGrain(snapshot, Vec3(1, 0, 0), 0.5);
  snapshot.velocity[1] = {0, 3, 4};  // 5 m/s
  Grains grains;
  grains.by = ColourBy::speed;
  grains.range = Range{0, 10};
  const GrainColours colours = grainColours(grains, snapshot);
  EXPECT_EQ(colours.colours[0], mapped(ColourMap::viridis, 0));
  EXPECT_EQ(colours.colours[1], mapped(ColourMap::viridis, 0.5));
  ASSERT_TRUE(colours.legend);
  EXPECT_TRUE(colours.legend->fixed);
  EXPECT_EQ(colours.legend->quantity, "speed");
  EXPECT_EQ(colours.legend->unit, "m/s");
}

TEST(Legend, ChoosesUnitsThatReadWell) {
  Snapshot snapshot;
  addGrain(snapshot, Vec3::Zero(), 0.002);
  addGrain(snapshot, Vec3::Zero(), 0.005);
  Grains grains;
  grains.by = ColourBy::radius;
  const GrainColours colours = grainColours(grains, snapshot);
  EXPECT_EQ(colours.legend->unit, "mm");
  EXPECT_EQ(colours.legend->range, (Range{0.002, 0.005}));
  EXPECT_FALSE(colours.legend->fixed);
  EXPECT_DOUBLE_EQ(colours.legend->scale, 1e-3);
}

TEST(Legend, MaterialsAndPlainColoursHaveNone) {
  Snapshot snapshot;
  addGrain(snapshot, Vec3::Zero(), 1, 1);
  Grains grains;
  grains.materials = {{1, 2, 3}};
  const GrainColours colours = grainColours(grains, snapshot);
  EXPECT_FALSE(colours.legend);
  EXPECT_EQ(colours.colours[0], materialColour(1)) << "the palette continues the list";
}

TEST(Overlay, WordsAreLegibleOnDarkAndLight) {
  for (const std::uint8_t tone : {std::uint8_t{0}, std::uint8_t{255}}) {
    Style style = plainStyle(320, 180);
    style.background = {{tone, tone, tone}, {tone, tone, tone}};
    style.overlay.title = "TITLE";
    const Image image = Renderer(style, {}).draw({});
    int strongest = 0;
    for (const auto byte : image.rgb) strongest = std::max(strongest, std::abs(int{byte} - int{tone}));
    EXPECT_GT(strongest, 180);
  }
}

}  // namespace
}  // namespace tsubu::render
