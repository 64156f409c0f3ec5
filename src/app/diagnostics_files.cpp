#include "app/diagnostics_files.h"

#include <cerrno>
#include <cstring>
#include <span>

#include <fmt/format.h>

#include "core/error.h"

namespace tsubu::app {

namespace {

constexpr const char* regionsFile = "diagnostics.csv";
constexpr const char* wallsFile = "walls.csv";
constexpr const char* gridFile = "grid.csv";

// Nine components by rows of a tensor, or the six of a symmetric one.
constexpr int nine[][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}, {2, 0}, {2, 1}, {2, 2}};
constexpr int six[][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

std::string namesOf(const char* what, std::span<const int[2]> components) {
  std::string text;
  for (const auto& c : components) text += fmt::format(",{}_{}{}_Pa", what, "xyz"[c[0]], "xyz"[c[1]]);
  return text;
}
std::string numbers(const Mat3& tensor, std::span<const int[2]> components) {
  std::string text;
  for (const auto& c : components)
    text += fmt::format(",{:.9g}", 0.5 * (tensor(c[0], c[1]) + (components.size() == 6 ? tensor(c[1], c[0]) : tensor(c[0], c[1]))));
  return text;
}
std::string numbers(const Vec3& v) { return fmt::format(",{:.9g},{:.9g},{:.9g}", v.x(), v.y(), v.z()); }

std::string regionsHeader() {
  std::string text =
      "time_s,region,volume_m3,grains,mass_kg,solid_fraction,contacts_between_grains,contacts_with_walls,coordination,"
      "coordination_without_rattlers,rattlers";
  for (std::size_t k = 0; k <= sim::ContactSurvey::most; ++k)
    text += fmt::format(",grains_with_{}{}_contacts", k, k == sim::ContactSurvey::most ? "_or_more" : "");
  text +=
      ",mean_force_N,largest_force_N,share_above_mean,load_above_mean,bulk_velocity_x_m_per_s,bulk_velocity_y_m_per_s,"
      "bulk_velocity_z_m_per_s,temperature_m2_per_s2,rotation_temperature_m2_per_s2,pressure_Pa";
  return text + namesOf("contact_stress", nine) + namesOf("kinetic_stress", six);
}

std::string regionRow(double time, const std::string& name, const sim::Survey& seen) {
  const sim::ContactSurvey& c = seen.contacts;
  const sim::MotionSurvey& m = seen.motion;
  std::string text = fmt::format("{:.9g},{},{:.9g},{},{:.9g},{:.9g},{},{},{:.9g},{:.9g},{}", time, name, seen.stress.volume, m.grains,
                                 m.mass, seen.solidFraction, c.betweenGrains, c.withWalls, c.coordination, c.withoutRattlers, c.rattlers);
  for (const std::size_t grains : c.histogram) text += fmt::format(",{}", grains);
  text += fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g}", c.meanForce, c.largestForce, c.shareAboveMean, c.loadAboveMean);
  text += numbers(m.bulkVelocity) + fmt::format(",{:.9g},{:.9g},{:.9g}", m.temperature, m.rotationTemperature, seen.stress.pressure());
  return text + numbers(seen.stress.contact, nine) + numbers(seen.stress.kinetic, six) + "\n";
}

std::string gridHeader() {
  return "time_s,i,j,k,x_m,y_m,z_m,solid_fraction,grains,velocity_x_m_per_s,velocity_y_m_per_s,velocity_z_m_per_s,temperature_m2_per_s2,"
         "pressure_Pa" +
         namesOf("stress", six);
}

std::string gridRows(double time, const sim::Grid& grid, const std::vector<sim::CellSurvey>& cells) {
  std::string text;
  for (int i = 0; i < grid.cells[0]; ++i) {
    for (int j = 0; j < grid.cells[1]; ++j) {
      for (int k = 0; k < grid.cells[2]; ++k) {
        const sim::CellSurvey& cell = cells[grid.index(i, j, k)];
        text += fmt::format("{:.9g},{},{},{}", time, i, j, k) + numbers(Vec3(grid.cell(i, j, k).center()));
        text += fmt::format(",{:.9g},{}", cell.solidFraction, cell.motion.grains) + numbers(cell.motion.bulkVelocity);
        text += fmt::format(",{:.9g},{:.9g}", cell.motion.temperature, cell.stress.pressure()) + numbers(cell.stress.total(), six) + "\n";
      }
    }
  }
  return text;
}

sim::Grid gridOf(const scene::DiagnosticGrid& grid) {
  return {Box(grid.box.min, grid.box.max),
          {static_cast<int>(grid.cells[0]), static_cast<int>(grid.cells[1]), static_cast<int>(grid.cells[2])}};
}

}  // namespace

TableFile::TableFile(const std::filesystem::path& path, const std::string& header) : path_(path), file_(std::fopen(path.c_str(), "w")) {
  if (!file_) throw Error(ErrorKind::files, fmt::format("Cannot write '{}': {}.", path_.string(), std::strerror(errno)));
  add(header + "\n");
}

void TableFile::add(const std::string& rows) {
  if (std::fwrite(rows.data(), 1, rows.size(), file_.get()) != rows.size() || std::fflush(file_.get()) != 0)
    throw Error(ErrorKind::files, fmt::format("Cannot write '{}': {}.", path_.string(), std::strerror(errno)));
}

DiagnosticsFiles::DiagnosticsFiles(const std::filesystem::path& folder, const scene::Diagnostics& wanted, std::vector<std::string> walls)
    : wanted_(wanted), wallNames_(std::move(walls)), regions_(folder / regionsFile, regionsHeader()) {
  if (!wallNames_.empty())
    walls_.emplace(folder / wallsFile, "time_s,wall,contacts,force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm");
  if (!wanted_.grid) return;
  cells_ = gridOf(*wanted_.grid);
  grid_.emplace(folder / gridFile, gridHeader());
}

void DiagnosticsFiles::add(sim::Simulation& simulation) {
  const sim::Instant instant = simulation.instant();
  std::string rows = regionRow(instant.time, "whole", sim::survey(instant, sim::boxAround(instant)));
  for (const scene::DiagnosticRegion& region : wanted_.regions)
    rows += regionRow(instant.time, region.name, sim::survey(instant, Box(region.box.min, region.box.max)));
  regions_.add(rows);
  if (walls_) {
    const std::vector<sim::WallSurvey> seen = sim::surveyWalls(instant, wallNames_.size());
    rows.clear();
    for (std::size_t w = 0; w < seen.size(); ++w)
      rows += fmt::format("{:.9g},{},{}", instant.time, wallNames_[w], seen[w].contacts) + numbers(seen[w].force) +
              numbers(seen[w].torque) + "\n";
    walls_->add(rows);
  }
  if (grid_) grid_->add(gridRows(instant.time, *cells_, sim::survey(instant, *cells_)));
}

std::string DiagnosticsFiles::names() const {
  return regions_.name() + (walls_ ? ", " + walls_->name() : "") + (grid_ ? ", " + grid_->name() : "");
}

void DiagnosticsFiles::remove(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const char* file : {regionsFile, wallsFile, gridFile}) std::filesystem::remove(folder / file, ignored);
}

}  // namespace tsubu::app
