#include "io/csv_file.h"

#include <cstdio>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"

namespace tsubu::io {
namespace {

TEST(CsvFile, HeaderRowsCommentsAndBlanks) {
  CsvReader table("\xEF\xBB\xBF# made by hand\n x , y,\"radius\"\r\n\n1, 2 ,3\r\n# end\n4,,6", "t.csv");
  EXPECT_EQ(table.columns(), (std::vector<std::string>{"x", "y", "radius"}));
  CsvReader::Row row;
  ASSERT_TRUE(table.next(row));
  EXPECT_EQ(row.fields, (std::vector<std::string_view>{"1", "2", "3"}));
  EXPECT_EQ(row.line, 4);
  ASSERT_TRUE(table.next(row));
  EXPECT_EQ(row.fields, (std::vector<std::string_view>{"4", "", "6"}));
  EXPECT_EQ(row.line, 6);
  EXPECT_FALSE(table.next(row));
}

TEST(CsvFile, EmptyIsEmpty) {
  for (const char* text : {"", "\n# nothing\n", "\n\n"}) {
    CsvReader table(text, "t.csv");
    CsvReader::Row row;
    EXPECT_TRUE(table.columns().empty());
    EXPECT_FALSE(table.next(row));
  }
}

TEST(CsvFile, RowsMustFitTheHeader) {
  CsvReader table("a,b\n1,2\n1,2,3\n", "t.csv");
  CsvReader::Row row;
  EXPECT_TRUE(table.next(row));
  try {
    table.next(row);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "t.csv:3:1: This row has 3 fields; the header names 2 columns.");
  }
}

TEST(CsvFile, ComesInPiecesAndIsTheSame) {
  std::string text = "a,b\n";
  for (int k = 0; text.size() < 5 << 19; ++k) text += std::to_string(k) + "," + std::string(static_cast<std::size_t>(k % 37), '7') + "\n";
  text += "1,2,";  // no end of line, and a field too many
  const std::string path = ::testing::TempDir() + "pieces.csv";
  std::ofstream(path, std::ios::binary) << text;
  CsvReader whole(text, "t.csv"), pieces = CsvReader::fromFile(path);
  EXPECT_EQ(pieces.columns(), whole.columns());
  CsvReader::Row one, other;
  int rows = 0;
  const auto next = [](CsvReader& table, CsvReader::Row& row) {
    try {
      return table.next(row);
    } catch (const Error&) {
      return false;
    }
  };
  while (next(whole, one)) {
    ASSERT_TRUE(next(pieces, other)) << rows;
    ASSERT_EQ(one.fields, other.fields) << rows;
    ASSERT_EQ(one.line, other.line);
    ++rows;
  }
  EXPECT_GT(rows, 50'000);
  EXPECT_FALSE(next(pieces, other));
  EXPECT_EQ(other.line, one.line);
  std::remove(path.c_str());
}

TEST(CsvFile, UnreadableFilesAreErrorsOfFiles) {
  try {
    CsvReader::fromFile("/no/such.csv");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::files);
  }
}

}  // namespace
}  // namespace tsubu::io
