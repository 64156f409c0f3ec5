#pragma once
// ledger.csv: one row per output time.

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/simulation.h"

namespace tsubu::app {

/// The columns that not every scene has.
struct LedgerColumns {
  std::vector<std::string> counters;     ///< names of the planes that count, two columns each
  std::vector<std::string> movingWalls;  ///< of the walls that move under load, three each
  bool heat = false;                     ///< four
  bool bonds = false;                    ///< two
};

class LedgerFile {
 public:
  /// Writes the header. Throws Error(files).
  LedgerFile(const std::filesystem::path& path, const LedgerColumns& asked);
  ~LedgerFile();
  LedgerFile(const LedgerFile&) = delete;
  LedgerFile& operator=(const LedgerFile&) = delete;

  /// Appends the row of the present instant, complete on disk when this returns. Without a ledger in the scene its columns stay empty.
  void add(sim::Simulation& simulation, bool ledger);
  /// The largest |residual| of any row, over the turnover of the run so far: over its own turnover that of the first touch says nothing
  /// (E6).
  double worstResidual() const { return turnover_ > 0 ? largestResidual_ / turnover_ : 0; }

 private:
  std::FILE* file_;
  std::string path_;
  bool heat_, bonds_;
  std::vector<std::int64_t> crossed_;
  double lastTime_ = 0;
  double largestResidual_ = 0, turnover_ = 0;  // J
};

}  // namespace tsubu::app
