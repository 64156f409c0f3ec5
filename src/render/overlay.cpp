#include "render/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/colour_map.h"
#include "render/font.h"

namespace tsubu::render {

namespace {

/// Measures that follow the height of the picture, with a floor that keeps words legible on small ones.
struct Layout {
  double text, title, small, margin;

  explicit Layout(int height)
      : text(std::max(6.5, height / 50.0)),
        title(std::max(7.5, height / 40.0)),
        small(std::max(5.5, height / 64.0)),
        margin(std::max(6.0, height / 26.0)) {}
};

/// Dark words on a light background and light ones on a dark one: decided by the style, so that a film does not flicker.
Pen penFor(const Background& background) {
  Pen pen;
  const bool light = lightness(background.top) + lightness(background.bottom) > 110;
  pen.ink = light ? Colour{0x1d, 0x25, 0x2c} : Colour{0xf2, 0xf4, 0xf5};
  pen.halo = light ? Colour{0xff, 0xff, 0xff} : Colour{0x08, 0x0a, 0x0c};
  return pen;
}

void write(Image& image, Pen pen, std::string_view text, double x, double y, double capHeight) {
  pen.x = x;
  pen.y = y;
  pen.capHeight = capHeight;
  drawText(image, text, pen);
}

void fill(Image& image, int x, int y, int width, int height, Colour colour) {
  for (int row = std::max(0, y); row < std::min(image.height, y + height); ++row) {
    for (int column = std::max(0, x); column < std::min(image.width, x + width); ++column) {
      std::uint8_t* p = image.pixel(column, row);
      p[0] = colour.red, p[1] = colour.green, p[2] = colour.blue;
    }
  }
}

/// The digits that tell neighbouring ticks apart. Zero has no sign, and a minus is a minus.
std::string tickText(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  if (std::abs(value) >= 1e6) return fmt::format("{:.3g}", value);
  if (std::abs(value) < 1e-6 * step) value = 0;
  return (value < 0 ? "\u2212" : "") + fmt::format("{:.{}f}", std::abs(value), decimals);
}

void drawLegend(Image& image, const Legend& legend, const Pen& pen, const Layout& layout, LegendPlace place) {
  const BarPlace bar = legendBar(image.width, image.height, place);
  fill(image, bar.x - 1, bar.y - 1, bar.width + 2, bar.height + 2, pen.ink);
  for (int k = 0; k < bar.width; ++k) fill(image, bar.x + k, bar.y, 1, bar.height, mapped(legend.map, (k + 0.5) / bar.width));

  const double above = bar.y - 0.8 * layout.text;
  const std::string name = legend.unit.empty() ? legend.quantity : fmt::format("{} [{}]", legend.quantity, legend.unit);
  // Of a tall picture the bar is narrow: a name that is longer begins before it.
  const double nameAt = std::min<double>(bar.x, image.width - layout.margin - textWidth(name, layout.text));
  write(image, pen, name, nameAt, above, layout.text);
  if (!legend.fixed) {
    const std::string_view warning = "range of this frame";
    const double x = bar.x + bar.width - textWidth(warning, layout.small);
    const bool collides = x < nameAt + textWidth(name, layout.text) + layout.text;
    write(image, pen, warning, x, collides ? above - 1.8 * layout.text : above, layout.small);
  }

  const double low = legend.range.low / legend.scale, high = legend.range.high / legend.scale;
  std::vector<double> ticks;
  double step = high - low;
  // As many as have room for their numbers.
  for (int most = image.width < 480 ? 3 : 6; most > 1; --most) {
    ticks = roundTicks(low, high, most);
    if (ticks.size() < 2) break;
    step = ticks[1] - ticks[0];
    const double widest =
        std::max(textWidth(tickText(ticks.front(), step), layout.small), textWidth(tickText(ticks.back(), step), layout.small));
    if (widest + 0.5 * layout.small < step / (high - low) * bar.width) break;
  }
  const int notch = std::max(2, bar.height / 3);
  for (const double tick : ticks) {
    const double x = bar.x + (tick - low) / (high - low) * bar.width;
    fill(image, static_cast<int>(std::lround(x - 0.5)), bar.y + bar.height, 1, notch, pen.ink);
    const std::string text = tickText(tick, step);
    write(image, pen, text, x - 0.5 * textWidth(text, layout.small), bar.y + bar.height + notch + 1.6 * layout.small, layout.small);
  }
}

}  // namespace

BarPlace legendBar(int pictureWidth, int pictureHeight, LegendPlace place) {
  const Layout layout(pictureHeight);
  const int width = static_cast<int>(std::min(std::max(0.24 * pictureWidth, 40.0), 0.6 * pictureHeight));
  const int height = std::max(4, pictureHeight / 60);
  const int right = static_cast<int>(std::lround(pictureWidth - layout.margin - layout.small));
  const int bottom = static_cast<int>(std::lround(pictureHeight - layout.margin - std::max(2, height / 3) - 1.6 * layout.small));
  const int top = static_cast<int>(std::lround(layout.margin + 1.8 * layout.text));  // below the name
  return {right - width, place == LegendPlace::topRight ? top : bottom - height, width, height};
}

std::vector<double> roundTicks(double low, double high, int most) {
  if (!(high > low) || most < 1) return {};
  const double span = high - low;
  double power = std::pow(10, std::floor(std::log10(span / most)));
  for (;; power *= 10) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double step = factor * power;
      const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
      if (last - first + 1 > most) continue;
      std::vector<double> ticks;
      for (double k = first; k <= last; ++k) ticks.push_back(k * step);
      return ticks;
    }
  }
}

std::string timeStamp(const Overlay& overlay, double time) {
  std::string text = fmt::format("t = {:.{}f} s", time, overlay.timeDecimals);
  const double slow = overlay.slowMotion.value_or(1);
  if (slow > 1.0001) text += fmt::format("   slow motion {:.3g}\u00d7", slow);
  if (slow < 0.9999) text += fmt::format("   time lapse {:.3g}\u00d7", 1 / slow);
  return text;
}

void drawOverlay(Image& image, const Style& style, double time, const std::optional<Legend>& legend) {
  const Layout layout(image.height);
  const Pen pen = penFor(style.background);
  const Overlay& overlay = style.overlay;
  if (!overlay.title.empty()) write(image, pen, overlay.title, layout.margin, layout.margin + layout.title, layout.title);
  if (overlay.time) write(image, pen, timeStamp(overlay, time), layout.margin, image.height - layout.margin, layout.text);
  if (overlay.legend && legend) drawLegend(image, *legend, pen, layout, overlay.legendPlace);
}

}  // namespace tsubu::render
