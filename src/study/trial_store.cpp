#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/hash.h"
#include "io/text_file.h"
#include "scene/writer.h"
#include "study/json_file.h"
#include "study/trial.h"

namespace tsubu::study {

namespace {

// What a file of an outcome holds; another number makes all older ones unknown.
constexpr std::uint64_t format = 1;

void addText(Hash& hash, const std::string& text) {
  hash.add(std::uint64_t{text.size()});
  for (std::size_t at = 0; at < text.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, text.data() + at, std::min<std::size_t>(8, text.size() - at));
    hash.add(word);
  }
}

// Of a scene, what its motion depends on: not its looks.
scene::Scene withoutPictures(scene::Scene scene) {
  const scene::Scene plain;
  scene.title.clear();
  scene.picture = plain.picture;
  scene.background = plain.background;
  scene.light = plain.light;
  scene.camera = plain.camera;
  scene.colours = plain.colours;
  scene.show = plain.show;
  scene.overlay = plain.overlay;
  for (scene::Material& material : scene.materials) material.colour.reset();
  for (scene::Wall& wall : scene.walls) {
    wall.look = scene::Look::automatic;
    wall.colour.reset();
    wall.opacity.reset();
  }
  return scene;
}

std::string keyOf(const scene::Scene& scene, const std::string& version) {
  Hash hash;
  hash.add(format);
  addText(hash, version);
  addText(hash, scene::write(withoutPictures(scene)));
  for (const scene::Wall& wall : scene.walls)
    if (const auto* mesh = std::get_if<scene::MeshShape>(&wall.shape))
      addText(hash, io::readTextFile(scene::resolved(scene, mesh->file), "mesh"));
  for (const scene::GrainSource& source : scene.grains)
    if (const auto* from = std::get_if<scene::FromFile>(&source.from))
      addText(hash, io::readTextFile(scene::resolved(scene, from->file), "table of grains"));
  return hash.text();
}

}  // namespace

std::string keyOf(const Trial& trial, const std::string& version) { return keyOf(scene::read(trial.scene, trial.overrides), version); }

std::string keyOfStudy(Trial trial, double end, const std::string& version) {
  trial.overrides.push_back("simulation.seed=0");
  trial.overrides.push_back(fmt::format("simulation.end={:.17g}", end));
  return keyOf(trial, version);
}

TrialStore::TrialStore(std::filesystem::path folder, std::string version) : folder_(std::move(folder)), version_(std::move(version)) {
  makeFolder(folder_);
}

std::optional<Outcome> TrialStore::find(const Trial& trial) const {
  std::ifstream file(folder_ / (keyOf(trial, version_) + ".json"));
  if (!file) return std::nullopt;
  const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
  try {
    Outcome outcome;
    for (const auto& value : json.at("values"))
      outcome.values.push_back({value.at("name"), value.at("unit"), numberIn(value.at("value")), numberIn(value.at("scale"))});
    outcome.cost = json.at("cpu_seconds");
    outcome.wall = json.value("wall_seconds", outcome.cost);
    outcome.timeStep = json.at("dt");
    outcome.limit = json.at("dt_limit");
    outcome.steps = json.at("steps");
    outcome.grainSteps = json.at("grain_steps");
    outcome.grains = json.at("grains");
    outcome.failure = json.at("failure");
    outcome.stateHash = json.at("state_hash");
    return outcome;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

void TrialStore::keep(const Trial& trial, const Outcome& outcome) const {
  nlohmann::ordered_json json;
  json["command"] = commandOf(trial);
  json["version"] = version_;
  json["values"] = nlohmann::ordered_json::array();
  for (const Measured& value : outcome.values)
    json["values"].push_back({{"name", value.name}, {"unit", value.unit}, {"value", jsonOf(value.value)}, {"scale", jsonOf(value.scale)}});
  json["cpu_seconds"] = outcome.cost;
  json["wall_seconds"] = outcome.wall;
  json["dt"] = outcome.timeStep;
  json["dt_limit"] = outcome.limit;
  json["steps"] = outcome.steps;
  json["grain_steps"] = outcome.grainSteps;
  json["grains"] = outcome.grains;
  json["failure"] = outcome.failure;
  json["state_hash"] = outcome.stateHash;
  writeJson(folder_ / (keyOf(trial, version_) + ".json"), json);
}

}  // namespace tsubu::study
