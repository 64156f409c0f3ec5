#pragma once
// How many threads a step takes best.

#include <vector>

namespace tsubu {

/// How many threads do the same work fastest, found out while it is done: for results that do not depend on it, it may change at any time.
/// Now and then some steps are timed with as many threads as before, and as many with half or twice of them; medians decide, and only a
/// clear gain counts. As long as nothing is gained, that happens ever more rarely.
class ThreadChoice {
 public:
  /// \param most  threads that there are, ≥ 1
  explicit ThreadChoice(int most) : most_(most), threads_(most) {}

  /// For the next step.
  int threads() const { return phase_ == Phase::other ? other() : threads_; }
  /// Is the next step to be timed?
  bool listens() const { return phase_ != Phase::rest; }
  /// After each step; what it took, s, if it was to be timed.
  void took(double seconds);

 private:
  enum class Phase { rest, own, other };

  int other() const;
  void decide(double own, double other);

  int most_, threads_;
  bool fewer_ = true;  ///< half of them is tried next, otherwise twice
  Phase phase_ = Phase::rest;
  int rest_ = 0, done_ = 0;
  double own_ = 0;  ///< s: median
  std::vector<double> times_;
};

}  // namespace tsubu
