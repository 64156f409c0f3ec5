#include "io/png_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>

#include "core/error.h"
#include "core/random.h"

namespace tsubu::io {
namespace {

namespace fs = std::filesystem;

/// A directory of its own for each test, gone afterwards.
class PngFile : public testing::Test {
 protected:
  void SetUp() override {
    directory_ = fs::temp_directory_path() / ("tsubu_png_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(directory_);
    fs::create_directories(directory_);
  }
  void TearDown() override { fs::remove_all(directory_); }

  fs::path directory_;
};

Image noise(int width, int height) {
  Image image(width, height);
  Random random(1, 2);
  for (auto& byte : image.rgb) byte = static_cast<std::uint8_t>(random.bits() & 255);
  return image;
}

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string messageOf(const auto& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::files);
    return error.what();
  }
  return "no error";
}

TEST_F(PngFile, WhatIsWrittenIsReadBack) {
  const Image image = noise(37, 23);  // odd, so that a wrong row length shows
  writePng(directory_ / "a.png", image);
  const PngPicture read = readPng(directory_ / "a.png");
  EXPECT_EQ(read.image.width, 37);
  EXPECT_EQ(read.image.height, 23);
  EXPECT_EQ(read.image.rgb, image.rgb);
  EXPECT_TRUE(read.text.empty());
}

TEST_F(PngFile, TextsTravelWithThePicture) {
  const PngText text{{"renderer", "llvmpipe"}, {"unit", "5 µm² at 30°"}, {"scene", std::string(5000, 'x') + "µ\nend"}, {"empty", ""}};
  writePng(directory_ / "a.png", noise(4, 4), text);
  EXPECT_EQ(readPng(directory_ / "a.png").text, text);
}

TEST_F(PngFile, LongTextsAreCompressedInternationalText) {
  writePng(directory_ / "a.png", noise(1, 1), {{"scene", std::string(100000, 'x')}});
  const std::string bytes = contents(directory_ / "a.png");
  EXPECT_NE(bytes.find("iTXtscene"), std::string::npos);
  EXPECT_LT(bytes.size(), 5000u);
}

TEST_F(PngFile, SaysThatItsColoursAreSrgb) {
  writePng(directory_ / "a.png", noise(1, 1));
  const std::string bytes = contents(directory_ / "a.png");
  EXPECT_NE(bytes.find("sRGB"), std::string::npos);
  EXPECT_NE(bytes.find("gAMA"), std::string::npos);
}

TEST_F(PngFile, TheSamePictureGivesTheSameBytes) {
  writePng(directory_ / "a.png", noise(50, 40), {{"a", "b"}});
  writePng(directory_ / "b.png", noise(50, 40), {{"a", "b"}});
  EXPECT_EQ(contents(directory_ / "a.png"), contents(directory_ / "b.png"));
}

TEST_F(PngFile, ReplacesAFileAndLeavesNothingElseBehind) {
  writePng(directory_ / "a.png", noise(4, 4));
  writePng(directory_ / "a.png", noise(8, 8));
  EXPECT_EQ(readPng(directory_ / "a.png").image.width, 8);
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()), 1);
}

TEST_F(PngFile, NamesTheFileAndTheReasonWhenItCannotWrite) {
  const std::string message = messageOf([&] { writePng(directory_ / "missing" / "a.png", noise(2, 2)); });
  EXPECT_NE(message.find("missing/a.png"), std::string::npos) << message;
  EXPECT_NE(message.find("cannot be written: No such file or directory."), std::string::npos) << message;
}

TEST_F(PngFile, ADirectoryInTheWayLeavesNoPartialFile) {
  fs::create_directories(directory_ / "a.png" / "inside");
  EXPECT_NE(messageOf([&] { writePng(directory_ / "a.png", noise(2, 2)); }).find("cannot be written"), std::string::npos);
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()), 1);
}

TEST_F(PngFile, RefusesPicturesWithoutPixelsAndBadKeywords) {
  EXPECT_NE(messageOf([&] { writePng(directory_ / "a.png", Image()); }).find("no pixels"), std::string::npos);
  EXPECT_NE(messageOf([&] { writePng(directory_ / "a.png", noise(1, 1), {{"", "x"}}); }).find("keyword"), std::string::npos);
  const std::string longKey(80, 'k');
  EXPECT_NE(messageOf([&] { writePng(directory_ / "a.png", noise(1, 1), {{longKey, "x"}}); }).find("keyword"), std::string::npos);
  EXPECT_FALSE(fs::exists(directory_ / "a.png"));
}

TEST_F(PngFile, NamesTheReasonWhenItCannotRead) {
  EXPECT_NE(messageOf([&] { readPng(directory_ / "none.png"); }).find("cannot be read: No such file"), std::string::npos);
  std::ofstream(directory_ / "text.png") << "this is not a picture";
  EXPECT_NE(messageOf([&] { readPng(directory_ / "text.png"); }).find("it is not a PNG file"), std::string::npos);
  writePng(directory_ / "whole.png", noise(20, 20));
  const std::string bytes = contents(directory_ / "whole.png");
  std::ofstream(directory_ / "half.png", std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  EXPECT_NE(messageOf([&] { readPng(directory_ / "half.png"); }).find("the file ends too early"), std::string::npos);
  std::string damaged = bytes;
  damaged[bytes.size() / 2] = static_cast<char>(damaged[bytes.size() / 2] ^ 0x55);
  std::ofstream(directory_ / "damaged.png", std::ios::binary) << damaged;
  EXPECT_NE(messageOf([&] { readPng(directory_ / "damaged.png"); }).find("cannot be read"), std::string::npos);
}

}  // namespace
}  // namespace tsubu::io
