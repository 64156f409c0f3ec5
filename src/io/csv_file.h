#pragma once
// Tables in text files, row by row: of a table of ten million grains only a piece is in memory.

#include <istream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tsubu::io {

/// A comma-separated table with a line of column names on top. Lines that are empty or begin with # do not count; blanks and quotes
/// around fields are taken off (there is no way to quote a comma).
class CsvReader {
 public:
  struct Row {
    int line = 0;                          ///< in the file, from 1: for messages
    std::vector<std::string_view> fields;  ///< as many as there are columns; valid until the next row
  };

  /// Throws Error(files) when the file cannot be read.
  static CsvReader fromFile(const std::string& path);
  /// `name` stands for the file in messages.
  CsvReader(std::string text, std::string name);
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  const std::string& name() const { return name_; }
  /// Empty when the file has no line of names.
  const std::vector<std::string>& columns() const { return columns_; }

  /// Puts the next row into `row`, or returns false. Throws Error(scene) with file and line when it has not as many fields as columns.
  bool next(Row& row);

 private:
  CsvReader(std::unique_ptr<std::istream> rest, std::string name);
  void readHeader();
  bool nextLine(Row& row);
  /// Where the line at `at_` ends; brings in more of the file as needed.
  std::size_t endOfLine();
  void readOn();

  std::unique_ptr<std::istream> rest_;  // of the file; null when all of it is in `text_`
  std::string text_, name_;
  std::size_t at_ = 0;
  int line_ = 0;
  std::vector<std::string> columns_;
};

}  // namespace tsubu::io
