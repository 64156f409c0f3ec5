#include "render/colour_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace tsubu::render {

namespace {

/// A colour at a place of the map; between nodes the encoded channels are interpolated linearly.
struct Node {
  double at, red, green, blue;
};

// viridis: Nathaniel Smith and Stéfan van der Walt, CC0. Every sixteenth of its 256 entries: never more than 2/255 from the whole table.
constexpr std::array<Node, 17> viridisNodes{{{0, 0.267004, 0.004874, 0.329415},
                                             {16 / 255.0, 0.282327, 0.094955, 0.417331},
                                             {32 / 255.0, 0.278826, 0.175490, 0.483397},
                                             {48 / 255.0, 0.258965, 0.251537, 0.524736},
                                             {64 / 255.0, 0.229739, 0.322361, 0.545706},
                                             {80 / 255.0, 0.199430, 0.387607, 0.554642},
                                             {96 / 255.0, 0.172719, 0.448791, 0.557885},
                                             {112 / 255.0, 0.149039, 0.508051, 0.557250},
                                             {128 / 255.0, 0.127568, 0.566949, 0.550556},
                                             {144 / 255.0, 0.120638, 0.625828, 0.533488},
                                             {160 / 255.0, 0.157851, 0.683765, 0.501686},
                                             {176 / 255.0, 0.246070, 0.738910, 0.452024},
                                             {192 / 255.0, 0.369214, 0.788888, 0.382914},
                                             {208 / 255.0, 0.515992, 0.831158, 0.294279},
                                             {224 / 255.0, 0.678489, 0.863742, 0.189503},
                                             {240 / 255.0, 0.845561, 0.887322, 0.099702},
                                             {1, 0.993248, 0.906157, 0.143936}}};

// cividis: Jamie Nuñez, Christopher Anderton and Ryan Renslow, CC0 (PLOS ONE 13, e0199239, 2018), with more nodes where it bends.
constexpr std::array<Node, 19> cividisNodes{{{0, 0.000000, 0.135112, 0.304751},
                                             {18 / 255.0, 0.000000, 0.184550, 0.428802},
                                             {22 / 255.0, 0.000000, 0.193366, 0.441561},
                                             {26 / 255.0, 0.046205, 0.203903, 0.440196},
                                             {32 / 255.0, 0.103401, 0.220406, 0.435790},
                                             {48 / 255.0, 0.195057, 0.264372, 0.425924},
                                             {64 / 255.0, 0.263738, 0.307831, 0.422789},
                                             {80 / 255.0, 0.324250, 0.351289, 0.426250},
                                             {96 / 255.0, 0.380830, 0.395164, 0.435653},
                                             {112 / 255.0, 0.435168, 0.439763, 0.451134},
                                             {128 / 255.0, 0.488697, 0.485318, 0.471008},
                                             {144 / 255.0, 0.547840, 0.531895, 0.471704},
                                             {160 / 255.0, 0.609105, 0.579816, 0.463638},
                                             {176 / 255.0, 0.671991, 0.629316, 0.448018},
                                             {192 / 255.0, 0.736488, 0.680629, 0.424028},
                                             {208 / 255.0, 0.802667, 0.733978, 0.390153},
                                             {224 / 255.0, 0.870717, 0.789572, 0.343333},
                                             {251 / 255.0, 0.992218, 0.888385, 0.205468},
                                             {1, 0.995737, 0.909344, 0.217772}}};

constexpr Node node(int k, int of, int rgb) {
  return {static_cast<double>(k) / of, (rgb >> 16) / 255.0, ((rgb >> 8) & 255) / 255.0, (rgb & 255) / 255.0};
}

// batlow and vik: Fabio Crameri, Scientific colour maps, MIT (doi 10.5281/zenodo.1243862), by the ten colours of batlow10 and vik10.
constexpr std::array<Node, 10> batlowNodes{node(0, 9, 0x011959), node(1, 9, 0x103f60), node(2, 9, 0x1c5a62), node(3, 9, 0x3c6d56),
                                           node(4, 9, 0x687b3e), node(5, 9, 0x9d892b), node(6, 9, 0xd29343), node(7, 9, 0xf8a17b),
                                           node(8, 9, 0xfdb7bc), node(9, 9, 0xfaccfa)};
constexpr std::array<Node, 10> vikNodes{node(0, 9, 0x001261), node(1, 9, 0x033e7d), node(2, 9, 0x1e6f9d), node(3, 9, 0x71a8c4),
                                        node(4, 9, 0xc9dde7), node(5, 9, 0xeacebd), node(6, 9, 0xd39774), node(7, 9, 0xbe6533),
                                        node(8, 9, 0x8b2706), node(9, 9, 0x590008)};

std::span<const Node> nodesOf(ColourMap map) {
  switch (map) {
    case ColourMap::cividis:
      return cividisNodes;
    case ColourMap::batlow:
      return batlowNodes;
    case ColourMap::vik:
      return vikNodes;
    case ColourMap::viridis:
      break;
  }
  return viridisNodes;
}

std::uint8_t byteOf(double channel) { return static_cast<std::uint8_t>(std::lround(std::clamp(channel, 0.0, 1.0) * 255)); }

}  // namespace

Colour mapped(ColourMap map, double t) {
  if (std::isnan(t)) return {128, 128, 128};
  t = std::clamp(t, 0.0, 1.0);
  const auto nodes = nodesOf(map);
  std::size_t k = 1;
  while (k + 1 < nodes.size() && nodes[k].at < t) ++k;
  const Node &a = nodes[k - 1], &b = nodes[k];
  const double s = (t - a.at) / (b.at - a.at);
  return {byteOf(a.red + s * (b.red - a.red)), byteOf(a.green + s * (b.green - a.green)), byteOf(a.blue + s * (b.blue - a.blue))};
}

Colour materialColour(std::size_t index) {
  // Sand, slate blue, brick, moss, ochre, plum, teal, stone: apart in lightness as well as in hue.
  static constexpr std::array<Colour, 8> palette{{{0xdd, 0xb9, 0x7c},
                                                  {0x4f, 0x7c, 0xac},
                                                  {0xb8, 0x50, 0x42},
                                                  {0x7d, 0x9a, 0x5d},
                                                  {0xe3, 0x9b, 0x2f},
                                                  {0x7b, 0x55, 0x86},
                                                  {0x3f, 0xa0, 0x98},
                                                  {0x9c, 0x95, 0x8d}}};
  return palette[index % palette.size()];
}

Vec3 toLinear(Colour colour) {
  const auto light = [](std::uint8_t byte) {
    const double v = byte / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  return {light(colour.red), light(colour.green), light(colour.blue)};
}

double lightness(Colour colour) {
  const double y = toLinear(colour).dot(Vec3(0.2126, 0.7152, 0.0722));
  return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

}  // namespace tsubu::render
