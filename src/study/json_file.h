#pragma once
// JSON in files: complete or not at all, and numbers that may not be.

#include <filesystem>

#include <nlohmann/json.hpp>

namespace tsubu::study {

/// Makes the folder and those above it. Throws Error(files).
void makeFolder(const std::filesystem::path& folder);

/// Throws Error(files).
void writeText(const std::filesystem::path& path, const std::string& text);
void writeJson(const std::filesystem::path& path, const nlohmann::ordered_json& json);

/// NaN and infinity are null: JSON has no word for them.
nlohmann::ordered_json jsonOf(double value);
double numberIn(const nlohmann::json& json);

}  // namespace tsubu::study
