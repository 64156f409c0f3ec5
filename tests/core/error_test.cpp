#include "core/error.h"

#include <gtest/gtest.h>

namespace tsubu {
namespace {

TEST(SourcePosition, IsPrintedAsCompilersDo) {
  EXPECT_EQ(toString(SourcePosition{"scenes/hopper.toml", 12, 5}), "scenes/hopper.toml:12:5");
}

TEST(SourcePosition, NamesTheFileAloneWhenThereIsNoLine) {
  EXPECT_EQ(toString(SourcePosition{"scenes/hopper.toml", 0, 0}), "scenes/hopper.toml");
}

TEST(Diagnostic, PutsPositionMessageAndHintInOneLine) {
  const Diagnostic diagnostic{{"a.toml", 3, 7}, "'radus' is not a key of [grains].", "did you mean 'radius'?"};
  EXPECT_EQ(toString(diagnostic), "a.toml:3:7: 'radus' is not a key of [grains]. (did you mean 'radius'?)");
}

TEST(Diagnostic, LeavesOutWhatItDoesNotHave) {
  EXPECT_EQ(toString(Diagnostic{{}, "There are no grains.", ""}), "There are no grains.");
  EXPECT_EQ(toString(Diagnostic{{}, "There are no grains.", "add [[grains]]"}), "There are no grains. (add [[grains]])");
  EXPECT_EQ(toString(Diagnostic{{"a.toml", 0, 0}, "There are no grains.", ""}), "a.toml: There are no grains.");
}

TEST(Error, SaysAllComplaintsOneToALine) {
  const Error error(ErrorKind::scene, {{{"a.toml", 1, 2}, "One.", ""}, {{"a.toml", 3, 4}, "Two.", "mend it"}});
  EXPECT_STREQ(error.what(), "a.toml:1:2: One.\na.toml:3:4: Two. (mend it)");
  EXPECT_EQ(error.kind(), ErrorKind::scene);
  ASSERT_EQ(error.diagnostics().size(), 2u);
  EXPECT_EQ(error.diagnostics()[1].position, (SourcePosition{"a.toml", 3, 4}));
}

TEST(Error, CanBeOneSentenceWithoutAPlace) {
  const Error error(ErrorKind::files, "Cannot write out/ledger.csv.", "is the disk full?");
  EXPECT_STREQ(error.what(), "Cannot write out/ledger.csv. (is the disk full?)");
  ASSERT_EQ(error.diagnostics().size(), 1u);
  EXPECT_EQ(error.diagnostics()[0].hint, "is the disk full?");
}

// The exit codes are documented and scripts depend on them.
TEST(Error, KindsAreTheExitCodesOfTheProgram) {
  EXPECT_EQ(static_cast<int>(ErrorKind::simulation), 1);
  EXPECT_EQ(static_cast<int>(ErrorKind::scene), 2);
  EXPECT_EQ(static_cast<int>(ErrorKind::files), 3);
}

}  // namespace
}  // namespace tsubu
