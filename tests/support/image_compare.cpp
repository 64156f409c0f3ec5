#include "support/image_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tsubu::test {

namespace {

// Limits of the perceptual tier. A sample that falls on the other side of a silhouette changes one pixel by a quarter; a grain of three
// pixels that moved by its radius changes some twenty by far more, and stands out in its window.
constexpr double leastSsim = 0.985;
constexpr double mostFlip = 0.015;
constexpr double mostInWindow = 0.05;

/// One number per pixel.
struct Plane {
  int width, height;
  std::vector<double> values;

  Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  double& at(int x, int y) { return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]; }
  double at(int x, int y) const { return const_cast<Plane*>(this)->at(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1)); }
};

template <class Of>
Plane planeOf(int width, int height, Of of) {
  Plane plane(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) plane.at(x, y) = of(x, y);
  }
  return plane;
}

/// Gaussian blur with repeated edges.
Plane blurred(const Plane& plane, double sigma) {
  const int reach = static_cast<int>(std::ceil(3 * sigma));
  std::vector<double> weights;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k) sum += weights.emplace_back(std::exp(-0.5 * k * k / (sigma * sigma)));
  const auto along = [&](const Plane& from, int dx, int dy) {
    return planeOf(from.width, from.height, [&](int x, int y) {
      double value = 0;
      for (int k = -reach; k <= reach; ++k) value += weights[static_cast<std::size_t>(k + reach)] * from.at(x + k * dx, y + k * dy);
      return value / sum;
    });
  };
  return along(along(plane, 1, 0), 0, 1);
}

/// Wang et al., IEEE Trans. Image Processing 13 (2004) 600: mean over the picture, windows of a Gaussian with sigma 1.5, values 0 to 100.
double meanSsim(const Plane& a, const Plane& b) {
  const auto product = [&](const Plane& p, const Plane& q) {
    return planeOf(a.width, a.height, [&](int x, int y) { return p.at(x, y) * q.at(x, y); });
  };
  const Plane ma = blurred(a, 1.5), mb = blurred(b, 1.5);
  const Plane aa = blurred(product(a, a), 1.5), bb = blurred(product(b, b), 1.5), ab = blurred(product(a, b), 1.5);
  const double c1 = 1, c2 = 9;  // (0.01·100)², (0.03·100)²
  double sum = 0;
  for (std::size_t k = 0; k < a.values.size(); ++k) {
    const double x = ma.values[k], y = mb.values[k];
    const double vx = aa.values[k] - x * x, vy = bb.values[k] - y * y, cov = ab.values[k] - x * y;
    sum += (2 * x * y + c1) * (2 * cov + c2) / ((x * x + y * y + c1) * (vx + vy + c2));
  }
  return sum / static_cast<double>(a.values.size());
}

/// CIE L*a*b* planes (D65), blurred as an eye at 67 pixels a degree blurs: little in lightness, more in colour.
using Lab = std::array<Plane, 3>;

Lab labOf(const Image& image) {
  const auto light = [](std::uint8_t byte) {
    const double v = byte / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  const auto root = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  Lab lab{Plane(image.width, image.height), Plane(image.width, image.height), Plane(image.width, image.height)};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      const double r = light(p[0]), g = light(p[1]), b = light(p[2]);
      const double fx = root((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505), fy = root(0.2126 * r + 0.7152 * g + 0.0722 * b);
      const double fz = root((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
      lab[0].at(x, y) = 116 * fy - 16;
      lab[1].at(x, y) = 500 * (fx - fy);
      lab[2].at(x, y) = 200 * (fy - fz);
    }
  }
  return lab;
}

/// After Andersson et al., "FLIP: a difference evaluator for alternating images" (2020), in short: the HyAB distance of the blurred
/// colours, raised to 0.7 and scaled so that green against blue is 1, made larger where an edge appears in only one of the pictures.
/// Simplified: the blurs are Gaussians in L*a*b* instead of fitted contrast sensitivities, and features are Sobel gradients.
Plane flipOf(const Lab& a, const Lab& b) {
  const int width = a[0].width, height = a[0].height;
  const Lab ba{blurred(a[0], 0.7), blurred(a[1], 1.4), blurred(a[2], 1.4)}, bb{blurred(b[0], 0.7), blurred(b[1], 1.4), blurred(b[2], 1.4)};
  const auto edge = [](const Plane& l, int x, int y) {
    const auto d = [&](int dx, int dy) { return l.at(x + dx, y + dy); };
    const double gx = d(1, -1) + 2 * d(1, 0) + d(1, 1) - d(-1, -1) - 2 * d(-1, 0) - d(-1, 1);
    const double gy = d(-1, 1) + 2 * d(0, 1) + d(1, 1) - d(-1, -1) - 2 * d(0, -1) - d(1, -1);
    return std::hypot(gx, gy) / 800;  // 1 for the hardest diagonal edge at most
  };
  const double largest = std::pow(308.0, 0.7);  // HyAB distance of pure green and pure blue
  return planeOf(width, height, [&](int x, int y) {
    const auto apart = [&](std::size_t k) { return ba[k].at(x, y) - bb[k].at(x, y); };
    const double hyab = std::abs(apart(0)) + std::hypot(apart(1), apart(2));
    const double colour = std::min(1.0, std::pow(hyab, 0.7) / largest);
    const double feature = std::sqrt(std::min(1.0, std::abs(edge(a[0], x, y) - edge(b[0], x, y))));
    return colour > 0 ? std::pow(colour, 1 - feature) : 0;
  });
}

double worstWindowOf(const Plane& plane) {
  constexpr int reach = 3;
  double worst = 0;
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      double sum = 0;
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) sum += plane.at(x + dx, y + dy);
      }
      worst = std::max(worst, sum / ((2 * reach + 1) * (2 * reach + 1)));
    }
  }
  return worst;
}

int levelsApart(const std::uint8_t* a, const std::uint8_t* b) {
  int worst = 0;
  for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(int{a[c]} - int{b[c]}));
  return worst;
}

}  // namespace

std::string Comparison::text() const {
  if (!sameSize) return "the pictures differ in size";
  static constexpr const char* names[] = {"exact", "tight", "perceptual", "different"};
  return fmt::format("{}: {:.3f} % of the pixels differ, by at most {} levels; SSIM {:.5f}, FLIP {:.5f}, worst window {:.4f}",
                     names[static_cast<int>(tier)], 100 * differing, worstLevels, ssim, flip, worstWindow);
}

Comparison compareImages(const Image& expected, const Image& actual) {
  Comparison c;
  c.sameSize = expected.width == actual.width && expected.height == actual.height && expected.rgb.size() == actual.rgb.size();
  if (!c.sameSize) return c;
  std::size_t differing = 0;
  for (std::size_t k = 0; k < expected.rgb.size(); k += 3) {
    const int apart = levelsApart(&expected.rgb[k], &actual.rgb[k]);
    c.worstLevels = std::max(c.worstLevels, apart);
    differing += apart > 0;
  }
  if (differing == 0) {
    c.ssim = 1;
    c.tier = Tier::exact;
    return c;
  }
  c.differing = 3.0 * static_cast<double>(differing) / static_cast<double>(expected.rgb.size());
  const Lab a = labOf(expected), b = labOf(actual);
  const Plane flip = flipOf(a, b);
  c.ssim = meanSsim(a[0], b[0]);
  for (const double v : flip.values) c.flip += v / static_cast<double>(flip.values.size());
  c.worstWindow = worstWindowOf(flip);
  if (c.worstLevels <= 3 && c.differing <= 0.001) {
    c.tier = Tier::tight;
  } else if (c.ssim >= leastSsim && c.flip <= mostFlip && c.worstWindow <= mostInWindow) {
    c.tier = Tier::perceptual;
  }
  return c;
}

Image differencePicture(const Image& expected, const Image& actual) {
  Image picture(std::min(expected.width, actual.width), std::min(expected.height, actual.height));
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const std::uint8_t* e = expected.pixel(x, y);
      const int apart = levelsApart(e, actual.pixel(x, y));
      const auto grey = static_cast<std::uint8_t>((e[0] + e[1] + e[2]) / 12);
      const auto glow = static_cast<std::uint8_t>(std::min(255, 120 + 3 * apart));
      const auto rest = static_cast<std::uint8_t>(std::min(255, 4 * apart));
      std::uint8_t* p = picture.pixel(x, y);
      p[0] = apart ? glow : grey, p[1] = apart ? rest : grey, p[2] = apart ? rest : grey;
    }
  }
  return picture;
}

}  // namespace tsubu::test
