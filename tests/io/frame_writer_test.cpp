#include "io/frame_writer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/error.h"

namespace tsubu::io {
namespace {

namespace fs = std::filesystem;

class FrameWriterTest : public testing::Test {
 protected:
  void SetUp() override {
    directory_ = fs::temp_directory_path() / ("tsubu_frames_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(directory_);
    fs::create_directories(directory_);
  }
  void TearDown() override { fs::remove_all(directory_); }

  fs::path frame(int k) const { return directory_ / fmt::format("{:06}.png", k); }

  fs::path directory_;
};

/// A picture that knows its number.
Image numbered(int k) {
  Image image(200, 100);
  for (auto& byte : image.rgb) byte = static_cast<std::uint8_t>(k);
  return image;
}

TEST_F(FrameWriterTest, WritesEveryFrameWhole) {
  FrameWriter writer(3, 2);
  for (int k = 0; k < 40; ++k) writer.write(frame(k), numbered(k), {{"frame", std::to_string(k)}});
  writer.close();
  for (int k = 0; k < 40; ++k) {
    const PngPicture picture = readPng(frame(k));
    EXPECT_EQ(picture.image.rgb, numbered(k).rgb);
    EXPECT_EQ(picture.text.at("frame"), std::to_string(k));
  }
}

TEST_F(FrameWriterTest, DestructionFinishesWhatWaits) {
  {
    FrameWriter writer(1, 20);
    for (int k = 0; k < 15; ++k) writer.write(frame(k), numbered(k));
  }
  for (int k = 0; k < 15; ++k) EXPECT_EQ(readPng(frame(k)).image.rgb, numbered(k).rgb);
}

TEST_F(FrameWriterTest, TheFirstFailureReachesTheProducerOnceAndOtherFramesAreWritten) {
  FrameWriter writer(1, 1);
  writer.write(directory_ / "missing" / "a.png", numbered(1));
  std::string message;
  int handedIn = 0;
  for (int k = 0; k < 20; ++k) {
    try {
      writer.write(frame(k), numbered(k));
      ++handedIn;
    } catch (const Error& error) {
      EXPECT_TRUE(message.empty()) << "thrown twice";
      message = error.what();
    }
  }
  writer.close();
  EXPECT_NE(message.find("missing/a.png"), std::string::npos);
  EXPECT_EQ(handedIn, 19);
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()), 19);
}

TEST_F(FrameWriterTest, ClosingTellsOfAFailureNobodyHeardOf) {
  FrameWriter writer;
  writer.write(directory_ / "missing" / "a.png", numbered(1));
  EXPECT_THROW(writer.close(), Error);
  EXPECT_NO_THROW(writer.close());
  EXPECT_THROW(writer.write(frame(0), numbered(0)), std::logic_error);
}

}  // namespace
}  // namespace tsubu::io
