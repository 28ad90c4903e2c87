// SPDX-License-Identifier: GPL-3.0-or-later
// Abaqus input files, as far as they say a mesh: *PART, *NODE, *ELEMENT, *ELSET (Abaqus keywords
// reference guide). The parts of krater are element sets; where the file has *PART blocks, these as
// a whole and their sets, PART.SET.
#include <algorithm>

#include "geometry/meshes/mesh_formats.hpp"
#include "geometry/meshes/mesh_lines.hpp"

namespace krater {
namespace {

struct Family {
  const char* begins;
  int dimension;
  std::size_t corners;
  const char* refusal;
  std::optional<Frame> frame;
};

constexpr const char* kShell =
    "no solid element: make the mesh again with continuum elements (C3D8R; CPE4R in plane strain, "
    "CAX4R in axial symmetry)";

/// The first whose name begins a type's name counts.
const Family kFamilies[] = {
    {"C3D8", 3, 8, "", std::nullopt},
    {"C3D4", 3, 4, kSimplex, std::nullopt},
    {"C3D5", 3, 5, kSimplex, std::nullopt},
    {"C3D6", 3, 6, kSimplex, std::nullopt},
    {"C3D10", 3, 0, kSecondOrder, std::nullopt},
    {"C3D15", 3, 0, kSecondOrder, std::nullopt},
    {"C3D20", 3, 0, kSecondOrder, std::nullopt},
    {"C3D27", 3, 0, kSecondOrder, std::nullopt},
    {"CPE4", 2, 4, "", Frame::plane_strain},
    {"CAX4", 2, 4, "", Frame::axisymmetric},
    {"CPE3", 2, 3, kSimplex, std::nullopt},
    {"CAX3", 2, 3, kSimplex, std::nullopt},
    {"CPE6", 2, 0, kSecondOrder, std::nullopt},
    {"CPE8", 2, 0, kSecondOrder, std::nullopt},
    {"CAX6", 2, 0, kSecondOrder, std::nullopt},
    {"CAX8", 2, 0, kSecondOrder, std::nullopt},
    {"CPS", 2, 0, "of plane stress, which krater does not compute: use CPE4R", std::nullopt},
    {"SC", 3, 0, kShell, std::nullopt},
    {"S", 2, 0, kShell, std::nullopt},
    {"M3D", 2, 0, kShell, std::nullopt},
    {"R3D", 2, 0, kShell, std::nullopt},
    {"RAX", 1, 0, kShell, std::nullopt},
    {"B", 1, 0, kShell, std::nullopt},
    {"T", 1, 0, kShell, std::nullopt},
    {"MASS", 0, 0, kShell, std::nullopt},
};

ElementKind kind_of(const std::string& type) {
  for (const Family& f : kFamilies)
    if (type.starts_with(f.begins)) return {type, f.dimension, f.corners, f.refusal, f.frame};
  return {type, -1, 0, "of a type that krater does not know: use C3D8R, CPE4R or CAX4R",
          std::nullopt};
}

class AbaqusReader {
 public:
  AbaqusReader(const std::string& file, std::string_view data)
      : lines_{file, data, "**"}, maker_{file} {
    maker_.file().any_case = true;
  }

  MeshFile read() {
    while (lines_.next()) {
      if (!lines_.now().starts_with('*')) continue;  // data of keywords that mean nothing here
      read_keyword();
      if (word_ == "NODE") read_nodes();
      if (word_ == "ELEMENT") read_elements();
      if (word_ == "ELSET") read_set();
      if (word_ == "PART") begin_part();
      if (word_ == "END PART") end_part();
      if (word_ == "INSTANCE" && lines_.next_data())
        lines_.fail(
            "this *INSTANCE places its part elsewhere: write the input file without parts "
            "and assemblies, or remove its data lines and place the body by shape: {move: "
            "...}");
      for (const char* other : {"INCLUDE", "SYSTEM", "NGEN", "NFILL", "NCOPY", "ELGEN", "ELCOPY"})
        if (word_ == other)
          lines_.fail("*" + word_ + " is not read: write the mesh out as *NODE and *ELEMENT lines");
    }
    end_part();
    return std::move(maker_.file());
  }

 private:
  /// A keyword and its parameters, in capitals, over all lines that end in a comma.
  void read_keyword() {
    std::vector<std::string> fields;
    std::vector<std::string_view> found = lines_.fields();
    bool more = true;
    while (more) {
      for (const std::string_view f : found) fields.emplace_back(f);
      more = trimmed(lines_.now()).ends_with(',') && lines_.next();
      if (more) found = lines_.fields();
    }
    word_ = fields.empty() ? "" : upper(fields[0]).substr(1);
    parameters_.clear();
    for (std::size_t k = 1; k < fields.size(); ++k) {
      const std::size_t equals = std::min(fields[k].find('='), fields[k].size());
      std::string_view value = std::string_view{fields[k]}.substr(equals);
      if (!value.empty()) value.remove_prefix(1);
      value = trimmed(value);
      if (value.size() > 1 && value.front() == '"') value = value.substr(1, value.size() - 2);
      parameters_[upper(trimmed(std::string_view{fields[k]}.substr(0, equals)))] = value;
    }
    if (parameters_.contains("INPUT") && (word_ == "NODE" || word_ == "ELEMENT"))
      lines_.fail("INPUT= is not read: put the lines of that file here");
    if (word_ == "NODE" && parameters_.contains("SYSTEM"))
      lines_.fail("SYSTEM= is not read: write the nodes in rectangular coordinates");
  }

  void read_nodes() {
    while (lines_.next_data()) {
      const auto f = lines_.fields();
      if (f.size() < 3) lines_.fail("a node is a number and two or three coordinates");
      maker_.add_node(lines_.integer(f[0]),
                      {lines_.number(f[1]), lines_.number(f[2]),
                       f.size() > 3 && !f[3].empty() ? lines_.number(f[3]) : 0},
                      lines_.line());
    }
  }

  void read_elements() {
    if (!parameters_.contains("TYPE")) lines_.fail("*ELEMENT needs TYPE=");
    const ElementKind kind = kind_of(upper(parameters_["TYPE"]));
    const std::size_t index = maker_.kind(kind);
    const std::string set = parameters_.contains("ELSET") ? parameters_["ELSET"] : "";
    while (lines_.next_data()) {
      const std::size_t line = lines_.line();
      std::vector<std::int64_t> all;
      for (bool more = true; more;) {
        for (const std::string_view f : lines_.fields()) all.push_back(lines_.integer(f));
        more = (trimmed(lines_.now()).ends_with(',') || all.size() < kind.corners + 1) &&
               lines_.next_data();
      }
      if (kind.refusal.empty() && all.size() != kind.corners + 1)
        lines_.fail("element " + std::to_string(all[0]) + ", a " + kind.name + ", has " +
                    std::to_string(all.size() - 1) + " nodes");
      const std::int64_t number = all[0];
      all.erase(all.begin());
      const std::size_t element = maker_.add_element(number, line, index, all);
      if (!elements_.try_emplace(number, element).second)
        maker_.fail(line, "element " + std::to_string(number) + " is there twice");
      if (!part_.empty()) maker_.add_to_part(part_, element);
      if (!set.empty()) put_in(set, element);
    }
  }

  void put_in(const std::string& set, std::size_t element) {
    maker_.add_to_part(part_.empty() ? set : part_ + "." + set, element);
    sets_[upper(set)].push_back(element);
  }

  void read_set() {
    const std::string set = parameters_["ELSET"];
    if (set.empty()) lines_.fail("*ELSET needs ELSET=");
    const bool generate = parameters_.contains("GENERATE"),
               elsewhere = parameters_.contains("INSTANCE");
    while (lines_.next_data()) {
      const auto f = lines_.fields();
      if (elsewhere) continue;
      if (!generate) {
        for (const std::string_view item : f) add_item(set, item);
        continue;
      }
      if (f.size() < 2) lines_.fail("GENERATE needs first, last and step");
      const std::int64_t last = lines_.integer(f[1]),
                         step = f.size() > 2 ? lines_.integer(f[2]) : 1;
      if (step < 1) lines_.fail("the step of GENERATE must be 1 or more");
      for (std::int64_t n = lines_.integer(f[0]); n <= last; n += step)
        if (elements_.contains(n)) put_in(set, elements_[n]);
    }
  }

  void add_item(const std::string& set, std::string_view item) {
    if (item.empty()) return;
    if (const auto other = sets_.find(upper(item)); other != sets_.end()) {
      const std::vector<std::size_t> members = other->second;
      for (const std::size_t e : members) put_in(set, e);
      return;
    }
    const std::int64_t number = lines_.integer(item);
    if (!elements_.contains(number))
      lines_.fail("set " + set + " names element " + std::to_string(number) +
                  ", which is not there before it");
    put_in(set, elements_[number]);
  }

  void begin_part() {
    part_ = parameters_["NAME"];
    if (part_.empty()) lines_.fail("*PART needs NAME=");
  }
  void end_part() {
    maker_.resolve();
    elements_.clear();
    sets_.clear();
    part_.clear();
  }

  MeshLines lines_;
  MeshFileMaker maker_;
  std::string word_, part_;
  std::map<std::string, std::string> parameters_;
  std::unordered_map<std::int64_t, std::size_t> elements_;
  std::map<std::string, std::vector<std::size_t>> sets_;
};

}  // namespace

MeshFile read_abaqus(const std::string& file, std::string_view data) {
  return AbaqusReader{file, data}.read();
}

}  // namespace krater
