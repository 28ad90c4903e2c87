// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/readers/readers.hpp"

namespace krater::scene {

Node read_rigid(const Node& node, BodyOptions& body, Reading& reading) {
  if (node.kind != Node::Kind::map) {
    body.motion = Motion::free;
    if (node.kind != Node::Kind::scalar || node.text != "free")
      reading.problems.add(node.file, node.line, node.path,
                           "expected free, or {velocity: [...]} for a prescribed motion (numbers "
                           "or expressions in t)");
    return string_node("free");
  }
  Block block{rigid_block(), &node, node.path, node, reading.problems};
  body.motion = Motion::prescribed;
  if (!block.find("turn")) block.require("velocity", "for example [0, -10 m/s], or rigid: free");
  if (body.velocity)
    block.fail(
        "the body has a velocity at the start too; a prescribed motion needs only that of "
        "rigid");
  body.velocity = read_motion(block, body.solid.get(), reading);
  return block.finish();
}

void check_rigid(Reading& reading) {
  const Scene& scene = reading.scene;
  int rigid = 0;
  for (const BodyOptions& body : scene.bodies) {
    const Node* node = reading.root.find("bodies")->find(body.name);
    if (!body.rigid()) {
      const MaterialOptions& material = scene.materials[static_cast<std::size_t>(body.material)];
      if (material.bare)
        reading.problems.add(node->file, node->line, node->path,
                             "material " + quote(material.name) +
                                 " holds no law, which is enough for rigid bodies only: give it an "
                                 "eos and a strength, or the body rigid: free");
      continue;
    }
    ++rigid;
    const Node* place = node->find("rigid");
    if (!scene.contact.active)
      reading.problems.add(place->file, place->line, place->path,
                           "a rigid body needs contact: without the block contact: {friction: 0} "
                           "all bodies share one velocity field");
  }
  if (rigid > 1)
    reading.scene.notes.push_back(
        "there are " + std::to_string(rigid) +
        " rigid bodies: two rigid bodies have no contact, they pass through each other");
}

}  // namespace krater::scene
