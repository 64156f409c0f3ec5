#pragma once
// --accuracy and --quality: a setting of a saved study instead of the scene's own.

#include <filesystem>
#include <optional>
#include <string>

#include "app/run.h"
#include "study/report.h"

namespace tsubu::app {

/// A share, from "2%", "2 %" or "0.02". Throws Error(scene).
double shareOf(const std::string& text);

/// The folder of the study that the options name, or else of the scene.
std::filesystem::path studyFolder(const RunOptions& options);

/// What the options ask for, taken from the saved study; nothing when they ask for nothing. Throws Error when there is no study, when it is
/// of another scene, or when no setting of it will do.
std::optional<study::SavedPoint> chosenSetting(const RunOptions& options);

/// The study of this scene with these options, if there is one and it is of this scene.
std::optional<study::SavedStudy> studyOf(const RunOptions& options);

/// All overrides of the options: those of the user, of the end, of the chosen setting.
scene::Overrides allOverrides(const RunOptions& options, const std::optional<study::SavedPoint>& chosen);

}  // namespace tsubu::app
