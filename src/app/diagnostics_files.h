#pragma once
// diagnostics.csv, walls.csv and grid.csv: what grains do as a crowd (docs/physics.md, D1–D6).

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/description.h"
#include "sim/diagnostics/survey.h"
#include "sim/simulation.h"

namespace tsubu::app {

/// A table that is complete on disk after every block of rows.
class TableFile {
 public:
  /// Writes the header. Throws Error(files).
  TableFile(const std::filesystem::path& path, const std::string& header);
  void add(const std::string& rows);
  std::string name() const { return path_.filename().string(); }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
};

class DiagnosticsFiles {
 public:
  /// `walls`: their names, in the order of the model.
  DiagnosticsFiles(const std::filesystem::path& folder, const scene::Diagnostics& wanted, std::vector<std::string> walls);

  /// Appends the rows of the present instant.
  void add(sim::Simulation& simulation);
  /// Rows of the ledger from one call of add() to the next.
  std::uint64_t every() const { return wanted_.every; }
  /// "diagnostics.csv, walls.csv"
  std::string names() const;

  /// Takes away what an earlier run has left.
  static void remove(const std::filesystem::path& folder);

 private:
  scene::Diagnostics wanted_;
  std::vector<std::string> wallNames_;
  std::optional<sim::Grid> cells_;
  TableFile regions_;
  std::optional<TableFile> walls_, grid_;
};

}  // namespace tsubu::app
