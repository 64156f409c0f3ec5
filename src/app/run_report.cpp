#include "app/run_report.h"

#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/version.h"
#include "core/error.h"

namespace tsubu::app {

void writeReport(const std::filesystem::path& path, const RunReport& r) {
  nlohmann::ordered_json json;
  json["version"] = version;
  json["scene"] = r.scene;
  json["title"] = r.title;
  if (!r.setting.empty()) json["setting"] = {{"study", r.setting}, {"overrides", r.settingOverrides}};
  json["ended"] = r.ended;
  if (!r.failure.empty()) json["failure"] = r.failure;
  json["threads"] = r.threads;
  json["threads_used"] = r.threadsUsed;
  json["isa"] = r.isa;
  json["dt"] = r.plan.timeStep;
  json["dt_limit"] = r.plan.limit;
  json["dt_limit_by"] = r.plan.limitedBy;
  if (r.pace) {
    json["dt_spectral"] = {{"shortest_step", r.pace->shortest()}, {"longest_step", r.pace->longest()}};
    if (std::isfinite(r.pace->limit().step))
      json["dt_spectral"].update({{"least_limit", r.pace->limit().step}, {"at", r.pace->limit().time}, {"by", r.pace->limit().by}});
  }
  if (std::isfinite(r.singleContact.undamped))
    json["dt_of_single_contact_rules"] = {
        {"note", r.singleContact.note}, {"undamped", r.singleContact.undamped}, {"duration", r.singleContact.duration}};
  json["steps"] = r.steps;
  json["simulated_time"] = r.simulatedTime;
  json["wall_time"] = r.wallTime;
  json["simulation_time"] = r.simulationTime;
  json["grain_steps"] = r.grainSteps;
  json["grain_steps_per_second"] = r.simulationTime > 0 ? static_cast<double>(r.grainSteps) / r.simulationTime : 0.0;
  json["grains"] = r.grains;
  json["inserted"] = r.counts.inserted;
  json["removed"] = r.counts.removed;
  json["lost"] = r.counts.lost;
  if (r.counts.impacts > 0) json["hard_impacts"] = r.counts.impacts;
  if (r.bonds) {
    json["bonds"] = r.counts.bonds;
    json["broken"] = r.counts.broken;
  }
  json["counted"] = nlohmann::ordered_json::object();
  for (std::size_t c = 0; c < r.counters.size(); ++c) json["counted"][r.counters[c]] = r.counts.crossed[c];
  if (r.ledger) {
    json["energy_residual"] = r.energyResidual;
    json["worst_energy_residual"] = r.worstEnergyResidual;
  } else {
    json["energy_residual"] = nullptr;
  }
  for (const study::Measured& measured : r.observables) {
    json["observables"][measured.name]["value"] =
        std::isfinite(measured.value) ? nlohmann::ordered_json(measured.value) : nlohmann::ordered_json(nullptr);
    if (!measured.unit.empty()) json["observables"][measured.name]["unit"] = measured.unit;
  }
  json["state_hash"] = r.stateHash;
  for (const auto& [part, seconds] : r.profile) json["profile"][part] = seconds;
  json["frames"] = r.frames;
  json["frame_interval"] = r.plan.interval;
  json["frame_rate"] = r.frameRate;
  json["slow_motion"] = r.slowMotion;
  json["renderer"] = r.renderer;
  json["warnings"] = r.warnings;
  json["lost_grains"] = nlohmann::ordered_json::array();
  for (const sim::LostGrain& grain : r.lostGrains)
    json["lost_grains"].push_back({{"id", grain.id},
                                   {"time", grain.time},
                                   {"position", {grain.position.x(), grain.position.y(), grain.position.z()}},
                                   {"why", grain.why}});

  const std::filesystem::path unfinished = path.string() + ".part";
  std::ofstream file(unfinished);
  file << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
  file.close();
  std::error_code failed;
  if (file) std::filesystem::rename(unfinished, path, failed);
  if (!file || failed) throw Error(ErrorKind::files, fmt::format("Cannot write '{}'.", path.string()));
}

}  // namespace tsubu::app
