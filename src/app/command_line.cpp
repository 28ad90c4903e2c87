// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/command_line.hpp"

#include <cstdio>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "krater/app/point.hpp"
#include "krater/app/progress.hpp"
#include "krater/app/run.hpp"
#include "krater/app/study.hpp"
#include "krater/app/version.hpp"
#include "krater/core/errors.hpp"
#include "krater/core/isa_level.hpp"
#include "krater/core/ranks.hpp"
#include "krater/output/results.hpp"
#include "krater/scene/schema.hpp"

namespace krater {

namespace {

void add_scene_options(CLI::App* command, RunOptions& options) {
  command->add_option("scene", options.scene, "scene file (YAML)")->required();
  command
      ->add_option("--set", options.overrides,
                   "override a value: path=value, e.g. --set grid.cell=0.2mm (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
}

/// Subcommands of the command line.
struct Commands {
  const CLI::App &run, &check, &point, &study, &schema;
};

/// `krater run --accuracy`: the same run at several cells.
std::vector<std::string> words_of_accuracy(const RunOptions& options) {
  if (!options.restart.empty())
    throw InputError(
        "--restart: a run to an accuracy goes on by itself from what lies in its folder");
  std::vector<std::string> words{"accuracy", options.scene, options.accuracy};
  const auto add = [&words](const char* key, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {key, value});
  };
  add("--budget", options.budget);
  add("--measures", options.measures);
  add("-o", options.output);
  if (options.threads > 0) add("-j", std::to_string(options.threads));
  for (const std::string& setting : options.overrides) add("--set", setting);
  return words;
}

std::vector<std::string> words_of_study(const CLI::App& command) {
  std::vector<std::string> words{"study"};
  for (const std::string& word : command.remaining()) words.push_back(word);
  return words;
}

/// What `krater models` is asked.
struct ModelQuery {
  std::string name, cards;
  bool json = false;
};

int dispatch(const Commands& commands, const RunOptions& options, const ModelQuery& query) {
  try {
    if (!ranks::alone() && !options.accuracy.empty())
      throw InputError("--accuracy makes many runs; start krater without mpirun");
    if (!commands.run.parsed() || !options.accuracy.empty()) {
      if (!ranks::first()) return kDone;
      ranks::part();
    }
    if (commands.study.parsed()) return become_study(words_of_study(commands.study));
    if (!options.accuracy.empty()) return become_study(words_of_accuracy(options));
    if (commands.run.parsed()) return run(options);
    if (commands.check.parsed())
      print_check(options);
    else if (commands.point.parsed())
      run_point(options);
    else if (commands.schema.parsed())
      fmt::print("{}", schema_text(options.scene == "point"));
    else if (!query.cards.empty())
      print_cards(query.cards);
    else
      (query.json ? print_models_json : print_models)(query.name.empty() ? nullptr
                                                                         : query.name.c_str());
    if (std::fflush(stdout) == 0) return kDone;
    say("krater: standard output cannot be written");
    return kBadInput;
  } catch (const InputError& e) {
    say(e.what());
    return kBadInput;
  } catch (const OutputError& e) {
    say(
        fmt::format("krater: {}; make room, or choose another folder with -o (the last checkpoint "
                    "is whole)",
                    e.what()));
    return kBadInput;
  } catch (const std::bad_alloc&) {
    say("krater: not enough memory for this scene: use a larger grid.cell or fewer "
        "points_per_direction");
    return kBadInput;
  } catch (const std::system_error& e) {  // of fmt::print
    say(fmt::format("krater: standard output cannot be written: {}", e.what()));
    return kBadInput;
  } catch (const std::exception& e) {
    say(fmt::format("krater: {}", e.what()));
    return kNumericalFailure;
  }
}

void add_models(CLI::App& app, ModelQuery& query) {
  CLI::App* command =
      app.add_subcommand("models", "list the material laws and cards, or describe one");
  command->add_option("name", query.name, "law or card");
  CLI::Option* cards = command->add_option(
      "--cards", query.cards, "find cards: a word of their names, comments or laws, as steel");
  command->add_flag("--json", query.json, "print one JSON object instead of text")->excludes(cards);
}

CLI::App& add_schema(CLI::App& app, RunOptions& options) {
  CLI::App* command =
      app.add_subcommand("schema", "print the JSON schema of scenes, for editors that know YAML");
  command->add_option("of", options.scene, "scene (the default), or point: loading paths")
      ->check(CLI::IsMember({"scene", "point"}));
  return *command;
}

/// CLI11 says only that a command is missing.
bool report_unknown_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return false;
  std::string known;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == argv[1]) return false;
    known += (known.empty() ? "" : ", ") + command->get_name();
  }
  say(fmt::format("krater: unknown command '{}' (known: {}); see krater --help", argv[1], known));
  return true;
}

/// `krater run --accuracy`, and what only goes with it.
CLI::Option* add_accuracy(CLI::App& run_command, RunOptions& options) {
  CLI::Option* accuracy = run_command.add_option(
      "--accuracy", options.accuracy,
      "run coarse, then finer cells until every measure is known so well, as 2%");
  run_command
      .add_option("--budget", options.budget, "wall time for --accuracy, as 20min (the default)")
      ->needs(accuracy);
  run_command
      .add_option("--measures", options.measures,
                  "those that --accuracy must reach, as length,width (default: all)")
      ->needs(accuracy);
  return accuracy;
}

}  // namespace

int command_line(int argc, char** argv) {
  CLI::App app{"Krater: impact by the Material Point Method"};
  app.name("krater");
  const Version v = version();
  app.set_version_flag("--version", [v] {
    return fmt::format("krater {} ({}, {}, {})\nbuilt with: {}\nruns with: {}, {}", v.program,
                       v.revision, v.compiler, v.build, v.options, name_of(best_isa_level()),
                       ranks::description());
  });
  app.require_subcommand(1);
  RunOptions options;
  ModelQuery query;
  CLI::App* run_command = app.add_subcommand("run", "compute a scene");
  add_scene_options(run_command, options);
  run_command->add_option("-o,--output", options.output, "results folder (default: SCENE_out)");
  run_command
      ->add_option("-j,--threads", options.threads, "threads (default: what the scene keeps busy)")
      ->check(CLI::Range(1, 4096));
  run_command->add_option("--restart", options.restart, "continue from a checkpoint.h5");
  run_command->add_flag("--quiet", options.quiet,
                        "no progress, no notes; warnings at the end only");
  run_command->add_flag("--strict", options.strict, "exit code 5 when the run ends with warnings");
  CLI::Option* json = run_command->add_flag(
      "--json", options.json, "at the end print one JSON object: summary.json and the exit code");
  add_accuracy(*run_command, options)->excludes(json);
  CLI::App* check_command =
      app.add_subcommand("check", "read a scene and say what would be computed and what it costs");
  add_scene_options(check_command, options);
  check_command->add_option("-o,--output", options.output,
                            "also write the points at the start into this folder "
                            "(tools/plot_scene draws them)");
  check_command->add_flag("--json", options.json, "print one JSON object instead of text");
  CLI::App* point_command = app.add_subcommand("point", "take one material through a loading path");
  add_scene_options(point_command, options);
  point_command->add_option("-o,--output", options.output, "results folder (default: FILE_out)");
  point_command->add_flag("--quiet", options.quiet, "no table, no notes");
  add_models(app, query);
  const CLI::App& schema = add_schema(app, options);
  CLI::App* study_command = app.add_subcommand(
      "study", "many runs of one scene: accuracy, settings, effects, limits, calibration");
  study_command->set_help_flag();  // the package's own
  study_command->prefix_command();
  if (report_unknown_command(app, argc, argv)) return kBadInput;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? kDone : kBadInput;
  } catch (const InputError& e) {  // --version under an unknown $KRATER_ISA
    say(e.what());
    return kBadInput;
  }
  return dispatch({*run_command, *check_command, *point_command, *study_command, schema}, options,
                  query);
}

}  // namespace krater
