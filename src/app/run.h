#pragma once
// tsubu run: from a scene to a folder of frames, a ledger and a report.

#include <optional>
#include <string>

#include "scene/reader.h"

namespace tsubu::app {

struct RunOptions {
  std::string scene;
  std::string folder;           ///< where the results go; empty: out/NAME of the scene
  int threads = 0;              ///< 0: as many of the machine's cores as make the steps fast
  std::optional<double> until;  ///< s: ends here instead of at the scene's end
  scene::Overrides overrides;
  bool frames = true;
  bool profile = false;  ///< say at the end where the time went
  std::string accuracy;  ///< "2%": the cheapest setting of the saved study that is within; empty: the scene as it is
  std::string quality;   ///< draft, standard or reference: a point of that study; or empty
  std::string study;     ///< folder of the study; empty: out/NAME.tradeoff
  std::string isa;       ///< empty: the widest that this processor has
};

/// Runs and writes; prints progress to stderr and a summary to stdout. Returns the exit code: 0, or 130 when interrupted.
/// Throws Error; whatever was written before is complete, run.json included.
int run(const RunOptions& options);

}  // namespace tsubu::app
