#pragma once
// The one place that talks to people.

#include <string>

namespace tsubu::app {

/// "warning: …" on stderr, on a line of its own even when a progress line is there.
void warn(const std::string& message);
/// "error: …" on stderr.
void complain(const std::string& message);

}  // namespace tsubu::app
