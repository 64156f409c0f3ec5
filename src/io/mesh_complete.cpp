#include "io/mesh_complete.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tsubu::io {

bool isCompleteStl(std::string_view bytes) {
  constexpr std::size_t header = 84, triangle = 50;
  if (!bytes.starts_with("solid")) return true;
  std::uint32_t triangles = 0;
  if (bytes.size() >= header) std::memcpy(&triangles, bytes.data() + header - sizeof triangles, sizeof triangles);
  if (bytes.size() == header + triangle * triangles) return true;  // binary, whatever its header says
  const std::size_t last = bytes.rfind("facet");
  return bytes.find("endsolid", last == std::string_view::npos ? 0 : last) != std::string_view::npos;
}

namespace {

std::string_view nextWord(std::string_view& text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  const auto begin = std::find_if_not(text.begin(), text.end(), blank);
  const auto end = std::find_if(begin, text.end(), blank);
  const std::string_view word(begin, end);
  text.remove_prefix(static_cast<std::size_t>(end - text.begin()));
  return word;
}

std::optional<std::uint64_t> toCount(std::string_view word) {
  std::uint64_t count = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return count;
}

/// Bytes of a PLY type; 0 for an unknown one.
std::size_t sizeOf(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, std::size_t>, 16> sizes{{{"char", 1},
                                                                            {"uchar", 1},
                                                                            {"int8", 1},
                                                                            {"uint8", 1},
                                                                            {"short", 2},
                                                                            {"ushort", 2},
                                                                            {"int16", 2},
                                                                            {"uint16", 2},
                                                                            {"int", 4},
                                                                            {"uint", 4},
                                                                            {"int32", 4},
                                                                            {"uint32", 4},
                                                                            {"float", 4},
                                                                            {"float32", 4},
                                                                            {"double", 8},
                                                                            {"float64", 8}}};
  for (const auto& [name, size] : sizes)
    if (name == type) return size;
  return 0;
}

struct Property {
  std::size_t countSize = 0;  ///< of a list's length; 0 when it is no list
  std::size_t size = 0;
};

struct Element {
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  bool text = false, bigEndian = false;
  std::vector<Element> elements;
};

/// Takes the header off the front of `bytes`. Nothing when it is not all there or not understood.
std::optional<Header> takeHeader(std::string_view& bytes) {
  Header header;
  for (;;) {
    const std::size_t end = bytes.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    std::string_view line = bytes.substr(0, end);
    bytes.remove_prefix(end + 1);
    const std::string_view key = nextWord(line);
    if (key == "end_header") return header;
    if (key == "format") {
      const std::string_view format = nextWord(line);
      header.text = format == "ascii";
      header.bigEndian = format == "binary_big_endian";
    } else if (key == "element") {
      nextWord(line);
      const auto count = toCount(nextWord(line));
      if (!count) return std::nullopt;
      header.elements.push_back({*count, {}});
    } else if (key == "property") {
      if (header.elements.empty()) return std::nullopt;
      Property property;
      std::string_view type = nextWord(line);
      if (type == "list") {
        property.countSize = sizeOf(nextWord(line));
        if (property.countSize == 0) return std::nullopt;
        type = nextWord(line);
      }
      property.size = sizeOf(type);
      if (property.size == 0) return std::nullopt;
      header.elements.back().properties.push_back(property);
    }
  }
}

/// Takes one number off a text; false at its end.
bool skipWords(std::string_view& text, std::uint64_t count) {
  for (; count > 0; --count)
    if (nextWord(text).empty()) return false;
  return true;
}

bool skipText(std::string_view& text, const Property& property) {
  if (property.countSize == 0) return skipWords(text, 1);
  const auto count = toCount(nextWord(text));
  return count && skipWords(text, *count);
}

bool skipBinary(std::string_view& bytes, const Property& property, bool bigEndian) {
  if (bytes.size() < property.countSize) return false;
  std::uint64_t count = property.countSize == 0 ? 1 : 0;
  for (std::size_t i = 0; i < property.countSize; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[bigEndian ? i : property.countSize - 1 - i]);
    count = count << 8 | byte;
  }
  bytes.remove_prefix(property.countSize);
  if (count > bytes.size() / property.size) return false;
  bytes.remove_prefix(count * property.size);
  return true;
}

}  // namespace

bool isCompletePly(std::string_view bytes) {
  const auto header = takeHeader(bytes);
  if (!header) return false;
  for (const Element& element : header->elements) {
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const Property& property : element.properties)
        if (!(header->text ? skipText(bytes, property) : skipBinary(bytes, property, header->bigEndian))) return false;
  }
  return true;
}

}  // namespace tsubu::io
