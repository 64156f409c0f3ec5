#include "io/csv_file.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace tsubu::io {
namespace {

TEST(CsvFile, HeaderRowsCommentsAndBlanks) {
  const CsvTable table = parseCsv("\xEF\xBB\xBF# made by hand\n x , y,\"radius\"\r\n\n1, 2 ,3\r\n# end\n4,,6", "t.csv");
  EXPECT_EQ(table.columns, (std::vector<std::string>{"x", "y", "radius"}));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0].fields, (std::vector<std::string>{"1", "2", "3"}));
  EXPECT_EQ(table.rows[0].line, 4);
  EXPECT_EQ(table.rows[1].fields, (std::vector<std::string>{"4", "", "6"}));
  EXPECT_EQ(table.rows[1].line, 6);
}

TEST(CsvFile, EmptyIsEmpty) {
  EXPECT_TRUE(parseCsv("", "t.csv").columns.empty());
  EXPECT_TRUE(parseCsv("\n# nothing\n", "t.csv").columns.empty());
}

TEST(CsvFile, RowsMustFitTheHeader) {
  try {
    parseCsv("a,b\n1,2\n1,2,3\n", "t.csv");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "t.csv:3:1: This row has 3 fields; the header names 2 columns.");
  }
}

TEST(CsvFile, UnreadableFilesAreErrorsOfFiles) {
  try {
    readCsv("/no/such.csv");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::files);
  }
}

}  // namespace
}  // namespace tsubu::io
