#include "io/csv_file.h"

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
