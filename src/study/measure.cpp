#include "study/measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace tsubu::study {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

using Cell = std::array<std::int64_t, 3>;

Cell cellOf(const Vec3& position, double edge) {
  Cell cell{};
  for (std::size_t k = 0; k < 3; ++k) cell[k] = static_cast<std::int64_t>(std::floor(position[static_cast<Eigen::Index>(k)] / edge));
  return cell;
}

}  // namespace

// With n_i grains in cell i, a share p_i of them marked: S² = Σ n_i (p_i − p)²/N. Apart it is p(1 − p); at random (K − 1) p(1 − p)/N in the
// mean over K cells.
double mixingIndex(std::span<const Vec3> positions, std::span<const char> kind, double cell) {
  struct Content {
    double all = 0, marked = 0;
  };
  std::map<Cell, Content> cells;
  double marked = 0;
  for (std::size_t g = 0; g < positions.size(); ++g) {
    Content& content = cells[cellOf(positions[g], cell)];
    ++content.all;
    if (kind[g]) ++content.marked, ++marked;
  }
  const double n = static_cast<double>(positions.size()), p = marked / n, apart = p * (1 - p);
  const double random = static_cast<double>(cells.size() - 1) / n;
  if (positions.empty() || apart == 0 || random >= 1) return none;
  double variance = 0;
  for (const auto& [where, content] : cells) variance += content.all * std::pow(content.marked / content.all - p, 2) / n;
  return (1 - variance / apart) / (1 - random);
}

double angleOfRepose(const Snapshot& snapshot, const Vec3& point, const Vec3& up, double gravity) {
  const Vec3 z = up.normalized(), x = z.unitOrthogonal(), y = z.cross(x);
  double diameter = 0;
  for (const double r : snapshot.radius) diameter += 2 * r / static_cast<double>(snapshot.grains());
  const double fast2 = 0.01 * gravity * diameter;
  std::map<std::array<std::int64_t, 2>, double> tops;  // highest surface of a grain in each square
  for (std::size_t g = 0; g < snapshot.grains(); ++g) {
    if (snapshot.velocity[g].squaredNorm() > fast2) continue;
    const Vec3 offset = snapshot.position[g] - point;
    const std::array square{static_cast<std::int64_t>(std::floor(offset.dot(x) / (2 * diameter))),
                            static_cast<std::int64_t>(std::floor(offset.dot(y) / (2 * diameter)))};
    const double top = offset.dot(z) + snapshot.radius[g];
    const auto [place, fresh] = tops.emplace(square, top);
    if (!fresh) place->second = std::max(place->second, top);
  }
  const auto distance = [&](const auto& square) {
    return 2 * diameter * std::hypot(static_cast<double>(square[0]) + 0.5, static_cast<double>(square[1]) + 0.5);
  };
  // The radius of the heap: stray grains far away do not make it larger.
  std::vector<double> distances;
  for (const auto& [square, top] : tops) distances.push_back(distance(square));
  if (distances.size() < 8) return none;
  std::sort(distances.begin(), distances.end());
  const double radius = distances[static_cast<std::size_t>(0.95 * static_cast<double>(distances.size() - 1))];
  std::vector<double> at, height;
  for (const auto& [square, top] : tops) {
    const double r = distance(square);
    if (r < 0.2 * radius || r > 0.8 * radius) continue;
    at.push_back(r);
    height.push_back(top);
  }
  return std::atan(-slope(at, height));
}

double front(std::span<const Vec3> positions, const Vec3& direction, double share) {
  if (positions.empty()) return none;
  std::vector<double> along;
  const Vec3 unit = direction.normalized();
  for (const Vec3& x : positions) along.push_back(unit.dot(x));
  const auto place = static_cast<std::size_t>(std::ceil(share * static_cast<double>(along.size()))) - 1;
  std::nth_element(along.begin(), along.begin() + static_cast<std::ptrdiff_t>(place), along.end());
  return along[place];
}

double slope(std::span<const double> x, std::span<const double> y) {
  const double n = static_cast<double>(x.size());
  double meanX = 0, meanY = 0, xx = 0, xy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) meanX += x[k] / n, meanY += y[k] / n;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += (x[k] - meanX) * (x[k] - meanX);
    xy += (x[k] - meanX) * (y[k] - meanY);
  }
  return xx > 0 ? xy / xx : none;
}

double firstReach(std::span<const double> x, std::span<const double> y, double level) {
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (y[k] < level) continue;
    return k == 0 ? x[0] : x[k - 1] + (level - y[k - 1]) / (y[k] - y[k - 1]) * (x[k] - x[k - 1]);
  }
  return none;
}

}  // namespace tsubu::study
