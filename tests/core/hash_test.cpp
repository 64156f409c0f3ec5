#include "core/hash.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <set>

namespace tsubu {
namespace {

std::uint64_t hashOf(std::initializer_list<double> values) {
  Hash hash;
  for (const double value : values) hash.add(value);
  return hash.value();
}

// Outputs 1 to 3 of the published splitmix64 generator with seed 0: <https://prng.di.unimi.it/splitmix64.c>. Its n-th output
// is the finaliser applied to n times the golden gamma, and mix64(x) is that finaliser applied to x + gamma.
TEST(Mix64, IsTheSplitmix64Finaliser) {
  constexpr std::uint64_t gamma = 0x9e3779b97f4a7c15ULL;
  EXPECT_EQ(mix64(0), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(mix64(gamma), 0x6e789e6aa1b965f4ULL);
  EXPECT_EQ(mix64(2 * gamma), 0x06c45d188009454fULL);
}

// A good mixer flips half of the 64 output bits when one input bit flips. Over 64 x 64 single flips the mean is 32 with a
// standard error of 4 / 64 = 1/16: five of them are allowed.
TEST(Mix64, OneBitChangesHalfOfTheBits) {
  int flips = 0;
  for (int base = 0; base < 64; ++base) {
    const std::uint64_t word = mix64(static_cast<std::uint64_t>(base));
    for (int bit = 0; bit < 64; ++bit) flips += std::popcount(mix64(word) ^ mix64(word ^ (1ULL << bit)));
  }
  EXPECT_NEAR(flips / 4096.0, 32.0, 5.0 / 16.0);
}

TEST(Hash, IsAFunctionOfWhatWasAdded) { EXPECT_EQ(hashOf({1.0, 2.0, 3.0}), hashOf({1.0, 2.0, 3.0})); }

TEST(Hash, SeesTheOrder) { EXPECT_NE(hashOf({1.0, 2.0}), hashOf({2.0, 1.0})); }

TEST(Hash, SeesTheNumberOfWords) {
  std::set<std::uint64_t> values{hashOf({}), hashOf({0.0}), hashOf({0.0, 0.0}), hashOf({0.0, 0.0, 0.0})};
  EXPECT_EQ(values.size(), 4u);
}

TEST(Hash, SeesTheLastBitOfANumber) { EXPECT_NE(hashOf({1.0}), hashOf({std::nextafter(1.0, 2.0)})); }

TEST(Hash, TellsTheTwoZerosApart) { EXPECT_NE(hashOf({0.0}), hashOf({-0.0})); }

TEST(Hash, EqualBitsOfDoubleAndWordAreTheSame) {
  Hash asDouble, asWord;
  asDouble.add(-1.5);
  asWord.add(std::bit_cast<std::uint64_t>(-1.5));
  EXPECT_EQ(asDouble.value(), asWord.value());
}

TEST(Hash, TextIsSixteenHexadecimalDigits) {
  const std::string digits = "0123456789abcdef";
  for (int i = 0; i < 100; ++i) {  // one in sixteen starts with a zero that must not get lost
    Hash hash;
    hash.add(static_cast<std::uint64_t>(i));
    const std::string text = hash.text();
    ASSERT_EQ(text.size(), 16u);
    std::uint64_t value = 0;
    for (const char c : text) {
      const std::size_t digit = digits.find(c);
      ASSERT_NE(digit, std::string::npos) << text;
      value = value * 16 + digit;
    }
    EXPECT_EQ(value, hash.value());
  }
}

}  // namespace
}  // namespace tsubu
