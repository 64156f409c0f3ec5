#include "core/thread_choice.h"

#include <algorithm>

namespace tsubu {

namespace {
constexpr int timed = 25, leastRest = 250, mostRest = 16000;
constexpr double clearly = 0.93;  // what counts as a gain: medians of a shared machine differ by some per cent

double medianOf(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}
}  // namespace

int ThreadChoice::other() const { return fewer_ ? std::max(1, threads_ / 2) : std::min(most_, 2 * threads_); }

void ThreadChoice::took(double seconds) {
  if (most_ == 1) return;
  ++done_;
  if (phase_ == Phase::rest) {
    if (done_ < std::max(rest_, timed)) return;
    phase_ = Phase::own;
  } else {
    times_.push_back(seconds);
    if (done_ < timed) return;
    const double median = medianOf(times_);
    if (phase_ == Phase::own) {
      own_ = median;
      if (other() == threads_) fewer_ = !fewer_;
      phase_ = Phase::other;
    } else {
      decide(own_, median);
      phase_ = Phase::rest;
    }
  }
  done_ = 0;
  times_.clear();
}

void ThreadChoice::decide(double own, double other) {
  if (other < clearly * own) {
    threads_ = this->other();
    rest_ = leastRest;
  } else {
    fewer_ = !fewer_;
    rest_ = std::clamp(2 * rest_, leastRest, mostRest);
  }
}

}  // namespace tsubu
