#pragma once
// Do the lists still hold? A pair list holds as long as no grain that it reads has gone farther than its share of its skin. Kept by slab:
// where little moves, nothing needs to be made anew while grains fall elsewhere.

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace tsubu::sim {

/// Ways are in terms of the skin of each grain, the largest of a slab.
class Drift {
 public:
  /// All lists are new. `readBy`: for each list, the slabs whose grains are in it.
  void restart(std::vector<std::vector<int>> readBy) {
    reads_ = std::move(readBy);
    way_.assign(reads_.size(), 0);
    last_ = sinceSearch_ = way_;
    atFilter_.clear();
    for (const std::vector<int>& slabs : reads_) atFilter_.emplace_back(slabs.size(), 0.0);
  }

  /// One step of a slab's grains.
  void add(int slab, double way) {
    const auto s = static_cast<std::size_t>(slab);
    last_[s] = way;
    way_[s] += way;
    sinceSearch_[s] += way;
  }

  /// The inner list has been made anew.
  void filtered(int list) {
    const auto k = static_cast<std::size_t>(list);
    for (std::size_t n = 0; n < reads_[k].size(); ++n) atFilter_[k][n] = way_[static_cast<std::size_t>(reads_[k][n])];
  }

  /// Has a grain of the inner list gone farther than this since then? With as many more steps as the last one.
  bool beyond(int list, double share, int moreSteps) const {
    const auto k = static_cast<std::size_t>(list);
    for (std::size_t n = 0; n < reads_[k].size(); ++n) {
      const auto s = static_cast<std::size_t>(reads_[k][n]);
      // A way that is not a number is too long.
      if (!(way_[s] - atFilter_[k][n] + moreSteps * last_[s] <= share)) return true;
    }
    return false;
  }

  /// No grain of the slab is farther than this from where it was at the search; may be set when somebody has looked.
  double& sinceSearch(int slab) { return sinceSearch_[static_cast<std::size_t>(slab)]; }
  int lists() const { return static_cast<int>(reads_.size()); }

 private:
  std::vector<std::vector<int>> reads_;
  std::vector<std::vector<double>> atFilter_;     // way of each slab that a list reads, when it was filtered
  std::vector<double> way_, last_, sinceSearch_;  // by slab
};

}  // namespace tsubu::sim
