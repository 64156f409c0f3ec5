#include "render/style.h"

#include <fmt/format.h>

namespace tsubu::render {

namespace {

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

std::optional<Colour> parseColour(std::string_view text) {
  if ((text.size() != 4 && text.size() != 7) || text[0] != '#') return std::nullopt;
  for (const char c : text.substr(1)) {
    if (hexDigit(c) < 0) return std::nullopt;
  }
  const bool brief = text.size() == 4;
  const auto channel = [&](std::size_t k) {
    const int high = hexDigit(text[brief ? 1 + k : 1 + 2 * k]);
    const int low = brief ? high : hexDigit(text[2 + 2 * k]);
    return static_cast<std::uint8_t>(16 * high + low);
  };
  return Colour{channel(0), channel(1), channel(2)};
}

int samplesAlongSide(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return 1;
    case Quality::fine:
      return 3;
    case Quality::normal:
      break;
  }
  return 2;
}

std::string toString(Colour colour) { return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue); }

}  // namespace tsubu::render
