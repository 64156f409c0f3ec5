#include "io/csv_file.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/text_file.h"

namespace tsubu::io {

namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\"";  // spreadsheets like to quote
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> fields;
  for (;;) {
    const auto comma = line.find(',');
    fields.emplace_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::string_view nextLine(std::string_view& text) {
  const auto end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

}  // namespace

CsvTable parseCsv(std::string_view text, const std::string& name) {
  CsvTable table;
  table.file = name;
  constexpr std::string_view byteOrderMark = "\xEF\xBB\xBF";
  if (text.substr(0, byteOrderMark.size()) == byteOrderMark) text.remove_prefix(byteOrderMark.size());
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = trimmed(nextLine(text));
    if (line.empty() || line.front() == '#') continue;
    std::vector<std::string> fields = split(line);
    if (table.columns.empty()) {
      table.columns = std::move(fields);
    } else if (fields.size() != table.columns.size()) {
      throw Error(ErrorKind::scene,
                  {{{name, number, 1},
                    fmt::format("This row has {} fields; the header names {} columns.", fields.size(), table.columns.size()),
                    {}}});
    } else {
      table.rows.push_back({number, std::move(fields)});
    }
  }
  return table;
}

CsvTable readCsv(const std::string& path) { return parseCsv(readTextFile(path, "file"), path); }

}  // namespace tsubu::io
