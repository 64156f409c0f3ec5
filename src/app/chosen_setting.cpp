#include "app/chosen_setting.h"

#include <charconv>

#include <fmt/format.h>

#include "app/version.h"
#include "core/error.h"

namespace tsubu::app {

namespace {

std::filesystem::path fileOf(const RunOptions& options) { return studyFolder(options) / "tradeoff.json"; }

study::SavedStudy ownStudy(const RunOptions& options) {
  study::SavedStudy study = study::readStudy(fileOf(options), options.scene);
  study::refuseOtherScene(study, options.scene, options.overrides, version);
  return study;
}

}  // namespace

std::filesystem::path studyFolder(const RunOptions& options) {
  return options.study.empty() ? study::folderOf(options.scene) : std::filesystem::path(options.study);
}

double shareOf(const std::string& text) {
  double value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  std::string unit = failure == std::errc() ? text.substr(static_cast<std::size_t>(end - text.data())) : "?";
  std::erase(unit, ' ');
  if (unit == "%") value /= 100;
  if ((unit != "%" && !unit.empty()) || !(value > 0) || value > 1)
    throw Error(ErrorKind::scene, fmt::format("'{}' is no accuracy.", text), "write 2% or 0.02");
  return value;
}

std::optional<study::SavedPoint> chosenSetting(const RunOptions& options) {
  if (options.accuracy.empty() && options.quality.empty()) return std::nullopt;
  if (!options.accuracy.empty() && !options.quality.empty())
    throw Error(ErrorKind::scene, "--accuracy and --quality both choose a setting: only one can be given.");
  const double accuracy = options.accuracy.empty() ? 0 : shareOf(options.accuracy);
  const study::SavedStudy study = ownStudy(options);
  return options.quality.empty() ? study::cheapestWithin(study, accuracy) : study::pointOfQuality(study, options.quality);
}

std::optional<study::SavedStudy> studyOf(const RunOptions& options) {
  std::error_code ignored;
  if (!std::filesystem::exists(fileOf(options), ignored)) return std::nullopt;
  try {
    return ownStudy(options);
  } catch (const Error&) {
    if (!options.study.empty()) throw;
    return std::nullopt;  // of another scene, and nobody has asked for it
  }
}

scene::Overrides allOverrides(const RunOptions& options, const std::optional<study::SavedPoint>& chosen) {
  scene::Overrides overrides = options.overrides;
  if (options.until) overrides.push_back(fmt::format("simulation.end={:.17g}", *options.until));
  if (chosen) overrides.insert(overrides.end(), chosen->overrides.begin(), chosen->overrides.end());
  return overrides;
}

}  // namespace tsubu::app
