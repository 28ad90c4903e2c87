// SPDX-License-Identifier: GPL-3.0-or-later
// Gmsh's ASCII format, versions 2.2 and 4.1 (Gmsh reference manual, "MSH file format"). Physical
// groups are the parts.
#include <array>

#include "geometry/meshes/mesh_formats.hpp"

namespace krater {
namespace {

struct Type {
  const char* name;
  int dimension;
  std::size_t corners;
  bool linear;
};

/// By number, from 1.
constexpr std::array<Type, 19> kTypes{{{"line", 1, 2, true},
                                       {"triangle", 2, 3, true},
                                       {"quadrangle", 2, 4, true},
                                       {"tetrahedron", 3, 4, true},
                                       {"hexahedron", 3, 8, true},
                                       {"prism", 3, 6, true},
                                       {"pyramid", 3, 5, true},
                                       {"3-node line", 1, 3, false},
                                       {"6-node triangle", 2, 6, false},
                                       {"9-node quadrangle", 2, 9, false},
                                       {"10-node tetrahedron", 3, 10, false},
                                       {"27-node hexahedron", 3, 27, false},
                                       {"18-node prism", 3, 18, false},
                                       {"14-node pyramid", 3, 14, false},
                                       {"point", 0, 1, true},
                                       {"8-node quadrangle", 2, 8, false},
                                       {"20-node hexahedron", 3, 20, false},
                                       {"15-node prism", 3, 15, false},
                                       {"13-node pyramid", 3, 13, false}}};

ElementKind kind_of(std::int64_t type) {
  if (type < 1 || type > static_cast<std::int64_t>(kTypes.size()))
    return {"type " + std::to_string(type), -1, 0,
            "of a type that krater does not know: make the "
            "mesh again with hexahedra (quadrangles in a plane)",
            std::nullopt};
  const Type& t = kTypes[static_cast<std::size_t>(type - 1)];
  ElementKind out = plain_kind(t.name, t.dimension, t.corners);
  if (!t.linear) out.refusal = kSecondOrder;
  return out;
}

class GmshReader {
 public:
  GmshReader(const std::string& file, std::string_view data) : text_{file, data}, maker_{file} {}

  MeshFile read() {
    while (!text_.at_end()) {
      const std::string word{text_.word()};
      if (!word.starts_with('$'))
        text_.fail("expected a section ($Nodes, $Elements, ...), found " + MeshText::shown(word));
      const std::string name = word.substr(1);
      if (name != "MeshFormat" && version_ == 0) text_.fail("a Gmsh file begins with $MeshFormat");
      if (!read_section(name))
        while (!text_.at_end() && text_.word() != "$End" + name) text_.next_line();
      else
        text_.expect("$End" + name);
    }
    maker_.resolve();
    return std::move(maker_.file());
  }

 private:
  bool read_section(const std::string& name) {
    if (name == "MeshFormat")
      read_format();
    else if (name == "PhysicalNames")
      read_names();
    else if (name == "Entities")
      read_entities();
    else if (name == "Nodes")
      version_ == 2 ? read_nodes_2() : read_nodes_4();
    else if (name == "Elements")
      version_ == 2 ? read_elements_2() : read_elements_4();
    else
      return false;
    return true;
  }

  std::int64_t integer() { return text_.integer(text_.word()); }
  /// A count that the rest of the file can hold.
  std::int64_t count() {
    const std::int64_t value = integer();
    if (value < 0 || static_cast<std::uint64_t>(value) > text_.left())
      text_.fail("promises " + std::to_string(value) + " entries, which do not follow");
    return value;
  }

  void read_format() {
    const std::string version{text_.word()};
    const bool ascii = integer() == 0;
    text_.next_line();
    const char* remedy = "; gmsh FILE -save -format msh41 -o NEW.msh writes what is read here";
    if (version != "4.1" && !version.starts_with("2"))
      text_.fail("version " + version + " of the format is not read (2.2 and 4.1 are)" + remedy);
    if (!ascii) text_.fail(std::string{"the file is binary, only ASCII is read"} + remedy);
    version_ = version == "4.1" ? 4 : 2;
  }

  void read_names() {
    for (std::int64_t left = count(); left > 0; --left) {
      const auto dimension = static_cast<int>(integer());
      const std::int64_t number = integer();
      std::string name;
      for (std::string_view w = text_.word_on_line(); !w.empty(); w = text_.word_on_line())
        name += (name.empty() ? "" : " ") + std::string{w};
      if (name.size() > 1 && name.front() == '"') name = name.substr(1, name.size() - 2);
      names_[{dimension, number}] = name;
    }
  }

  void read_entities() {
    std::array<std::int64_t, 4> counts{};
    for (std::int64_t& c : counts) c = count();
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::int64_t k = 0; k < counts[static_cast<std::size_t>(dimension)]; ++k) {
        const std::int64_t tag = integer();
        for (int a = 0; a < (dimension == 0 ? 3 : 6); ++a) text_.number();
        auto& groups = entities_[{dimension, tag}];
        for (std::int64_t left = count(); left > 0; --left) groups.push_back(integer());
        if (dimension > 0)
          for (std::int64_t left = count(); left > 0; --left) integer();
      }
  }

  void read_nodes_2() {
    for (std::int64_t left = count(); left > 0; --left) {
      const std::int64_t number = integer();
      const double x = text_.number(), y = text_.number();
      maker_.add_node(number, {x, y, text_.number()}, text_.line());
    }
  }

  void read_nodes_4() {
    std::int64_t blocks = count();
    for (int k = 0; k < 3; ++k) integer();
    for (; blocks > 0; --blocks) {
      const std::int64_t dimension = integer();
      integer();
      const bool parametric = integer() != 0;
      std::vector<std::int64_t> numbers(static_cast<std::size_t>(count()));
      for (std::int64_t& n : numbers) n = integer();
      for (const std::int64_t n : numbers) {
        const double x = text_.number(), y = text_.number();
        maker_.add_node(n, {x, y, text_.number()}, text_.line());
        for (std::int64_t k = 0; parametric && k < dimension; ++k) text_.number();
      }
    }
  }

  /// The nodes up to the end of the line.
  void read_element(std::int64_t number, std::int64_t type, int dimension,
                    const std::vector<std::int64_t>& groups) {
    const ElementKind kind = kind_of(type);
    const std::size_t line = text_.line();
    std::vector<std::int64_t> nodes;
    for (std::string_view w = text_.word_on_line(); !w.empty(); w = text_.word_on_line())
      nodes.push_back(text_.integer(w));
    if (kind.corners > 0 && nodes.size() != kind.corners)
      text_.fail("element " + std::to_string(number) + ", a " + kind.name + ", has " +
                 std::to_string(nodes.size()) + " nodes: the line is cut short, or too long");
    const std::size_t element = maker_.add_element(number, line, maker_.kind(kind), nodes);
    for (const std::int64_t group : groups)
      add_to_group(group, kind.dimension < 0 ? dimension : kind.dimension, element);
  }

  /// Numbers of groups are counted by dimension: where that is not known, all of that number.
  void add_to_group(std::int64_t group, int dimension, std::size_t element) {
    const std::string digits = std::to_string(group);
    bool named = false;
    for (int d = 0; d < 4; ++d) {
      const auto name = names_.find({d, group});
      if (name == names_.end() || (dimension >= 0 && d != dimension)) continue;
      maker_.add_to_part(name->second, element, digits);
      named = true;
    }
    if (!named) maker_.add_to_part(digits, element, digits);
  }

  void read_elements_2() {
    for (std::int64_t left = count(); left > 0; --left) {
      const std::int64_t number = integer(), type = integer();
      std::vector<std::int64_t> groups;
      std::int64_t tags = count();
      if (tags > 0) {
        const std::int64_t physical = integer();
        if (physical != 0) groups.push_back(physical);
        for (; tags > 1; --tags) integer();
      }
      read_element(number, type, -1, groups);
    }
  }

  void read_elements_4() {
    std::int64_t blocks = count();
    for (int k = 0; k < 3; ++k) integer();
    for (; blocks > 0; --blocks) {
      const auto dimension = static_cast<int>(integer());
      const std::int64_t entity = integer(), type = integer();
      const auto found = entities_.find({dimension, entity});
      const std::vector<std::int64_t> none,
          &groups = found == entities_.end() ? none : found->second;
      for (std::int64_t left = count(); left > 0; --left)
        read_element(integer(), type, dimension, groups);
    }
  }

  MeshText text_;
  MeshFileMaker maker_;
  int version_ = 0;
  std::map<std::pair<int, std::int64_t>, std::string> names_;
  std::map<std::pair<int, std::int64_t>, std::vector<std::int64_t>> entities_;
};

}  // namespace

MeshFile read_gmsh(const std::string& file, std::string_view data) {
  return GmshReader{file, data}.read();
}

}  // namespace krater
