#include "app/progress.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace tsubu::app {

namespace {

std::string duration(double seconds) {
  const auto whole = static_cast<long>(seconds + 0.5);
  return whole < 3600 ? fmt::format("{}:{:02}", whole / 60, whole % 60)
                      : fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace

ProgressLine::ProgressLine(std::FILE* stream) : stream_(stream), terminal_(isatty(fileno(stream)) == 1), shown_(start_) {}

double ProgressLine::secondsSinceStart() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void ProgressLine::show(const Progress& progress, bool last) {
  const auto now = Clock::now();
  if (!last && std::chrono::duration<double>(now - shown_).count() < (terminal_ ? 0.2 : 10.0)) return;
  shown_ = now;
  const double seconds = secondsSinceStart();
  std::string line = fmt::format("t = {:.4g} of {:.4g} s", progress.time, progress.end);
  if (progress.frames > 0) line += fmt::format("   frame {} of {}", progress.frame, progress.frames);
  line += fmt::format("   {:.2f} M grain-steps/s", progress.grainSteps / std::max(seconds, 1e-9) * 1e-6);
  if (last)
    line += fmt::format("   took {}", duration(seconds));
  else if (progress.time > 0)
    line += fmt::format("   {} left", duration(seconds * (progress.end - progress.time) / progress.time));
  if (terminal_)
    fmt::print(stream_, "\r\033[K{}{}", line, last ? "\n" : "");
  else
    fmt::print(stream_, "{}\n", line);
  std::fflush(stream_);
}

}  // namespace tsubu::app
