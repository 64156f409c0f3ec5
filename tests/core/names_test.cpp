#include "core/names.h"

#include <gtest/gtest.h>

namespace tsubu {
namespace {

const std::vector<std::string> laws = {"hooke", "hertz", "viscoelastic", "none"};

TEST(NearestName, FindsASlipOfThePen) {
  EXPECT_EQ(nearestName("herz", laws), "hertz");                 // a letter lost
  EXPECT_EQ(nearestName("hookee", laws), "hooke");               // a letter too many
  EXPECT_EQ(nearestName("hooge", laws), "hooke");                // a wrong letter
  EXPECT_EQ(nearestName("hetrz", laws), "hertz");                // two letters swapped count as one slip
  EXPECT_EQ(nearestName("viscoelsatik", laws), "viscoelastic");  // a swap and a wrong letter
}

TEST(NearestName, DoesNotCareAboutCase) { EXPECT_EQ(nearestName("HERTZ", laws), "hertz"); }

TEST(NearestName, FindsTheNameItself) { EXPECT_EQ(nearestName("none", laws), "none"); }

TEST(NearestName, DoesNotGuessWhenMoreThanAThirdIsWrong) {
  EXPECT_EQ(nearestName("mindlin", laws), std::nullopt);
  EXPECT_EQ(nearestName("hexxz", laws), std::nullopt);  // two of five letters
  EXPECT_EQ(nearestName("", laws), std::nullopt);
}

TEST(NearestName, AllowsOneSlipInAShortName) {
  EXPECT_EQ(nearestName("y", {"x"}), "x");
  EXPECT_EQ(nearestName("rg", {"r"}), "r");
  EXPECT_EQ(nearestName("ab", {"cd"}), std::nullopt);
}

TEST(NearestName, PrefersTheNearerAndThenTheEarlier) {
  EXPECT_EQ(nearestName("radius", {"radiuss", "radius"}), "radius");
  EXPECT_EQ(nearestName("radius_m", {"radius_x", "radius_a"}), "radius_x");
}

TEST(NearestName, OfNothingIsNothing) { EXPECT_EQ(nearestName("radius", {}), std::nullopt); }

TEST(ListNames, ReadsAsASentence) {
  EXPECT_EQ(listNames({}), "");
  EXPECT_EQ(listNames({"a"}), "a");
  EXPECT_EQ(listNames({"a", "b"}), "a or b");
  EXPECT_EQ(listNames({"a", "b", "c"}), "a, b or c");
}

}  // namespace
}  // namespace tsubu
