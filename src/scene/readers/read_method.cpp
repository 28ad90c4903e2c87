// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <cmath>

#include "krater/materials/catalogue.hpp"
#include "krater/points/fields.hpp"
#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

constexpr const char* kEnergyError = "energy_error";
constexpr double kMostFrames = 999'999;  ///< six digits of their names

/// A word, or a word with options: `flip`, `{xpic: {order: 4}}`. `read_options` reads what belongs
/// to the value found.
template <class T, class ReadOptions>
Node read_worded(const Node* node, const std::string& key, const Words<T>& words, T& value,
                 const BlockInfo& declaration, Reading& reading, const ReadOptions& read_options) {
  const Node* options = nullptr;
  if (node) {
    const std::optional<Choice> choice = read_choice(*node, key, reading.problems);
    const auto found = std::find_if(words.begin(), words.end(), [&](const auto& word) {
      return choice && choice->name == word.first;
    });
    if (found != words.end()) {
      value = found->second;
      options = choice->value;
    } else if (choice) {
      std::vector<std::string> known;
      for (const auto& word : words) known.emplace_back(word.first);
      report_unknown(*choice->place, key, choice->name, known, reading.problems);
      return {};
    }
  }
  const std::string name = std::find_if(words.begin(), words.end(), [&](const auto& word) {
                             return word.second == value;
                           })->first;
  Block block{member(declaration, name), options, "method." + key + "." + name,
              node ? *node : reading.root, reading.problems};
  read_options(block);
  const Node values = block.finish();
  if (values.items.empty()) return string_node(name);
  Node resolved;
  add_member(resolved, name, values);
  return resolved;
}

/// A share, or `off`.
double read_energy_error(Block& block) {
  const Node* node = block.find(kEnergyError);
  const bool word = node != nullptr && node->kind == Node::Kind::scalar && !node->text.empty() &&
                    std::isalpha(static_cast<unsigned char>(node->text.front())) != 0;
  if (!word) return block.number(kEnergyError);
  if (node->text != "off")
    block.fail(*node, "must be a share of the energy (0.1 is the default) or off, found " +
                          quote(node->text));
  block.record(kEnergyError, string_node("off"));
  return 0;
}

Node read_transfer(const Node* node, Reading& reading) {
  MethodOptions& method = reading.scene.method;
  const Words<Transfer> words{{"tflip", Transfer::tflip},
                              {"flip", Transfer::flip},
                              {"apic", Transfer::apic},
                              {"xpic", Transfer::xpic}};
  return read_worded(node, "transfer", words, method.transfer, transfer_block(), reading,
                     [&](Block& block) {
                       if (method.transfer == Transfer::xpic)
                         method.xpic_order = block.integer("order", method.xpic_order);
                     });
}

Node read_reference(const Node* node, Reading& reading) {
  MethodOptions& method = reading.scene.method;
  const Words<Reference> words{{"current", Reference::current},
                               {"initial", Reference::initial},
                               {"adaptive", Reference::adaptive}};
  return read_worded(node, "reference", words, method.reference, method_reference_block(), reading,
                     [&](Block& block) {
                       if (method.reference == Reference::adaptive)
                         method.refresh_strain = block.number("strain", method.refresh_strain);
                     });
}

}  // namespace

Node read_time(const Node* node, Reading& reading) {
  TimeOptions& time = reading.scene.time;
  Block block{time_block(), node, "time", reading.root, reading.problems};
  time.where = block.place().where();
  time.end = block.number("end");
  time.cfl = block.number("cfl");
  if (time.cfl > 1)
    block.fail(*node->find("cfl"), "must be at most 1 (the scheme is unstable beyond), found " +
                                       quote(node->find("cfl")->text));
  time.max_step = block.number("max_step");
  time.min_step = block.number("min_step");
  time.first_step = block.number("first_step");
  time.energy_error = read_energy_error(block);
  if (time.max_step > 0 && time.min_step > time.max_step)
    block.fail("min_step is longer than max_step");
  if (time.max_step > 0 && time.first_step > time.max_step)
    block.fail("first_step is longer than max_step");
  if (const Node* stop = block.find("stop_when")) block.record("stop_when", *stop);
  return block.finish();
}

Node read_method(const Node* node, Reading& reading) {
  MethodOptions& method = reading.scene.method;
  Block block{method_block(), node, "method", reading.root, reading.problems};
  method.shape = block.choice<Shape>("shape",
                                     {{"quadratic_bspline", Shape::quadratic_bspline},
                                      {"gimp", Shape::gimp},
                                      {"linear", Shape::linear}},
                                     method.shape);
  block.record("transfer", read_transfer(block.find("transfer"), reading));
  block.record("reference", read_reference(block.find("reference"), reading));
  method.update = block.choice<Update>(
      "update", {{"usl", Update::usl}, {"musl", Update::musl}, {"usf", Update::usf}},
      method.update);
  method.points_per_direction = block.integer("points_per_direction", method.points_per_direction);
  method.stagger = block.flag("stagger", method.stagger);
  method.jitter = block.number("jitter");
  method.seed = static_cast<unsigned>(block.integer("seed", 1));
  method.cell_averaging = block.flag("cell_averaging", method.cell_averaging);
  method.grid_pressure = block.choice<GridPressure>(
      "grid_pressure",
      {{"fluids", GridPressure::fluids}, {"none", GridPressure::none}, {"all", GridPressure::all}},
      method.grid_pressure);
  method.flip_fraction = block.number("flip_fraction");
  method.energy_alpha = block.number("energy_alpha");
  method.dormant_blocks = block.flag("dormant_blocks", method.dormant_blocks);
  method.numerical_fracture =
      block.choice<NumericalFracture>("numerical_fracture",
                                      {{"ignore", NumericalFracture::ignore},
                                       {"watch", NumericalFracture::watch},
                                       {"split", NumericalFracture::split}},
                                      method.numerical_fracture);
  if (method.numerical_fracture != NumericalFracture::ignore &&
      method.reference != Reference::current)
    block.fail(*block.find("numerical_fracture"),
               "watch and split are for reference: current; on another one points keep the "
               "neighbours of the "
               "reference, however far they are stretched");
  return block.finish();
}

const std::vector<FieldName>& known_fields() {
  static const std::vector<FieldName> fields = [] {
    const FieldInfo* const all[] = {&field::Position::info,
                                    &field::Velocity::info,
                                    &field::AffineVelocity::info,
                                    &field::Mass::info,
                                    &field::Density::info,
                                    &field::DeviatoricStress::info,
                                    &field::Pressure::info,
                                    &field::ViscousPressure::info,
                                    &field::InternalEnergy::info,
                                    &field::Temperature::info,
                                    &field::PlasticStrain::info,
                                    &field::Damage::info,
                                    &field::Failed::info,
                                    &field::SoundSpeed::info,
                                    &field::ShockIndicator::info,
                                    &field::HalfWidth::info,
                                    &field::DeformationGradient::info,
                                    &field::ReferencePosition::info,
                                    &field::BodyAcceleration::info,
                                    &field::GridVelocity::info,
                                    &field::SinceLighting::info};
    std::vector<FieldName> names;
    for (const FieldInfo* info : all) names.push_back({info->name, info->unit});
    for (const LawInfo& law : catalogue())  // what laws remember
      for (const FieldInfo* column : law.columns)
        if (std::none_of(names.begin(), names.end(),
                         [&](const FieldName& n) { return std::string{n.name} == column->name; }))
          names.push_back({column->name, column->unit});
    names.push_back({kFragmentField, "1"});
    return names;
  }();
  return fields;
}

Node read_output(const Node* node, Reading& reading) {
  OutputOptions& output = reading.scene.output;
  Block block{output_block(), node, "output", reading.root, reading.problems};
  output.where = block.place().where();
  output.frames = block.number("frames");
  const double most = kMostFrames * output.frames;
  if (output.frames > 0 && most < reading.scene.time.end)
    block.fail(*block.find("frames"),
               "is shorter than a millionth of time.end, and no more than a million frames can be "
               "written; found " +
                   quote(block.find("frames")->text));
  output.history = block.number("history");
  output.checkpoint_wall = block.number("checkpoint");
  std::vector<Node> written;
  if (const Node* list = block.find("fields")) {
    output.where = list->where();
    if (list->kind != Node::Kind::list)
      block.fail(*list, "expected a list of fields, found " + list->kind_name());
    std::vector<std::string> known;
    for (const FieldName& field : known_fields()) known.emplace_back(field.name);
    for (const Node& item : list->kind == Node::Kind::list ? list->items : std::vector<Node>{}) {
      const std::optional<std::string> name = read_word(item, reading.problems);
      if (!name) continue;
      if (std::find(known.begin(), known.end(), *name) == known.end()) {
        report_unknown(item, "field", *name, known, reading.problems);
      } else if (std::find(output.fields.begin(), output.fields.end(), *name) !=
                 output.fields.end()) {
        block.fail(item, quote(*name) + " is listed twice");
      } else {
        output.fields.push_back(*name);
        written.push_back(string_node(*name));
      }
    }
  }
  block.record("fields", list_node(written));
  return block.finish();
}

}  // namespace krater::scene
