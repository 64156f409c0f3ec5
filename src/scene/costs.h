#pragma once
// What features have been measured to cost (bench/costs.csv, from bench/step): for `tsubu explain`.

#include <string>
#include <string_view>
#include <vector>

#include "sim/model.h"

namespace tsubu::scene {

struct FeatureCost {
  std::string feature;
  std::string comparedWith;                    ///< empty: nothing
  double nanoseconds = 0;                      ///< per grain-step, of the bed that has it
  double added = 0;                            ///< ns per grain-step more than without
  int bytesPerGrain = 0, bytesPerContact = 0;  ///< more than without
};

struct MeasuredCosts {
  std::string machine, isa;
  std::vector<FeatureCost> features;

  /// Null when it has not been measured.
  const FeatureCost* of(std::string_view feature) const;
};

/// Those of the build.
const MeasuredCosts& measuredCosts();

/// By the names of bench/step, what the model has.
std::vector<std::string> featuresOf(const sim::Model& model);

}  // namespace tsubu::scene
