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

void split(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const auto comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

CsvReader CsvReader::fromFile(const std::string& path) { return CsvReader(readTextFile(path, "file"), path); }

CsvReader::CsvReader(std::string text, std::string name) : text_(std::move(text)), name_(std::move(name)) {
  constexpr std::string_view byteOrderMark = "\xEF\xBB\xBF";
  if (text_.starts_with(byteOrderMark)) at_ = byteOrderMark.size();
  Row header;
  if (nextLine(header)) columns_.assign(header.fields.begin(), header.fields.end());
}

bool CsvReader::nextLine(Row& row) {
  while (at_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view line = trimmed(std::string_view(text_).substr(at_, end - at_));
    at_ = end + 1;
    ++line_;
    if (line.empty() || line.front() == '#') continue;
    row.line = line_;
    split(line, row.fields);
    return true;
  }
  return false;
}

bool CsvReader::next(Row& row) {
  if (!nextLine(row)) return false;
  if (row.fields.size() == columns_.size()) return true;
  const std::string sentence = fmt::format("This row has {} fields; the header names {} columns.", row.fields.size(), columns_.size());
  throw Error(ErrorKind::scene, {{{name_, row.line, 1}, sentence, {}}});
}

}  // namespace tsubu::io
