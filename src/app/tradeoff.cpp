#include "app/tradeoff.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <thread>

#include <fmt/format.h>

#include "app/interrupt.h"
#include "app/messages.h"
#include "app/version.h"
#include "core/error.h"
#include "study/json_file.h"
#include "study/report.h"

extern char** environ;

namespace tsubu::app {

namespace {

namespace fs = std::filesystem;

// gnuplot in a folder, without a shell; its exit code, or -1 when there is none.
int gnuplot(const fs::path& folder) {
  const std::string cd = fmt::format("cd \"{}\"", folder.string());
  std::string name = "gnuplot", e = "-e", script = "plot.gp";
  std::string load = cd + "; load \"" + script + "\"";
  char* arguments[] = {name.data(), e.data(), load.data(), nullptr};
  pid_t process = 0;
  // What it says of a single point on an axis is of no use to anybody; whoever wants to know calls it by hand.
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, 2, "/dev/null", O_WRONLY, 0);
  const int failure = posix_spawnp(&process, "gnuplot", &quiet, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&quiet);
  if (failure != 0) return -1;
  int status = 0;
  if (waitpid(process, &status, 0) < 0 || !WIFEXITED(status)) return -1;
  return WEXITSTATUS(status) == 127 ? -1 : WEXITSTATUS(status);
}

void plot(const study::Study& study, const fs::path& folder) {
  if (study.observables.empty()) return;
  study::writeText(folder / "plot.gp", study::plotScriptOf(study));
  const int code = gnuplot(folder);
  if (code < 0)
    warn("There are no plots: gnuplot is not installed (apt-get install gnuplot-nox). Everything else is there; later: gnuplot plot.gp.");
  if (code > 0) warn(fmt::format("There are no plots: gnuplot ended with {}. In {}: gnuplot plot.gp.", code, folder.string()));
}

}  // namespace

double secondsOf(const std::string& text) {
  double value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit = failure == std::errc() ? text.substr(static_cast<std::size_t>(end - text.data())) : "?";
  const double factor = unit.empty() || unit == "s" ? 1 : unit == "m" || unit == "min" ? 60 : unit == "h" ? 3600 : 0;
  if (!(value * factor > 0) || value * factor > 1e9)
    throw Error(ErrorKind::scene, fmt::format("'{}' is not a time.", text), "write 90s, 10m or 1h");
  return value * factor;
}

int tradeoff(const TradeoffOptions& options) {
  study::Request request;
  request.scene = options.scene;
  request.overrides = options.overrides;
  if (!options.until.empty()) request.overrides.push_back(fmt::format("simulation.end={:.17g}", secondsOf(options.until)));
  request.axes = options.axes;
  request.features = options.features;
  request.budget = secondsOf(options.budget);
  request.seeds = options.seeds;
  request.threads = options.threads > 0 ? options.threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  request.version = version;
  request.folder = options.folder.empty() ? study::folderOf(options.scene) : fs::path(options.folder);

  watchForInterrupt();
  const study::Study study = study::tradeoff(
      request, [] { return interrupted(); },
      [](const study::Progress& progress) {
        fmt::print(stderr, "trial {} of {}, {:.0f} of {:.0f} s: {}\n", progress.done, progress.planned, progress.used, progress.budget,
                   progress.label);
      });
  const std::string name = options.features ? "features" : "tradeoff";
  study::writeText(request.folder / (name + ".csv"), study::csvOf(study));
  study::writeStudy(request.folder / (name + ".json"), study);
  fmt::print("{}", study::tableOf(study));
  if (!options.features) plot(study, request.folder);
  fmt::print("{}: {} trials run, {} known; {}.csv, {}.json\n", request.folder.string(), study.ran, study.known, name, name);
  return study.complete ? 0 : 130;
}

}  // namespace tsubu::app
