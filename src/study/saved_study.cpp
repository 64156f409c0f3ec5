// A study that was saved, and what is taken from it.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "study/json_file.h"
#include "study/report.h"

namespace tsubu::study {

namespace {

std::string percent(double share) { return fmt::format("{:.3g} %", 100 * share); }

SavedPoint pointIn(const nlohmann::json& json) {
  SavedPoint point;
  point.label = json.at("label");
  point.overrides = json.at("overrides").get<scene::Overrides>();
  point.cost = numberIn(json.at("cost_cpu_seconds"));
  point.pareto = json.at("pareto");
  for (const auto& [name, error] : json.at("errors").items()) {
    const double measured = error.at("error").is_null() ? std::numeric_limits<double>::infinity() : numberIn(error.at("error"));
    const double bound = std::max(measured + numberIn(error.at("noise")), numberIn(error.at("floor")));
    if (!point.worst.empty() && bound <= point.bound) continue;
    point.bound = bound, point.worst = name, point.noise = error.at("none");
  }
  return point;
}

}  // namespace

std::string describe(const SavedPoint& point) {
  return fmt::format("{}: {:.3g} s of CPU, {} within {}{}", point.label, point.cost, point.worst, percent(point.bound),
                     point.noise ? " (noise: no difference was seen)" : "");
}

std::filesystem::path folderOf(const std::string& scene) {
  return std::filesystem::path("out") / (std::filesystem::path(scene).stem().string() + ".tradeoff");
}

SavedStudy readStudy(const std::filesystem::path& file, const std::string& scene) {
  std::ifstream stream(file);
  if (!stream)
    throw Error(ErrorKind::files, fmt::format("There is no study '{}'.", file.string()), fmt::format("make one: tsubu tradeoff {}", scene));
  const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
  try {
    SavedStudy study;
    study.file = file;
    study.key = json.at("scene_key");
    study.given = json.at("given").get<scene::Overrides>();
    study.end = json.at("end");
    for (const auto& each : json.at("points")) {
      if (each.at("errors").empty() || each.contains("failed") || each.at("axis") == "features") continue;
      study.points.push_back(pointIn(each));
      if (each.at("axis") == "reference") study.reference = study.points.back();
    }
    if (!study.reference.label.empty()) return study;
  } catch (const nlohmann::json::exception&) {
    // Said below: what is wrong in it is no matter to the user.
  }
  throw Error(ErrorKind::files, fmt::format("The study '{}' is not complete.", file.string()),
              fmt::format("go on with: tsubu tradeoff {}", scene));
}

void refuseOtherScene(const SavedStudy& study, const std::string& scene, const scene::Overrides& overrides, const std::string& version) {
  if (keyOfStudy({scene, overrides}, study.end, version) == study.key) return;
  std::string given;
  for (const std::string& override : study.given)
    if (!override.starts_with("simulation.end=")) given += " --set '" + override + "'";
  throw Error(ErrorKind::scene,
              fmt::format("The study '{}' is of another scene, or the scene has been changed since.", study.file.string()),
              given.empty() ? fmt::format("make a new one: tsubu tradeoff {}", scene) : fmt::format("it was made with{}", given));
}

const SavedPoint& cheapestWithin(const SavedStudy& study, double accuracy) {
  const SavedPoint* best = nullptr;
  const SavedPoint* nearest = nullptr;
  for (const SavedPoint& point : study.points) {
    if (point.bound <= accuracy && (!best || point.cost < best->cost)) best = &point;
    if (!nearest || point.bound < nearest->bound) nearest = &point;
  }
  if (best) return *best;
  throw Error(ErrorKind::scene,
              fmt::format("No setting of the study is within {}. The nearest is {}.", percent(accuracy), describe(*nearest)),
              nearest->noise ? "more --seeds make the noise smaller" : "a larger --budget gives a finer reference");
}

const SavedPoint& pointOfQuality(const SavedStudy& study, const std::string& quality) {
  if (quality == "reference") return study.reference;
  if (quality != "draft" && quality != "standard")
    throw Error(ErrorKind::scene, fmt::format("There is no quality '{}': expected draft, standard or reference.", quality));
  const double wanted = quality == "draft" ? draftAccuracy : standardAccuracy;
  // Cost decides among those within, accuracy among the others, which come after.
  const auto rank = [wanted](const SavedPoint& point) {
    return point.bound <= wanted ? std::pair(0, point.cost) : std::pair(1, point.bound);
  };
  const SavedPoint* best = &study.reference;
  for (const SavedPoint& point : study.points)
    if (point.pareto && rank(point) < rank(*best)) best = &point;
  return *best;
}

std::string qualitiesOf(const SavedStudy& study) {
  std::string text = fmt::format("qualities      as measured in {}\n", study.file.string());
  for (const auto& [name, meaning] : {std::pair{"draft", fmt::format("the cheapest within {}", percent(draftAccuracy))},
                                      std::pair{"standard", fmt::format("the cheapest within {}", percent(standardAccuracy))},
                                      std::pair{"reference", std::string("the finest step")}})
    text += fmt::format("  {:<13}{}: {}\n", name, meaning, describe(pointOfQuality(study, name)));
  return text;
}

std::string noticedOf(const std::filesystem::path& folder, const std::string& scene, const scene::Overrides& overrides,
                      const std::string& version) {
  std::ifstream stream(folder / "features.json");
  const nlohmann::json json = stream ? nlohmann::json::parse(stream, nullptr, false) : nlohmann::json();
  try {
    if (!stream || keyOfStudy({scene, overrides}, json.at("end"), version) != json.at("scene_key")) return {};
    std::string text = fmt::format("features       as measured in {}\n", (folder / "features.json").string());
    for (const auto& point : json.at("points")) {
      if (point.at("axis") != "features" || point.contains("refused") || (point.at("errors").empty() && !point.contains("failed")))
        continue;
      std::string noticed;
      for (const auto& [name, error] : point.at("errors").items())
        if (!error.at("none").get<bool>())
          noticed += fmt::format("{}{} {}", noticed.empty() ? "" : ", ", name,
                                 error.at("error").is_null() ? "not reached" : percent(numberIn(error.at("error"))));
      const std::string what = point.contains("failed") ? "the run fails" : noticed.empty() ? "makes no difference" : "changes " + noticed;
      text += fmt::format("  {:<28}{}\n", point.at("label").get<std::string>(), what);
    }
    return text;
  } catch (const nlohmann::json::exception&) {
    return {};  // no study, then
  }
}

}  // namespace tsubu::study
