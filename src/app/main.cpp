// The command line. Exit codes: 0 fine, 1 the simulation failed, 2 scene or usage, 3 files, 130 interrupted.

#include <cstdio>
#include <exception>
#include <new>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/chosen_setting.h"
#include "app/large_arrays.h"
#include "app/messages.h"
#include "app/run.h"
#include "app/stability.h"
#include "app/tradeoff.h"
#include "app/version.h"
#include "core/error.h"
#include "scene/build.h"
#include "scene/explain.h"
#include "scene/reader.h"
#include "scene/reference.h"

namespace tsubu::app {
namespace {

struct Commands {
  CLI::App* run;
  CLI::App* explain;
  CLI::App* check;
  CLI::App* reference;
  CLI::App* tradeoff;
  CLI::App* stability;
};

void addSceneOptions(CLI::App& command, std::string& scene, scene::Overrides& overrides) {
  command.add_option("SCENE", scene, "Scene file (TOML)")->required();
  command.add_option("--set", overrides, "Override a value: path.to.key=value (may be given several times)")
      ->take_all()
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
}

void addTradeoffOptions(CLI::App& command, TradeoffOptions& options) {
  addSceneOptions(command, options.scene, options.overrides);
  command.add_option("-o,--output", options.folder, "Folder for the study (out/NAME.tradeoff when not given)")->type_name("DIR");
  command
      .add_option(
          "--axes", options.axes,
          "What to turn: step, stiffness, integrator, grains, law, memory, rolling, precision, skin (all when not given), and picture")
      ->delimiter(',');
  command.add_flag("--features", options.features, "Switch features off instead: which of them does the scene notice?");
  command.add_option("--budget", options.budget, "Time for all trials: 90s, 10m, 1h (10m when not given)");
  command.add_option("--seeds", options.seeds, "Trials of each setting (3 when not given)")->check(CLI::Range(1, 1000));
  command.add_option("--until", options.until, "End trials at this time instead of the scene's");
  command.add_option("--threads", options.threads, "Trials at a time (all cores when not given)")->check(CLI::Range(1, 1024));
}

Commands describe(CLI::App& app, RunOptions& options, TradeoffOptions& study) {
  app.set_version_flag("--version", fmt::format("tsubu {}", version));
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::help);
  Commands commands{app.add_subcommand("run", "Simulate a scene and write its film"),
                    app.add_subcommand("explain", "Print the plan of a scene: what is modelled, what it costs"),
                    app.add_subcommand("check", "Validate a scene and its files, and run nothing"),
                    app.add_subcommand("reference", "Print the reference of scene files (Markdown)"),
                    app.add_subcommand("tradeoff", "Measure what speed costs in accuracy: the scene at many settings"),
                    app.add_subcommand("stability", "Find the step at which a scene blows up, against the rules that predict it")};
  for (CLI::App* command : {commands.run, commands.explain, commands.check}) addSceneOptions(*command, options.scene, options.overrides);
  addTradeoffOptions(*commands.tradeoff, study);
  addSceneOptions(*commands.stability, options.scene, options.overrides);
  commands.stability
      ->add_option("--at", options.until, "Try the state that the scene has at this time, in seconds (its end when not given)")
      ->check(CLI::NonNegativeNumber);
  for (CLI::App* command : {commands.run, commands.explain}) {
    command->add_option("--accuracy", options.accuracy,
                        "The cheapest setting that the study of the scene has found to be within this: 2% (see tradeoff)");
    command->add_option("--quality", options.quality, "draft, standard or reference: a setting of the study of the scene");
    command->add_option("--study", options.study, "Folder of the study (out/NAME.tradeoff when not given)")->type_name("DIR");
  }
  commands.run->add_option("-o,--output", options.folder, "Folder for the results (out/NAME when not given)")->type_name("DIR");
  commands.run
      ->add_option("--threads", options.threads,
                   "Threads of the simulation; the results do not depend on it (as many of the cores as help when not given)")
      ->check(CLI::Range(1, 1024));
  commands.run->add_option("--until", options.until, "End at this time instead of the scene's, in seconds")->check(CLI::NonNegativeNumber);
  commands.run->add_flag("!--no-frames", options.frames, "Simulate only");
  commands.run->add_flag("--profile", options.profile, "Say at the end where the time of the simulation went");
  commands.run->add_option("--isa", options.isa, "Force an instruction set: portable, avx2 or avx512; the results do not depend on it");
  return commands;
}

int execute(const Commands& commands, const RunOptions& options, const TradeoffOptions& study) {
  if (*commands.tradeoff) return tradeoff(study);
  if (*commands.run) return run(options);
  if (*commands.stability) return stability(options);
  if (*commands.reference) {
    fmt::print("{}", scene::writeReference());
    return 0;
  }
  std::vector<Diagnostic> odd;
  const auto chosen = chosenSetting(options);
  const scene::Scene scene = scene::read(options.scene, allOverrides(options, chosen), &odd);
  for (const Diagnostic& warning : odd) warn(toString(warning));
  if (*commands.explain) {
    fmt::print("{}", scene::explain(scene));
    if (chosen) fmt::print("setting        {}\n", study::describe(*chosen));
    if (const auto saved = studyOf(options)) fmt::print("{}", study::qualitiesOf(*saved));
    fmt::print("{}", study::noticedOf(studyFolder(options), options.scene, options.overrides, version));
    return 0;
  }
  const scene::Built built = scene::build(scene);
  for (const std::string& warning : built.warnings) warn(warning);
  for (const std::string& note : built.notes) fmt::print("note: {}\n", note);
  fmt::print("{}: fine.\n", options.scene);
  return 0;
}

int mainOf(int argc, char** argv) {
  CLI::App app("tsubu: films of granular flow from a text scene, off screen", "tsubu");
  RunOptions options;
  TradeoffOptions study;
  const Commands commands = describe(app, options, study);
  try {
    app.parse(argc, argv);
    return execute(commands, options, study);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ErrorKind::scene);
  } catch (const Error& error) {
    for (const Diagnostic& diagnostic : error.diagnostics()) complain(toString(diagnostic));
    return static_cast<int>(error.kind());
  } catch (const std::bad_alloc&) {
    complain("There is not enough memory for this scene.");
    return static_cast<int>(ErrorKind::simulation);
  } catch (const std::exception& error) {
    complain(error.what());
    return static_cast<int>(ErrorKind::simulation);
  }
}

}  // namespace
}  // namespace tsubu::app

int main(int argc, char** argv) {
  tsubu::app::returnLargeArrays();
  return tsubu::app::mainOf(argc, argv);
}
