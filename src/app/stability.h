#pragma once
// tsubu stability: the step at which a scene blows up.

#include "app/run.h"

namespace tsubu::app {

/// Of the options: scene, overrides, and `until` for the state to be tried. Prints the table. Returns the exit code: 0, or 130 when
/// interrupted.
int stability(const RunOptions& options);

}  // namespace tsubu::app
