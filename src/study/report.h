#pragma once
// What a study leaves behind: a table to read, tradeoff.csv, tradeoff.json, and a script for gnuplot.

#include <filesystem>
#include <string>

#include "study/tradeoff.h"

namespace tsubu::study {

/// The table, with the front marked; what was left out, refused, failed.
std::string tableOf(const Study& study);
/// One row for each setting and observable.
std::string csvOf(const Study& study);
/// Everything, trials included.
void writeStudy(const std::filesystem::path& file, const Study& study);
/// \brief For gnuplot, which runs it in the folder of tradeoff.csv: cost against error for each observable (cost_NAME.png), error against
/// each axis that has numbers (axis_NAME.png).
std::string plotScriptOf(const Study& study);

/// What `tsubu run --accuracy` and `--quality` need of a saved study.
struct SavedPoint {
  std::string label;
  scene::Overrides overrides;
  double cost = 0;
  double bound = 0;    ///< no observable is farther from the reference, as measured
  std::string worst;   ///< the observable that the bound is of
  bool noise = false;  ///< is the bound noise, and no measured difference?
  bool pareto = false;
};
struct SavedStudy {
  std::filesystem::path file;
  std::string key;
  scene::Overrides given;  ///< that the study was made with
  double end = 0;          ///< s: trials ran until then
  SavedPoint reference;
  std::vector<SavedPoint> points;  ///< all that ran to their ends, the reference included
};

/// Throws Error(files) when there is none or it cannot be read: the message says which command makes one.
SavedStudy readStudy(const std::filesystem::path& file, const std::string& scene);

/// The study of a scene: out/NAME.tradeoff/tradeoff.json.
std::filesystem::path folderOf(const std::string& scene);

/// \brief The cheapest setting with a bound of at most `accuracy` (a share).
/// Throws Error(scene) when there is none, with the best that there is.
const SavedPoint& cheapestWithin(const SavedStudy& study, double accuracy);

/// Three points of the front: draft, the cheapest within 10 %; standard, the cheapest within 3 %; reference, the finest. Where nothing is
/// within, the most accurate on the front.
inline constexpr double draftAccuracy = 0.10, standardAccuracy = 0.03;
/// Throws Error(scene) for another word.
const SavedPoint& pointOfQuality(const SavedStudy& study, const std::string& quality);

/// Throws Error(scene) when the scene with these overrides is not the one that was studied: seed, end and pictures apart.
void refuseOtherScene(const SavedStudy& study, const std::string& scene, const scene::Overrides& overrides, const std::string& version);

/// What `tsubu tradeoff --features` has found, for `tsubu explain`: which features the scene notices. Empty when there is no such study of
/// this scene in the folder.
std::string noticedOf(const std::filesystem::path& folder, const std::string& scene, const scene::Overrides& overrides,
                      const std::string& version);

/// "step 0.9: 1.2 s of CPU, rate within 2.1 %"
std::string describe(const SavedPoint& point);

/// The three points and their errors, for `tsubu explain`.
std::string qualitiesOf(const SavedStudy& study);

}  // namespace tsubu::study
