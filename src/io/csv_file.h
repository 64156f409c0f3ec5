#pragma once
// Tables of numbers in text files.

#include <string>
#include <string_view>
#include <vector>

namespace tsubu::io {

/// A comma-separated file with a line of column names on top. Lines that are empty or begin with # do not count.
struct CsvTable {
  struct Row {
    int line = 0;                     ///< in the file, from 1: for messages
    std::vector<std::string> fields;  ///< as many as there are columns, blanks trimmed
  };
  std::string file;
  std::vector<std::string> columns;
  std::vector<Row> rows;
};

/// Reads a file. Throws Error(files) when it cannot be read, Error(scene) with file and line when a row has not as many fields as the
/// header.
CsvTable readCsv(const std::string& path);
/// The same from a text; `name` stands for the file in messages.
CsvTable parseCsv(std::string_view text, const std::string& name);

}  // namespace tsubu::io
