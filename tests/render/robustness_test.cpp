// Pictures of nothing, of much, and of nonsense.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>

#include "core/error.h"
#include "core/random.h"
#include "scene_helpers.h"

namespace tsubu::render {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Robustness, APictureOfNothingIsBackground) {
  for (const Quality quality : {Quality::draft, Quality::normal, Quality::fine}) {
    Style style;
    style.picture = {64, 36, quality};
    style.background = {{9, 8, 7}, {9, 8, 7}};
    style.overlay.time = false;
    const Image image = Renderer(style, {}).draw({});
    EXPECT_EQ(image.rgb.size(), 64u * 36 * 3);
    EXPECT_EQ(image.pixel(20, 20)[0], 9);
  }
}

TEST(Robustness, GrainsThatAreNotNumbersAreLeftOut) {
  Style style = plainStyle(64, 48);
  style.light.shadows = style.light.ambientOcclusion = true;
  Snapshot good;
  addGrain(good, Vec3(0.5, 0, 0), 0.8);
  Snapshot bad = good;
  addGrain(bad, Vec3(nan, 0, 0), 1);
  addGrain(bad, Vec3(0, infinity, 0), 1);
  addGrain(bad, Vec3(0, 0, 0), nan);
  addGrain(bad, Vec3(0, 0, 0), -1);
  addGrain(bad, Vec3(0, 0, 0), 0);
  Renderer renderer(style, {});
  EXPECT_EQ(renderer.draw(bad).rgb, renderer.draw(good).rgb);
  good.orientation[0] = Quat(nan, nan, nan, nan);
  style.grains.pattern = Pattern::stripes;
  EXPECT_NO_THROW(Renderer(style, {}).draw(good));
}

TEST(Robustness, HugeNumbersAndTinyGrainsDoNoHarm) {
  Style style = plainStyle(64, 48);
  style.light.shadows = style.light.ambientOcclusion = true;
  Snapshot snapshot;
  addGrain(snapshot, Vec3(0, 1e200, 0), 1);
  addGrain(snapshot, Vec3(0, 1e12, 0), 1e12 - 11);  // its surface passes before the eye
  addGrain(snapshot, Vec3(0, 0, 0), 1e-12);
  addGrain(snapshot, Vec3(0, 0, 0), 1e-300);
  EXPECT_NO_THROW(Renderer(style, {}).draw(snapshot));
}

TEST(Robustness, FromWithinAGrainOneLooksOut) {
  Snapshot snapshot;
  addGrain(snapshot, Vec3(0, -10, 0), 3, 1);  // around the eye
  addGrain(snapshot, Vec3(0, 0, 0), 1, 0);
  const Image image = Renderer(plainStyle(), {}).draw(snapshot);
  EXPECT_TRUE(isRed(image.pixel(80, 60)));
  EXPECT_TRUE(isBackground(image.pixel(5, 5)));
}

TEST(Robustness, AHundredThousandGrains) {
  Style style = plainStyle(320, 180);
  style.light.shadows = style.light.ambientOcclusion = true;
  Random random(3, 1);
  Snapshot snapshot;
  for (int k = 0; k < 100000; ++k) {
    addGrain(snapshot, Vec3(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-2, 2)), random.uniform(0.005, 0.05));
  }
  const Image image = Renderer(style, {}, Box(Vec3(-3, -3, -2), Vec3(3, 3, 2))).draw(snapshot);
  EXPECT_FALSE(isBackground(image.pixel(160, 90)));
}

TEST(Robustness, APictureDoesNotDependOnThePicturesBefore) {
  Style style = plainStyle(100, 80);
  style.light.shadows = style.light.ambientOcclusion = true;
  Snapshot one, two;
  addGrain(one, Vec3(0.5, 0, 0), 0.8);
  for (int k = 0; k < 50; ++k) addGrain(two, Vec3(-2 + 0.1 * k, 0.1 * k, 1), 0.3, k % 2);
  Renderer renderer(style, {}), fresh(style, {});
  const Image first = renderer.draw(one);
  renderer.draw(two);
  EXPECT_EQ(renderer.draw(one).rgb, first.rgb);
  EXPECT_EQ(fresh.draw(two).rgb, renderer.draw(two).rgb);
}

TEST(Robustness, TheOrderOfTheGrainsDoesNotMatter) {
  Style style = plainStyle(120, 90);
  style.light.shadows = style.light.ambientOcclusion = true;
  Random random(5, 1);
  std::vector<Vec3> places;
  for (int k = 0; k < 300; ++k) places.push_back({random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)});
  Snapshot forward, backward;
  for (const Vec3& p : places) addGrain(forward, p, 0.2);
  for (auto p = places.rbegin(); p != places.rend(); ++p) addGrain(backward, *p, 0.2);
  Renderer renderer(style, {});
  const Image a = renderer.draw(forward), b = renderer.draw(backward);
  int worst = 0;  // the sky's share is a product in the order of the neighbours: it may round differently, by a level
  for (std::size_t k = 0; k < a.rgb.size(); ++k) worst = std::max(worst, std::abs(int{a.rgb[k]} - int{b.rgb[k]}));
  EXPECT_LE(worst, 1);
}

TEST(Robustness, TheNumberOfThreadsDoesNotChangeAByte) {
  // llvmpipe reads LP_NUM_THREADS when its first context is made, so each number needs a process of its own.
  std::string reference;
  for (const char* threads : {"0", "1", "2", "5"}) {
    const std::string file = testing::TempDir() + "tsubu_threads_" + threads + ".rgb";
    const std::string command = std::string("LP_NUM_THREADS=") + threads + " '" + TSUBU_DRAW_HEAP + "' '" + file + "'";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_EQ(bytes.size(), 320u * 180 * 3);
    if (reference.empty()) reference = bytes;
    EXPECT_EQ(bytes, reference) << threads << " threads";
    std::remove(file.c_str());
  }
}

TEST(Robustness, StylesThatCannotBeDrawnAreRefusedWithAllTheirFaults) {
  Style style;
  style.picture.width = 3;
  style.light.from = Vec3::Zero();
  style.grains.range = Range{2, 1};
  style.camera = KeyFrameCamera{};
  try {
    Renderer renderer(style, {});
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::scene);
    EXPECT_EQ(error.diagnostics().size(), 4u) << error.what();
  }
}

TEST(Robustness, PicturesLargerThanTheDriverCanHoldAreRefused) {
  Style style;
  style.picture = {8192, 16, Quality::fine};
  EXPECT_THROW(Renderer(style, {}), Error);
}

TEST(Robustness, ColoursThatTheSnapshotCannotShowAreRefused) {
  Style style = plainStyle();
  style.grains.by = ColourBy::force;
  Snapshot snapshot;
  addGrain(snapshot, Vec3::Zero(), 1);
  snapshot.load.clear();
  Renderer renderer(style, {});
  EXPECT_THROW(renderer.draw(snapshot), Error);
}

TEST(Robustness, TheDescriptionNamesTheRendererAndItsVersions) {
  const std::string text = Renderer(plainStyle(), {}).description();
  EXPECT_NE(text.find("LLVM"), std::string::npos) << text;
  EXPECT_NE(text.find("4.5"), std::string::npos) << text;
}

TEST(Robustness, RenderersLiveSideBySide) {
  Snapshot snapshot;
  addGrain(snapshot, Vec3::Zero(), 1);
  Renderer a(plainStyle(64, 64), {});
  const Image first = a.draw(snapshot);
  Renderer b(plainStyle(32, 32), {});
  EXPECT_EQ(b.draw(snapshot).width, 32);
  EXPECT_EQ(a.draw(snapshot).rgb, first.rgb);
  {
    Renderer passing(plainStyle(16, 16), {});
    a.draw(snapshot);  // its context is current when the other one goes
  }
  EXPECT_EQ(a.draw(snapshot).rgb, first.rgb);
  Renderer moved = std::move(a);
  EXPECT_EQ(moved.draw(snapshot).rgb, first.rgb);
}

}  // namespace
}  // namespace tsubu::render
