#pragma once
// What the quality of pictures costs, and what it changes: the same instants drawn at each quality, against the finest.

#include <optional>
#include <string>
#include <vector>

#include "study/trial.h"

namespace tsubu::study {

struct PictureQuality {
  std::string quality;  ///< as in [picture]
  double cost = 0;      ///< CPU seconds of a frame, all threads of the drawing together
  double error = 0;     ///< root mean square over pixels and channels of the difference to the finest, as a share of white
};

/// Runs the scene and draws it at three instants: the beginning, the middle, the end. Nothing when `stop` said so. Throws as run().
std::optional<std::vector<PictureQuality>> comparePictures(const Trial& trial, const Stop& stop);

}  // namespace tsubu::study
