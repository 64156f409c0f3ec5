#include "render/font.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/font_glyphs.h"

namespace tsubu::render {

namespace {

constexpr double capUnits = 10;    // height of a capital in units of the glyphs
constexpr double baseLine = 3;     // y of the base line in the glyphs
constexpr double gap = 2.7;        // between letters, in units
constexpr double penUnits = 1.3;   // width of the pen
constexpr double dotUnits = 0.35;  // by which dots are rounder than the pen

using Point = Eigen::Vector2d;

struct Segment {
  Point a, b;

  double distance(const Point& p) const {
    const Point along = b - a;
    const double length2 = along.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0;
    return (p - a - t * along).norm();
  }
};

int digitOf(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }

/// The strokes of a glyph as short straight lines, in units, y upwards from the base line.
std::vector<Segment> segmentsOf(const Glyph& glyph) {
  std::vector<Segment> segments;
  std::optional<Point> last, control;
  const std::string_view text = glyph.strokes;
  for (std::size_t k = 0; k < text.size();) {
    if (text[k] == '|') last.reset();
    if (text[k] == '|' || text[k] == ' ') {
      ++k;
      continue;
    }
    const bool curve = text[k] == '~';
    k += curve;
    const Point p(digitOf(text[k]), digitOf(text[k + 1]) - baseLine);
    k += 2;
    if (curve) {
      control = p;
      continue;
    }
    if (last && control) {
      constexpr int steps = 6;
      Point from = *last;
      for (int s = 1; s <= steps; ++s) {
        const double t = static_cast<double>(s) / steps;
        const Point to = (1 - t) * (1 - t) * *last + 2 * t * (1 - t) * *control + t * t * p;
        segments.push_back({from, to});
        from = to;
      }
    } else if (last) {
      segments.push_back({*last, p});
    }
    last = p;
    control.reset();
  }
  return segments;
}

void blend(Image& image, int x, int y, Colour colour, double share) {
  std::uint8_t* pixel = image.pixel(x, y);
  const std::uint8_t to[] = {colour.red, colour.green, colour.blue};
  for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(std::lround(pixel[c] + share * (to[c] - pixel[c])));
}

/// Blends where the distance to the strokes is below `radius` pixels, over `soft` pixels from all to nothing.
void drawGlyph(Image& image, const std::vector<Segment>& segments, const Point& origin, double scale, double radius, double soft,
               Colour colour, double opacity) {
  if (segments.empty()) return;
  Point low = segments[0].a, high = low;
  for (const Segment& s : segments) {
    low = low.cwiseMin(s.a).cwiseMin(s.b);
    high = high.cwiseMax(s.a).cwiseMax(s.b);
  }
  const double reach = radius + soft;
  const int fromX = std::max(0, static_cast<int>(std::floor(origin.x() + low.x() * scale - reach)));
  const int toX = std::min(image.width, static_cast<int>(std::ceil(origin.x() + high.x() * scale + reach)));
  const int fromY = std::max(0, static_cast<int>(std::floor(origin.y() - high.y() * scale - reach)));
  const int toY = std::min(image.height, static_cast<int>(std::ceil(origin.y() - low.y() * scale + reach)));
  for (int y = fromY; y < toY; ++y) {
    for (int x = fromX; x < toX; ++x) {
      const Point p((x + 0.5 - origin.x()) / scale, (origin.y() - y - 0.5) / scale);
      double distance = std::numeric_limits<double>::infinity();
      for (const Segment& s : segments) distance = std::min(distance, s.distance(p) - (s.a == s.b ? dotUnits : 0));
      const double share = std::clamp(0.5 + (radius - distance * scale) / soft, 0.0, 1.0);
      if (share > 0) blend(image, x, y, colour, share * opacity);
    }
  }
}

}  // namespace

std::vector<char32_t> codePoints(std::string_view utf8) {
  std::vector<char32_t> points;
  for (std::size_t k = 0; k < utf8.size();) {
    const auto lead = static_cast<unsigned char>(utf8[k++]);
    const int more = lead < 0x80 ? 0 : (lead >> 5) == 6 ? 1 : (lead >> 4) == 14 ? 2 : (lead >> 3) == 30 ? 3 : -1;
    char32_t point = more < 0 ? U'\ufffd' : more == 0 ? lead : lead & (0x3fu >> more);
    for (int m = 0; m < more; ++m) {
      if (k >= utf8.size() || (static_cast<unsigned char>(utf8[k]) & 0xc0) != 0x80) {
        point = U'\ufffd';
        break;
      }
      point = (point << 6) | (static_cast<unsigned char>(utf8[k++]) & 0x3f);
    }
    points.push_back(point);
  }
  return points;
}

double textWidth(std::string_view utf8, double capHeight) {
  double units = 0;
  for (const char32_t code : codePoints(utf8)) units += glyphOf(code).width + gap;
  return std::max(0.0, units - gap + penUnits) * capHeight / capUnits;
}

void drawText(Image& image, std::string_view utf8, const Pen& pen) {
  const double scale = pen.capHeight / capUnits;
  const double radius = std::max(0.5 * penUnits * scale, 0.45);
  const std::vector<char32_t> codes = codePoints(utf8);
  for (const bool halo : {true, false}) {
    double x = pen.x + 0.5 * penUnits * scale;
    for (const char32_t code : codes) {
      const Glyph& glyph = glyphOf(code);
      const std::vector<Segment> segments = segmentsOf(glyph);
      if (halo) {
        drawGlyph(image, segments, {x, pen.y}, scale, radius + 0.9 * scale, 1.5 + 1.2 * scale, pen.halo, 0.4);
      } else {
        drawGlyph(image, segments, {x, pen.y}, scale, radius, 1, pen.ink, 1);
      }
      x += (glyph.width + gap) * scale;
    }
  }
}

}  // namespace tsubu::render
