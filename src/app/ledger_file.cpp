#include "app/ledger_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "core/error.h"

namespace tsubu::app {

namespace {

constexpr const char* columns =
    "time_s,grains,contacts,deepest_overlap,inserted,removed,lost,"
    "kinetic_bulk_J,kinetic_fluctuation_J,kinetic_rotation_J,kinetic_walls_J,"
    "gravitational_J,elastic_normal_J,elastic_tangential_J,elastic_rolling_J,"
    "elastic_bonds_J,potential_fields_J,"
    "dissipated_normal_J,dissipated_tangential_J,dissipated_friction_J,dissipated_rolling_J,dissipated_bonds_J,dissipated_breakage_J,"
    "dissipated_drag_J,work_walls_J,work_fields_J,inserted_J,removed_J,"
    "residual_J,residual_fraction,"
    "momentum_x,momentum_y,momentum_z,angular_momentum_bulk_x,angular_momentum_bulk_y,angular_momentum_bulk_z,"
    "angular_momentum_rest_x,angular_momentum_rest_y,angular_momentum_rest_z";

std::string energies(const sim::Ledger& l) {
  const double values[] = {l.kineticBulk,
                           l.kineticFluctuation,
                           l.kineticRotation,
                           l.kineticWalls,
                           l.gravitational,
                           l.elasticNormal,
                           l.elasticTangential,
                           l.elasticRolling,
                           l.elasticBonds,
                           l.potentialFields,
                           l.dissipatedNormal,
                           l.dissipatedTangential,
                           l.dissipatedFriction,
                           l.dissipatedRolling,
                           l.dissipatedBonds,
                           l.dissipatedBreakage,
                           l.dissipatedDrag,
                           l.workWalls,
                           l.workFields,
                           l.inserted,
                           l.removed,
                           l.residual(),
                           l.residualFraction(),
                           l.momentum.x(),
                           l.momentum.y(),
                           l.momentum.z(),
                           l.angularMomentumBulk.x(),
                           l.angularMomentumBulk.y(),
                           l.angularMomentumBulk.z(),
                           l.angularMomentumRest.x(),
                           l.angularMomentumRest.y(),
                           l.angularMomentumRest.z()};
  std::string text;
  for (const double value : values) text += fmt::format(",{:.9g}", value);
  return text;
}

std::string noEnergies() {
  std::string text;
  for (char c : energies({}))
    if (c == ',') text += c;
  return text;
}

}  // namespace

LedgerFile::LedgerFile(const std::filesystem::path& path, const LedgerColumns& asked)
    : file_(std::fopen(path.c_str(), "w")),
      path_(path.string()),
      heat_(asked.heat),
      bonds_(asked.bonds),
      crossed_(asked.counters.size(), 0) {
  if (!file_) throw Error(ErrorKind::files, fmt::format("Cannot write '{}': {}.", path_, std::strerror(errno)));
  std::string header = columns;
  for (const std::string& counter : asked.counters) header += fmt::format(",counted_{0},rate_{0}_per_s", counter);
  for (const std::string& wall : asked.movingWalls) header += fmt::format(",{0}_way_m,{0}_speed_m_per_s,{0}_load_N", wall);
  if (heat_) header += ",heat_J,heat_from_walls_J,heat_inserted_J,heat_removed_J";
  if (bonds_) header += ",bonds,broken";
  fmt::print(file_, "{}\n", header);
}

LedgerFile::~LedgerFile() { std::fclose(file_); }

void LedgerFile::add(sim::Simulation& simulation, bool ledger) {
  const sim::Ledger now = ledger ? simulation.ledger() : sim::Ledger{};
  const sim::ContactSummary contacts = simulation.contacts();
  const sim::Counts& counts = simulation.counts();
  const double time = simulation.time();
  std::string row = fmt::format("{:.9g},{},{},{:.6g},{},{},{}", time, simulation.grains(), contacts.touching, contacts.deepestOverlap,
                                counts.inserted, counts.removed, counts.lost);
  row += ledger ? energies(now) : noEnergies();
  for (std::size_t c = 0; c < counts.crossed.size(); ++c) {
    const double rate = time > lastTime_ ? static_cast<double>(counts.crossed[c] - crossed_[c]) / (time - lastTime_) : 0.0;
    row += fmt::format(",{},{:.6g}", counts.crossed[c], rate);
  }
  for (const sim::WallState& wall : simulation.movingWalls()) row += fmt::format(",{:.9g},{:.9g},{:.9g}", wall.way, wall.speed, wall.load);
  if (heat_) {
    const sim::HeatLedger& heat = now.heat;
    row += ledger ? fmt::format(",{:.12g},{:.12g},{:.12g},{:.12g}", heat.stored, heat.fromWalls, heat.inserted, heat.removed) : ",,,,";
  }
  if (bonds_) row += fmt::format(",{},{}", counts.bonds, counts.broken);
  crossed_ = counts.crossed;
  lastTime_ = time;
  largestResidual_ = std::max(largestResidual_, std::abs(now.residual()));
  turnover_ = now.turnover;
  fmt::print(file_, "{}\n", row);
  if (std::fflush(file_) != 0) throw Error(ErrorKind::files, fmt::format("Cannot write '{}': {}.", path_, std::strerror(errno)));
}

}  // namespace tsubu::app
