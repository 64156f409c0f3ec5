#include "support/image_compare.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/random.h"
#include "render/scene_helpers.h"
#include "support/golden.h"

namespace tsubu::test {
namespace {

namespace fs = std::filesystem;

/// A heap of grains of about four pixels radius at golden size; `shifted` moves one of those in front by its radius.
Image heap(bool shifted, std::uint64_t seed = 1) {
  render::Style style;
  style.picture = {320, 180, render::Quality::normal};
  style.overlay.time = false;
  Snapshot snapshot;
  Random random(seed, 1);
  for (int k = 0; k < 2000; ++k) {
    const double r = 0.03;
    render::addGrain(snapshot, Vec3(random.uniform(-1, 1), random.uniform(-0.4, 0.4), random.uniform(0, 0.6)), r);
  }
  render::addGrain(snapshot, Vec3(shifted ? 0.03 : 0, -0.5, 0.35), 0.03);
  return render::Renderer(style, {}, Box(Vec3(-1, -0.5, 0), Vec3(1, 0.5, 0.7))).draw(snapshot);
}

TEST(CompareImages, EqualPicturesAreExact) {
  const Image image = heap(false);
  const Comparison c = compareImages(image, image);
  EXPECT_EQ(c.tier, Tier::exact);
  EXPECT_EQ(c.worstLevels, 0);
  EXPECT_EQ(c.ssim, 1);
}

TEST(CompareImages, AFewSmallDifferencesAreTight) {
  const Image image = heap(false);
  Image other = image;
  for (std::size_t k = 0; k < 50; ++k) other.rgb[k * 3000] = static_cast<std::uint8_t>(other.rgb[k * 3000] ^ 2);  // 50 of 57600 pixels
  EXPECT_EQ(compareImages(image, other).tier, Tier::tight);
  other.rgb[100] = static_cast<std::uint8_t>(other.rgb[100] > 100 ? other.rgb[100] - 4 : other.rgb[100] + 4);
  EXPECT_EQ(compareImages(image, other).worstLevels, 4);
  EXPECT_EQ(compareImages(image, other).tier, Tier::perceptual);
}

TEST(CompareImages, AnotherRoundingOfEverythingIsPerceptual) {
  const Image image = heap(false);
  Image other = image;
  Random random(2, 2);
  for (auto& byte : other.rgb) byte = static_cast<std::uint8_t>(std::clamp<int>(byte + static_cast<int>(random.bits() % 3) - 1, 0, 255));
  const Comparison c = compareImages(image, other);
  EXPECT_EQ(c.tier, Tier::perceptual) << c.text();
}

TEST(CompareImages, ASampleOnTheOtherSideOfASilhouetteIsPerceptual) {
  const Image image = heap(false);
  Image other = image;
  for (int c = 0; c < 3; ++c) other.pixel(160, 60)[c] = static_cast<std::uint8_t>(0.75 * other.pixel(160, 60)[c]);
  const Comparison c = compareImages(image, other);
  EXPECT_EQ(c.tier, Tier::perceptual) << c.text();
}

TEST(CompareImages, OneGrainThatMovedByItsRadiusIsDifferent) {
  const Comparison c = compareImages(heap(false), heap(true));
  EXPECT_EQ(c.tier, Tier::different) << c.text();
}

TEST(CompareImages, OtherGrainsAndOtherSizesAreDifferent) {
  EXPECT_EQ(compareImages(heap(false), heap(false, 9)).tier, Tier::different);
  const Comparison c = compareImages(Image(4, 4), Image(4, 5));
  EXPECT_EQ(c.tier, Tier::different);
  EXPECT_FALSE(c.sameSize);
}

TEST(CompareImages, AShiftOfOnePixelAndAnotherTintAreDifferent) {
  const Image image = heap(false);
  Image shifted = image, tinted = image;
  for (int y = 0; y < 180; ++y) {
    for (int x = 1; x < 320; ++x) std::copy_n(image.pixel(x - 1, y), 3, shifted.pixel(x, y));
  }
  for (std::size_t k = 0; k < tinted.rgb.size(); k += 3) tinted.rgb[k] = static_cast<std::uint8_t>(0.9 * tinted.rgb[k]);
  EXPECT_EQ(compareImages(image, shifted).tier, Tier::different);
  EXPECT_EQ(compareImages(image, tinted).tier, Tier::different);
}

TEST(DifferencePicture, GlowsWhereThePicturesDiffer) {
  Image a(3, 1), b(3, 1);
  a.rgb.assign(9, 120);
  b = a;
  b.pixel(1, 0)[2] = 220;
  const Image d = differencePicture(a, b);
  EXPECT_EQ(d.pixel(0, 0)[0], d.pixel(0, 0)[1]);
  EXPECT_GT(d.pixel(1, 0)[0], 200);
}

TEST(Golden, IsExactForItsOwnRendererAndPerceptualForOthers) {
  const fs::path directory = fs::temp_directory_path() / "tsubu_golden_test";
  fs::remove_all(directory);
  fs::create_directories(directory);
  const Image image = heap(false);
  Image rounded = image;
  for (auto& byte : rounded.rgb) byte = static_cast<std::uint8_t>(byte ^ 1);
  io::writePng(directory / "heap.png", image, {{"renderer", "this one"}});
  EXPECT_TRUE(matchesGolden(directory / "heap.png", image, "this one", directory / "reports"));
  EXPECT_FALSE(fs::exists(directory / "reports"));
  EXPECT_TRUE(matchesGolden(directory / "heap.png", rounded, "another", directory / "reports"));
  EXPECT_FALSE(matchesGolden(directory / "heap.png", rounded, "this one", directory / "reports"));
  EXPECT_TRUE(fs::exists(directory / "reports" / "heap.difference.png"));
  EXPECT_FALSE(matchesGolden(directory / "heap.png", heap(true), "another", directory / "reports"));
  EXPECT_FALSE(matchesGolden(directory / "none.png", image, "this one", directory / "reports"));
  fs::remove_all(directory);
}

}  // namespace
}  // namespace tsubu::test
