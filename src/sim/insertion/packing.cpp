#include "sim/insertion/packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.h"
#include "core/portable_math.h"
#include "sim/insertion/sphere_grid.h"

namespace tsubu::sim {

namespace {

constexpr std::uint64_t radiusWord = 0x726164697573ULL;  // "radius"
constexpr std::uint64_t placeWord = 0x706c616365ULL;     // "place"
constexpr double sphereFactor = 4.0 / 3.0 * std::numbers::pi;

constexpr int triesPerSphere = 30;
constexpr int mostSweeps = 3000;
constexpr double densest = 0.63;                              // solid fraction of random close packing, a little less
constexpr double largestGrowth = 0.01, leastGrowth = 0.0005;  // of the radii while overlaps are pushed apart
constexpr int patience = 100;                                 // sweeps without progress
constexpr double relaxation = 1.6;    // over-relaxation of the pushes: half the sweeps of 1.0, and 1.8 no longer settles
constexpr double shrinkage = 0.985;   // of the radii from try to try, when a request has failed
constexpr double listStretch = 1.12;  // pairs up to this times contact distance are listed

double cube(double r) { return r * r * r; }

/// Puts a centre back where the sphere is inside the region.
class Confinement {
 public:
  explicit Confinement(const Region& region) : region_(region) {
    if (const auto* cylinder = std::get_if<CylinderRegion>(&region.shape)) {
      const Vec3 along = cylinder->top - cylinder->base;
      height_ = along.norm();
      axis_ = along / height_;
    }
  }

  void confine(Vec3& centre, double radius) const {
    if (const auto* box = std::get_if<BoxRegion>(&region_.shape)) {
      for (int k = 0; k < 3; ++k) {
        const double low = box->min[k] + radius, high = box->max[k] - radius;
        centre[k] = low <= high ? std::clamp(centre[k], low, high) : (low + high) / 2;
      }
      return;
    }
    const auto& cylinder = std::get<CylinderRegion>(region_.shape);
    const Vec3 from = centre - cylinder.base;
    const double h = from.dot(axis_);
    Vec3 across = from - h * axis_;
    const double distance = across.norm(), room = std::max(cylinder.radius - radius, 0.0);
    if (distance > room) across *= room / distance;
    centre = cylinder.base + across + (2 * radius <= height_ ? std::clamp(h, radius, height_ - radius) : height_ / 2) * axis_;
  }

 private:
  const Region& region_;
  Vec3 axis_ = Vec3::UnitZ();
  double height_ = 0;
};

class Packer {
 public:
  Packer(const Region& region, const std::vector<double>& radii, std::uint64_t seed, std::uint64_t source)
      : region_(region), confinement_(region), seed_(seed), key_(mix64(placeWord + source)), order_(radii.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    std::stable_sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) { return radii[a] > radii[b]; });
    for (const std::uint32_t i : order_) radii_.push_back(radii[i]);
    double volume = 0;
    for (const double r : radii_) volume += sphereFactor * cube(r);
    fraction_ = volume / region.volume();
  }

  std::vector<Vec3> pack() {
    if (radii_.empty()) return {};
    if (!placeAtRandom()) {
      sortInSpace();
      if (!pushApart()) fail();
    }
    std::vector<Vec3> result(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) result[order_[i]] = centres_[i];
    return result;
  }

 private:
  struct Pair {
    std::uint32_t i, j;
  };

  // True when every sphere has found a free place.
  bool placeAtRandom() {
    SphereGrid grid(region_.bounds(), radii_.front(), radii_.size());
    bool allFree = true;
    // Once places get rare most tries are in vain; overlaps will have to be pushed apart anyway.
    int tries = triesPerSphere;
    for (std::size_t i = 0; i < radii_.size(); ++i) {
      Random random(seed_, key_, order_[i]);
      Vec3 best = Vec3::Zero();
      double bestGap = -std::numeric_limits<double>::infinity();
      for (int t = 0; t < tries && bestGap < 0; ++t) {
        const Vec3 place = region_.randomPlace(radii_[i], random);
        const double gap = gapAt(grid, place, radii_[i], bestGap);
        if (gap > bestGap) {
          bestGap = gap;
          best = place;
        }
      }
      if (bestGap < 0) {
        allFree = false;
        tries = std::max(3, tries - 1);
      }
      centres_.push_back(best);
      grid.insert(static_cast<std::uint32_t>(i), best, radii_[i]);
    }
    return allFree;
  }

  // The smallest distance to another surface in units of the sum of radii, 0 when all are clear; stops when it is worse than `enough`.
  double gapAt(const SphereGrid& grid, const Vec3& place, double radius, double enough) const {
    double gap = 0;
    grid.visitNear(place, radius, 1, [&](std::uint32_t s) {
      if (gap <= enough) return;
      const double reach = radius + radii_[s], d2 = (centres_[s] - place).squaredNorm();
      if (d2 < reach * reach) gap = std::min(gap, std::sqrt(d2) / reach - 1);
    });
    return gap;
  }

  // Neighbours in space become neighbours in memory.
  void sortInSpace() {
    const SphereGrid grid(region_.bounds(), radii_.front(), radii_.size());
    std::vector<std::pair<std::size_t, std::uint32_t>> keys(radii_.size());
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = {grid.coarseCell(centres_[i]), static_cast<std::uint32_t>(i)};
    std::sort(keys.begin(), keys.end());
    std::vector<double> radii;
    std::vector<Vec3> centres;
    std::vector<std::uint32_t> order;
    for (const auto& [cell, i] : keys) {
      radii.push_back(radii_[i]);
      centres.push_back(centres_[i]);
      order.push_back(order_[i]);
    }
    radii_.swap(radii);
    centres_.swap(centres);
    order_.swap(order);
    largest_ = *std::max_element(radii_.begin(), radii_.end());
  }

  void listPairs() {
    SphereGrid grid(region_.bounds(), largest_, radii_.size());
    pairs_.clear();
    for (std::uint32_t i = 0; i < radii_.size(); ++i) {
      grid.visitNear(centres_[i], radii_[i], listStretch, [&](std::uint32_t j) {
        const double reach = (radii_[i] + radii_[j]) * listStretch;
        if ((centres_[i] - centres_[j]).squaredNorm() < reach * reach) pairs_.push_back({i, j});
      });
      grid.insert(i, centres_[i], radii_[i]);
    }
    listed_ = centres_;
  }

  // A pair not listed cannot have come closer than `growth` as long as no sphere has moved this share of its own radius.
  bool listIsStale(double growth) const {
    const double allowed = listStretch - growth;
    for (std::size_t i = 0; i < radii_.size(); ++i) {
      const double way = allowed * radii_[i];
      if ((centres_[i] - listed_[i]).squaredNorm() > way * way) return true;
    }
    return false;
  }

  bool pushApart() {
    // Some room to grow into: pushing to exact contact takes forever. The denser the packing, the less room there is; it shrinks until
    // the sweeps get somewhere.
    double growth = std::clamp(portable::cbrt(densest / fraction_), 1 + leastGrowth, 1 + largestGrowth);
    double bestDepth = std::numeric_limits<double>::infinity();
    listPairs();
    for (int number = 0, lastGain = 0; number < mostSweeps; ++number) {
      const double depth = sweepAndConfine(growth);
      if (depth <= 0 && !overlaps()) return true;
      if (depth < 0.97 * bestDepth) {
        bestDepth = depth;
        lastGain = number;
      } else if (number - lastGain > patience) {
        if (growth - 1 <= leastGrowth) return false;
        growth = 1 + std::max((growth - 1) / 2, leastGrowth);
        bestDepth = std::numeric_limits<double>::infinity();
        lastGain = number;
      }
      if (listIsStale(growth)) listPairs();
    }
    return false;
  }

  double sweepAndConfine(double growth) {
    const double depth = sweep(growth);
    for (std::size_t i = 0; i < radii_.size(); ++i) {
      confinement_.confine(centres_[i], std::min(radii_[i] * growth, std::max(radii_[i], inradius_)));
    }
    return depth;
  }

  // Pushes every pair to `growth` times its contact distance; returns the deepest overlap of the true radii met, over the sum of radii.
  double sweep(double growth) {
    double deepest = 0;
    for (const Pair& pair : pairs_) {
      Vec3 &a = centres_[pair.i], &b = centres_[pair.j];
      const double ra = radii_[pair.i], rb = radii_[pair.j], contact = ra + rb, reach = contact * growth;
      const Vec3 apart = a - b;
      const double d2 = apart.squaredNorm();
      if (d2 >= reach * reach) continue;
      const double d = std::sqrt(d2);
      deepest = std::max(deepest, 1 - d / contact);
      const Vec3 n = d > 0 ? Vec3(apart / d) : Vec3(Vec3::UnitZ());
      const double share = rb * rb / (ra * ra + rb * rb);
      const double push = relaxation * (reach - d);
      a += (push * share) * n;
      b -= (push * (1 - share)) * n;
    }
    return deepest;
  }

  bool overlaps() {
    listPairs();
    return std::any_of(pairs_.begin(), pairs_.end(), [this](const Pair& pair) {
      const double reach = radii_[pair.i] + radii_[pair.j];
      return (centres_[pair.i] - centres_[pair.j]).squaredNorm() < reach * reach;
    });
  }

  // Shrinks the spheres until they do come apart, to say what would have been possible.
  [[noreturn]] void fail() {
    const double wanted = fraction_;
    for (int attempt = 0; attempt < 30; ++attempt) {
      for (double& r : radii_) r *= shrinkage;
      fraction_ *= cube(shrinkage);
      largest_ *= shrinkage;
      if (comesApart(patience)) break;
    }
    throw Error(ErrorKind::scene,
                fmt::format("{} grains, a solid fraction of {:.3f}, do not fit into the region at random; {:.3f} was reached.",
                            radii_.size(), wanted, fraction_),
                "ask for fewer or smaller grains, or use a lattice");
  }

  bool comesApart(int sweeps) {
    listPairs();
    for (int i = 0; i < sweeps; ++i) {
      const double depth = sweepAndConfine(1 + leastGrowth);
      if (depth <= 0 && !overlaps()) return true;
      if (listIsStale(1 + leastGrowth)) listPairs();
    }
    return false;
  }

  const Region& region_;
  Confinement confinement_;
  std::uint64_t seed_, key_;
  std::vector<std::uint32_t> order_;  // number in the request of each sphere here
  std::vector<double> radii_;
  std::vector<Vec3> centres_, listed_;
  std::vector<Pair> pairs_;
  double fraction_ = 0, largest_ = 0, inradius_ = region_.inradius();
};

}  // namespace

std::vector<double> drawRadii(const SizeDistribution& sizes, const PackingAmount& amount, std::uint64_t seed, std::uint64_t source) {
  const std::uint64_t key = mix64(radiusWord + source);
  std::vector<double> radii;
  double left = amount.volume.value_or(0);
  for (std::uint64_t k = 0; !amount.count || k < *amount.count; ++k) {
    Random random(seed, key, k);
    const double radius = sizes.draw(random), volume = sphereFactor * cube(radius);
    if (amount.volume && volume > 2 * left) break;  // without it the sum is nearer
    left -= volume;
    radii.push_back(radius);
  }
  return radii;
}

std::vector<Vec3> packSpheres(const Region& region, const std::vector<double>& radii, std::uint64_t seed, std::uint64_t source) {
  return Packer(region, radii, seed, source).pack();
}

std::optional<Overlap> deepestOverlap(const std::vector<Vec3>& centres, const std::vector<double>& radii, double tolerance) {
  if (centres.empty()) return std::nullopt;
  Box bounds;
  for (const Vec3& centre : centres) bounds.extend(centre);
  SphereGrid grid(bounds, *std::max_element(radii.begin(), radii.end()), centres.size());
  Overlap deepest;
  deepest.depth = tolerance;
  bool found = false;
  for (std::uint32_t i = 0; i < centres.size(); ++i) {
    grid.visitNear(centres[i], radii[i], 1, [&](std::uint32_t j) {
      const double reach = radii[i] + radii[j], d2 = (centres[i] - centres[j]).squaredNorm();
      if (d2 >= reach * reach) return;
      const double depth = (reach - std::sqrt(d2)) / std::min(radii[i], radii[j]);
      if (depth <= deepest.depth) return;
      deepest = {j, i, depth};
      found = true;
    });
    grid.insert(i, centres[i], radii[i]);
  }
  return found ? std::optional(deepest) : std::nullopt;
}

}  // namespace tsubu::sim
