#pragma once
// tsubu tradeoff: a study of speed against accuracy, with its table, files and plots.

#include <string>
#include <vector>

#include "scene/reader.h"

namespace tsubu::app {

struct TradeoffOptions {
  std::string scene;
  std::string folder;  ///< empty: out/NAME.tradeoff
  scene::Overrides overrides;
  std::string until;              ///< s; empty: the end of the scene
  std::vector<std::string> axes;  ///< empty: all
  bool features = false;
  std::string budget = "10m";
  int seeds = 3;
  int threads = 0;  ///< 0: as many as the machine has cores
};

/// s: of "90", "90s", "10m", "10min" or "1h". Throws Error(scene).
double secondsOf(const std::string& text);

/// Runs what is missing, prints the table, writes the files. Returns the exit code: 0, or 130 when interrupted. Throws Error.
int tradeoff(const TradeoffOptions& options);

}  // namespace tsubu::app
