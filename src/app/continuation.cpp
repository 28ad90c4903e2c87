// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/continuation.hpp"

#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

#include "krater/core/errors.hpp"

namespace krater {

namespace {

constexpr std::size_t kListed = 20;  // keys that differ in one message

}  // namespace

std::string quoted(const std::string& word) {
  if (!word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                              "0123456789_-+./=:,@%") == std::string::npos)
    return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string{"'\\''"} : std::string{c};
  return out + "'";
}

std::string command(const RunOptions& options, const std::string& folder) {
  std::string text = "krater run " + quoted(options.scene);
  for (const std::string& setting : options.overrides) text += " --set " + quoted(setting);
  if (options.threads > 0) text += fmt::format(" -j {}", options.threads);
  return text + " -o " + quoted(folder);
}

void add_command(Json& machine, const RunOptions& options, const std::string& folder) {
  machine["command"] = Json::of(command(options, folder));
  machine["set"] = Json::array();
  for (const std::string& setting : options.overrides)
    machine["set"].items.push_back(Json::of(setting));
}

std::string continuation(const RunOptions& options, const std::string& folder) {
  return command(options, folder) + " --restart " + quoted(folder + "/checkpoint.h5");
}

std::vector<SceneDifference> require_same_scene(const Checkpoint& checkpoint,
                                                const std::string& file, const Scene& scene) {
  const CheckpointBlob* text = checkpoint.find("scene");
  if (text == nullptr) throw InputError(file + ": it names no scene");
  std::vector<SceneDifference> differences = scene_differences(text->text, scene.resolved);
  std::string list;
  std::size_t refused = 0;
  for (const SceneDifference& d : differences) {
    if (may_differ(d) || ++refused > kListed) continue;
    list += fmt::format("\n  {}: {} in the checkpoint, {} in the scene", d.path, d.before, d.now);
  }
  if (refused == 0) return differences;
  if (refused > kListed) list += fmt::format("\n  and {} more", refused - kListed);
  throw InputError(file +
                   ": it belongs to another scene; restart with the scene and the --set options it "
                   "was written with (title, time, output, measures, references may change):" +
                   list);
}

void restore(Simulation& sim, const Checkpoint& checkpoint, const std::string& file) {
  try {
    sim.restore(checkpoint);
  } catch (const InputError& e) {
    throw InputError(file + ": " + e.what());
  } catch (const std::out_of_range&) {
    throw InputError(file + ": damaged, or written by another version of krater");
  }
}

std::string default_output(const std::string& scene) {
  return std::filesystem::path(scene).stem().string() + "_out";
}

}  // namespace krater
