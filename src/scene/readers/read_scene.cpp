// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstddef>
#include <filesystem>

#include "krater/scene/scene.hpp"
#include "scene/readers/readers.hpp"

namespace krater {

namespace {

using namespace scene;

constexpr std::size_t kLongestTitle = 1000;  // an attribute of every file of results

/// False after a problem.
bool read_frame(Block& root, Scene& scene) {
  Words<Frame> words;
  for (Frame frame : all_frames) words.emplace_back(name(frame).data(), frame);
  const std::size_t before = root.problems().size();
  scene.frame = root.choice<Frame>("frame", words, Frame::cartesian_3d);
  return root.problems().size() == before;
}

void read_body_force(Block& root, Reading& reading) {
  const Node* node = root.find("body_force");
  if (!node) return;
  if (const std::optional<ReadField> field = read_field(*node, "m/s^2", reading)) {
    reading.scene.body_force = field->field;
    root.record("body_force", field->resolved);
  }
}

/// Without a frame nothing else can be judged: only what the file as a whole has and lacks is said.
void require_blocks(const Node& tree, Block& root) {
  const bool framed = tree.find("frame") != nullptr;
  if (!framed) root.fail("missing key 'frame' (axisymmetric, plane_strain or 3d)");
  for (const char* key : {"grid", "time", "materials", "bodies"}) {
    if (!tree.find(key)) root.fail("missing key '" + std::string{key} + "'");
  }
  if (framed) return;
  for (const KeyInfo& info : scene_block().keys) root.find(info.key.c_str());
  root.finish();
}

/// What the run is for: the fates of projectiles, and when it may end for them.
void read_answers(Block& root, Reading& reading) {
  root.record("gauges", read_gauges(root.find_block("gauges"), reading));
  root.record("outcomes", read_outcomes(root.find_block("outcomes"), reading));
  const Node* time = root.find("time");
  const Node* stop = time ? time->find("stop_when") : nullptr;
  if (stop) read_stop(*stop, reading);
}

void read_blocks(Block& root, Reading& reading) {
  root.record("grid", read_grid(root.find("grid"), reading));
  root.record("time", read_time(root.find("time"), reading));
  root.record("method", read_method(root.find("method"), reading));
  root.record("materials", read_materials(root.find("materials"), reading));
  root.record("bodies", read_bodies(root.find("bodies"), reading));
  if (const Node* node = root.find_block("contact"))
    root.record("contact", read_contact(*node, reading));
  read_body_force(root, reading);
  read_loads(root, reading);
  read_detonators(root, reading);
  root.record("output", read_output(root.find("output"), reading));
  root.record("measures", read_measures(root.find("measures"), reading));
  read_answers(root, reading);
  root.record("references", read_references(root.find("references"), reading));
  // What must hold of the results is kept beside them; tools/expectations.py judges.
  if (const Node* expect = root.find_block("expect")) {
    if (expect->kind != Node::Kind::map)
      root.fail(*expect, "expected a block of quantities, found " + expect->kind_name());
    root.record("expect", *expect);
  }
}

}  // namespace

Scene read_scene(const std::string& file, const std::vector<std::string>& overrides) {
  Problems problems;
  Node tree = read_yaml_file(file, "", problems);
  for (const std::string& setting : overrides) apply_override(tree, setting, problems);
  tree.line = 0;  // what the file as a whole lacks is missing on no line
  Scene scene;
  scene.file = file;
  Block root{scene_block(), &tree, "", tree, problems};
  require_blocks(tree, root);
  if (!tree.find("frame")) problems.throw_if_any();
  scene.title = root.text("title", std::filesystem::path{file}.stem().string());
  if (scene.title.size() > kLongestTitle)
    root.fail(*tree.find("title"), "is longer than 1000 characters");
  if (!read_frame(root, scene)) problems.throw_if_any();
  Reading reading{scene, problems, tree};
  read_blocks(root, reading);
  const Node resolved = root.finish();
  problems.throw_if_any();
  check_scene(reading);
  problems.throw_if_any();
  scene.resolved = "# Every value in SI, every default filled in. Written by krater from " +
                   quote(file) + ".\n" + to_yaml(resolved);
  return scene;
}

}  // namespace krater
