// From trials to errors.
//
// The error of a setting is the mean over the seeds of its difference to the reference at the same seed: the same seed places the same
// grains, so what the start owes to chance falls out. Its noise is what that mean may be off by: t s/√n, where s, the standard deviation of
// the differences, is hardly known from a few seeds and is drawn towards the median of all settings, which counts as two more degrees of
// freedom, and t is Student's factor for 95 % (Smyth 2004, Stat. Appl. Genet. Mol. Biol. 3:3, for the same trouble with few repeats of many
// measurements).

#include <algorithm>
#include <cmath>
#include <numeric>

#include "study/tradeoff.h"

namespace tsubu::study {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double priorFreedom = 2;

// Student's factor for 95 %, two-sided; within 2 % of the tables from three degrees of freedom on.
double student(double freedom) { return 1.96 + 2.4 / freedom + 3.2 / (freedom * freedom); }

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}
double varianceOf(const std::vector<double>& values) {
  if (values.size() < 2) return 0;
  const double mean = meanOf(values);
  double sum = 0;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return sum / static_cast<double>(values.size() - 1);
}
double medianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool usable(const Point& point) { return point.ran() && point.failure().empty(); }

/// Of one observable: values and differences to the reference by seed.
struct Compared {
  std::vector<double> values, differences;
  bool missed = false;  ///< some run did not come to it
};

Compared compare(const Point& point, const Point& reference, std::size_t observable) {
  Compared compared;
  for (const auto& [seed, outcome] : point.outcomes) {
    const double value = outcome.values[observable].value;
    compared.missed = compared.missed || !std::isfinite(value);
    compared.values.push_back(value);
    const auto same = reference.outcomes.find(seed);
    if (same != reference.outcomes.end()) compared.differences.push_back(value - same->second.values[observable].value);
  }
  return compared;
}

void analyseObservable(Study& study, std::size_t k) {
  const Point& reference = study.reference();
  ObservableInfo info;
  const Measured& first = reference.outcomes.begin()->second.values[k];
  info.name = first.name, info.unit = first.unit;
  const Compared own = compare(reference, reference, k);
  std::vector<double> scales;
  for (const auto& [seed, outcome] : reference.outcomes) scales.push_back(outcome.values[k].scale);
  info.known = !own.missed;
  info.reference = meanOf(own.values);
  info.spread = std::sqrt(varianceOf(own.values));
  info.scale = std::max(meanOf(scales), std::numeric_limits<double>::min());

  std::vector<double> variances;
  for (const Point& point : study.points)
    if (usable(point) && &point != &reference) {
      const Compared c = compare(point, reference, k);
      if (c.differences.size() > 1 && !c.missed) variances.push_back(varianceOf(c.differences));
    }
  const double prior = medianOf(variances);
  const auto noiseOf = [&](const std::vector<double>& differences) {
    const double n = static_cast<double>(differences.size()), freedom = n - 1;
    const double variance = (freedom * varianceOf(differences) + priorFreedom * prior) / (freedom + priorFreedom);
    return student(freedom + priorFreedom) * std::sqrt(variance / n) / info.scale;
  };

  // Half the step against the whole: for any order ≥ 1 the reference is not farther from the limit than the two from each other.
  const Point* const half = study.refinement();
  const Compared refinement = half && usable(*half) ? compare(*half, reference, k) : Compared{};
  const bool refined = !refinement.differences.empty() && !refinement.missed;
  info.bar = refined ? std::abs(meanOf(refinement.differences)) / info.scale : 0;
  for (Point& point : study.points) {
    if (!usable(point)) continue;
    const Compared c = compare(point, reference, k);
    Deviation d;
    d.mean = meanOf(c.values);
    if (!info.known || c.differences.empty()) {
      point.deviations.push_back(d);
      continue;
    }
    if (&point == &reference) {
      d.error = info.bar;
      d.noise = refined ? noiseOf(refinement.differences) : 0;
    } else {
      d.error = c.missed ? infinite : std::abs(meanOf(c.differences)) / info.scale;
      d.noise = c.missed ? 0 : noiseOf(c.differences);
    }
    d.floor = std::max({d.noise, info.bar, Deviation::rounding});
    point.deviations.push_back(d);
  }
  study.observables.push_back(info);
}

void markFront(std::vector<Point>& points) {
  for (Point& point : points) {
    const auto better = [&](const Point& other) {
      return &other != &point && usable(other) && other.cost <= point.cost && other.bound() <= point.bound() &&
             (other.cost < point.cost || other.bound() < point.bound());
    };
    point.pareto = usable(point) && std::none_of(points.begin(), points.end(), better);
  }
}

}  // namespace

std::string Point::failure() const {
  for (const auto& [seed, outcome] : outcomes)
    if (!outcome.complete()) return outcome.failure;
  return {};
}

double Point::bound() const {
  double most = 0;
  for (const Deviation& d : deviations) most = std::max(most, d.bound());
  return deviations.empty() ? infinite : most;
}

bool Point::none() const {
  return !deviations.empty() && std::all_of(deviations.begin(), deviations.end(), [](const Deviation& d) { return d.none(); });
}

void analyse(Study& study) {
  study.observables.clear();
  for (Point& point : study.points) {
    point.deviations.clear();
    double cost = 0;
    for (const auto& [seed, outcome] : point.outcomes) cost += outcome.cost / static_cast<double>(point.outcomes.size());
    point.cost = point.ran() ? cost : std::numeric_limits<double>::quiet_NaN();
  }
  if (study.points.size() < (study.request.features ? 1U : 3U) || !usable(study.reference())) return;
  const std::size_t observables = study.reference().outcomes.begin()->second.values.size();
  for (std::size_t k = 0; k < observables; ++k) analyseObservable(study, k);
  markFront(study.points);
}

}  // namespace tsubu::study
