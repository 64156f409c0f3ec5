#pragma once
// How far a run is: one line that changes on a terminal, plain lines now and then when piped.

#include <chrono>
#include <cstdio>

namespace tsubu::app {

struct Progress {
  double time = 0, end = 0;  ///< s, simulated
  std::size_t frame = 0, frames = 0;
  double grainSteps = 0;  ///< so far
};

class ProgressLine {
 public:
  /// Writes to `stream` (usually stderr).
  explicit ProgressLine(std::FILE* stream);

  /// Shows the state, if it is time to; `last` shows it in any case and ends the line.
  void show(const Progress& progress, bool last = false);
  double secondsSinceStart() const;

 private:
  using Clock = std::chrono::steady_clock;

  std::FILE* stream_;
  bool terminal_;
  Clock::time_point start_ = Clock::now(), shown_;
};

}  // namespace tsubu::app
