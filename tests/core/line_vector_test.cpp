#include "core/line_vector.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace tsubu {
namespace {

template <class T>
bool atLine(const LineVector<T>& items) {
  return reinterpret_cast<std::uintptr_t>(items.data()) % cacheLine == 0;
}

TEST(LineVector, BeginsAtALineHoweverItGrows) {
  LineVector<double> wide;
  LineVector<float> narrow{1, 2, 3};
  for (int k = 0; k < 1000; ++k) {
    wide.push_back(k);
    narrow.push_back(static_cast<float>(k));
    ASSERT_TRUE(atLine(wide) && atLine(narrow)) << k;
  }
  const LineVector<double> copy = wide;
  EXPECT_TRUE(atLine(copy));
  EXPECT_EQ(copy, wide);
}

TEST(LineVector, WholeLinesHoldEightDoublesOrSixteenFloats) {
  EXPECT_EQ(wholeLines<double>(0), 0U);
  EXPECT_EQ(wholeLines<double>(1), 8U);
  EXPECT_EQ(wholeLines<double>(8), 8U);
  EXPECT_EQ(wholeLines<double>(9), 16U);
  EXPECT_EQ(wholeLines<float>(17), 32U);
}

}  // namespace
}  // namespace tsubu
