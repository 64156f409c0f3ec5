#pragma once
// How alike are two pictures? Three tiers, after rendering tests of Mesa (exact sums), pygfx (a few levels) and VTK (SSIM): a picture from
// the same renderer must be the same; another driver may round differently; nothing may look different.

#include <string>

#include "core/image.h"

namespace tsubu::test {

enum class Tier {
  exact,       ///< the same bytes
  tight,       ///< no channel more than 3 levels apart, and at most 0.1 % of the pixels different at all
  perceptual,  ///< what an eye at normal distance would call the same, everywhere in the picture
  different,
};

struct Comparison {
  Tier tier = Tier::different;
  bool sameSize = false;
  int worstLevels = 0;     ///< largest difference of a channel, 0 to 255
  double differing = 0;    ///< share of pixels that are not equal
  double ssim = 0;         ///< mean structural similarity of the lightness, 1 for equal pictures
  double flip = 0;         ///< mean of the FLIP-like difference, 0 to 1
  double worstWindow = 0;  ///< its largest mean over a window of 7 × 7 pixels: one wrong grain does not drown in a large picture

  bool reaches(Tier required) const { return static_cast<int>(tier) <= static_cast<int>(required); }
  /// All the numbers in a sentence.
  std::string text() const;
};

Comparison compareImages(const Image& expected, const Image& actual);

/// Equal pixels in dim grey, different ones from dark red (one level) to white.
Image differencePicture(const Image& expected, const Image& actual);

}  // namespace tsubu::test
