#pragma once
// Ctrl-C ends a run after the current frame. A second one ends the program at once.

namespace tsubu::app {

/// From now on SIGINT and SIGTERM are noted instead of ending the program.
void watchForInterrupt();
bool interrupted();

}  // namespace tsubu::app
