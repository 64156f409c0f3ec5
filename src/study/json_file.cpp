#include "study/json_file.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "core/error.h"

namespace tsubu::study {

void makeFolder(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error(ErrorKind::files, fmt::format("Cannot make the folder '{}': {}.", folder.string(), failed.message()));
}

void writeText(const std::filesystem::path& path, const std::string& text) {
  // A name of its own for each thread: two may come to the same trial.
  std::ostringstream thread;
  thread << std::this_thread::get_id();
  const std::filesystem::path unfinished = fmt::format("{}.{}.part", path.string(), thread.str());
  std::ofstream file(unfinished, std::ios::binary);
  file << text;
  file.close();
  std::error_code failed;
  if (file) std::filesystem::rename(unfinished, path, failed);
  if (!file || failed) throw Error(ErrorKind::files, fmt::format("Cannot write '{}'.", path.string()));
}

void writeJson(const std::filesystem::path& path, const nlohmann::ordered_json& json) {
  writeText(path, json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

nlohmann::ordered_json jsonOf(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

double numberIn(const nlohmann::json& json) { return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>(); }

}  // namespace tsubu::study
