#include "io/csv_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "core/error.h"

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

CsvReader CsvReader::fromFile(const std::string& path) { return CsvReader(std::make_unique<std::ifstream>(path, std::ios::binary), path); }

CsvReader::CsvReader(std::string text, std::string name) : text_(std::move(text)), name_(std::move(name)) { readHeader(); }

CsvReader::CsvReader(std::unique_ptr<std::istream> rest, std::string name) : rest_(std::move(rest)), name_(std::move(name)) {
  readOn();
  readHeader();
}

void CsvReader::readHeader() {
  constexpr std::string_view byteOrderMark = "\xEF\xBB\xBF";
  if (text_.starts_with(byteOrderMark)) at_ = byteOrderMark.size();
  Row header;
  if (nextLine(header)) columns_.assign(header.fields.begin(), header.fields.end());
}

// A file that is not there fails here, as does a folder, which opens like a file.
void CsvReader::readOn() {
  constexpr std::size_t piece = 1 << 20;
  text_.erase(0, at_);
  at_ = 0;
  const std::size_t kept = text_.size();
  text_.resize(kept + piece);
  rest_->read(text_.data() + kept, static_cast<std::streamsize>(piece));
  text_.resize(kept + static_cast<std::size_t>(rest_->gcount()));
  if (rest_->good()) return;
  if (rest_->bad() || !rest_->eof())
    throw Error(ErrorKind::files, fmt::format("The file '{}' cannot be read.", name_), "is the path right?");
  rest_.reset();
}

std::size_t CsvReader::endOfLine() {
  std::size_t end = text_.find('\n', at_);
  while (end == std::string::npos && rest_) {
    const std::size_t seen = text_.size() - at_;
    readOn();
    end = text_.find('\n', seen);
  }
  return std::min(end, text_.size());
}

bool CsvReader::nextLine(Row& row) {
  for (;;) {
    const std::size_t end = endOfLine();
    if (at_ >= text_.size()) return false;
    const std::string_view line = trimmed(std::string_view(text_).substr(at_, end - at_));
    at_ = end + 1;
    ++line_;
    if (line.empty() || line.front() == '#') continue;
    row.line = line_;
    split(line, row.fields);
    return true;
  }
}

bool CsvReader::next(Row& row) {
  if (!nextLine(row)) return false;
  if (row.fields.size() == columns_.size()) return true;
  const std::string sentence = fmt::format("This row has {} fields; the header names {} columns.", row.fields.size(), columns_.size());
  throw Error(ErrorKind::scene, {{{name_, row.line, 1}, sentence, {}}});
}

}  // namespace tsubu::io
