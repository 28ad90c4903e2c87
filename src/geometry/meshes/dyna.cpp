// SPDX-License-Identifier: GPL-3.0-or-later
// LS-DYNA keyword files, as far as they say a mesh: *NODE, *ELEMENT_SOLID, *ELEMENT_SHELL, *PART,
// *SECTION_SHELL (LS-DYNA keyword user's manual, volume I). Shells are quadrilaterals where the
// section of their part says plane strain (elform 13) or axial symmetry (14, 15).
#include <algorithm>

#include "geometry/meshes/mesh_formats.hpp"
#include "geometry/meshes/mesh_lines.hpp"

namespace krater {
namespace {

struct Raw {
  std::int64_t number, part;
  std::size_t line;
  bool shell;
  std::vector<std::int64_t> nodes;
};

class DynaReader {
 public:
  DynaReader(const std::string& file, std::string_view data)
      : lines_{file, data, "$"}, maker_{file} {}

  MeshFile read() {
    while (lines_.next()) {
      if (!lines_.now().starts_with('*')) continue;  // data of keywords that mean nothing here
      const std::string word = upper(trimmed(lines_.now())).substr(1);
      if (word == "END") break;
      read_block(word);
    }
    for (const Raw& e : raw_) {
      const std::size_t element =
          maker_.add_element(e.number, e.line, maker_.kind(kind_of(e)), e.nodes);
      const std::string digits = std::to_string(e.part);
      maker_.add_to_part(name_of(e.part), element, digits);
    }
    maker_.resolve();
    return std::move(maker_.file());
  }

 private:
  void read_block(const std::string& word) {
    if (word.starts_with("KEYWORD") && word.find("LONG=Y") != std::string::npos)
      lines_.fail("the long format is not read: write the file in the standard one");
    if (word.starts_with("INCLUDE"))
      lines_.fail("*" + word + " is not read: put the file's lines here");
    if (word.ends_with('%') || word.ends_with('+') || word.ends_with('-'))
      lines_.fail("*" + word + " changes the format of its lines: write the standard one");
    if (word == "NODE")
      read_nodes();
    else if (word == "ELEMENT_SOLID" || word == "ELEMENT_SOLID (TEN NODES FORMAT)")
      read_solids();
    else if (word == "ELEMENT_SHELL")
      read_shells();
    else if (word.starts_with("ELEMENT_SOLID_") || word.starts_with("ELEMENT_SHELL_"))
      lines_.fail("*" + word + " has cards that are not read: write *" + word.substr(0, 13));
    else if (word == "PART" || word.starts_with("PART_"))
      read_parts(word == "PART");
    else if (word == "SECTION_SHELL" || word == "SECTION_SHELL_TITLE")
      read_sections(word != "SECTION_SHELL");
  }

  /// A part's title, with its number where another has the same.
  std::string name_of(std::int64_t part) const {
    const auto own = titles_.find(part);
    const std::string digits = std::to_string(part);
    if (own == titles_.end() || own->second.empty()) return digits;
    const auto same = std::count_if(titles_.begin(), titles_.end(),
                                    [&](const auto& t) { return t.second == own->second; });
    return same > 1 ? own->second + " (" + digits + ")" : own->second;
  }

  /// By commas, by blanks where that gives as many as asked for, else in columns of `width`.
  std::vector<std::string_view> card(std::size_t least, std::size_t most, std::size_t first_width,
                                     std::size_t width) const {
    const std::string_view now = lines_.now();
    if (now.find(',') != std::string_view::npos) return lines_.fields();
    std::vector<std::string_view> out = lines_.words();
    if (out.size() >= least && out.size() <= most && !out.empty() &&
        std::all_of(out.begin(), out.end(), [&](auto w) { return w.size() <= width; }))
      return out;
    out.clear();
    for (std::size_t at = 0, w = first_width; at < now.size() && out.size() < most; at += w) {
      if (!out.empty()) w = width;
      out.push_back(trimmed(now.substr(at, w)));
    }
    return out;
  }

  void read_nodes() {
    while (lines_.next_data()) {
      const auto f = card(4, 6, 8, 16);
      Vector3 x{};
      for (std::size_t a = 0; a < 3; ++a)
        if (f.size() > a + 1 && !f[a + 1].empty()) x[a] = lines_.number(f[a + 1]);
      maker_.add_node(lines_.integer(f[0]), x, lines_.line());
    }
  }

  std::vector<std::int64_t> integers(std::size_t least) const {
    std::vector<std::int64_t> out;
    for (const std::string_view f : card(least, 10, 8, 8))
      if (!f.empty()) out.push_back(lines_.integer(f));
    return out;
  }

  void read_solids() {
    while (lines_.next_data()) {
      const std::size_t line = lines_.line();
      std::vector<std::int64_t> all = integers(2);
      if (all.size() == 2) {  // the nodes on a line of their own
        if (!lines_.next_data()) lines_.fail("the nodes of this element are missing");
        const std::vector<std::int64_t> nodes = integers(8);
        all.insert(all.end(), nodes.begin(), nodes.end());
      }
      while (all.size() > 10 && all.back() == 0) all.pop_back();
      add(all, line, false, 8);
    }
  }

  void read_shells() {
    while (lines_.next_data()) {
      std::vector<std::int64_t> all = integers(6);
      while (all.size() > 6 && all.back() == 0) all.pop_back();
      add(all, lines_.line(), true, 4);
    }
  }

  void add(const std::vector<std::int64_t>& all, std::size_t line, bool shell,
           std::size_t corners) {
    if (all.size() < corners + 2)
      maker_.fail(line, "an element has a number, a part and " + std::to_string(corners) +
                            " nodes, this line has " + std::to_string(all.size()) + " numbers");
    raw_.push_back({all[0], all[1], line, shell, {all.begin() + 2, all.end()}});
  }

  void read_parts(bool several) {
    while (lines_.next_data()) {
      const std::string title{trimmed(lines_.now())};
      if (!lines_.next_data()) lines_.fail("*PART needs a title and a line of numbers");
      const auto f = card(3, 8, 10, 10);
      const std::int64_t number = lines_.integer(f[0]);
      titles_[number] = title;
      section_of_[number] = f.size() > 1 && !f[1].empty() ? lines_.integer(f[1]) : 0;
      if (!several) return;
    }
  }

  void read_sections(bool titled) {
    while (lines_.next_data()) {
      if (titled && !lines_.next_data()) return;
      const auto f = card(2, 8, 10, 10);
      if (f.size() > 1 && !f[1].empty()) form_[lines_.integer(f[0])] = lines_.integer(f[1]);
      lines_.next_data();  // thicknesses
    }
  }

  ElementKind kind_of(const Raw& e) const {
    if (!e.shell)
      return e.nodes.size() > 8
                 ? ElementKind{"solid of more than 8 nodes", 3, 0, kSecondOrder, std::nullopt}
                 : plain_kind("solid", 3, 8);
    const auto section = section_of_.find(e.part);
    const auto form = section == section_of_.end() ? form_.end() : form_.find(section->second);
    const std::int64_t number = form == form_.end() ? 0 : form->second;
    ElementKind out = plain_kind("shell, elform " + std::to_string(number), 2, 4);
    if (number == 13)
      out.frame = Frame::plane_strain;
    else if (number == 14 || number == 15)
      out.frame = Frame::axisymmetric;
    else
      out.refusal =
          "no solid element: its *SECTION_SHELL must have elform 13 (plane strain), 14 or 15 "
          "(axial symmetry)";
    if (e.nodes.size() > 4) out.refusal = kSecondOrder;
    if (e.nodes.size() > 4) out.name += ", more than 4 nodes";
    return out;
  }

  MeshLines lines_;
  MeshFileMaker maker_;
  std::vector<Raw> raw_;
  std::map<std::int64_t, std::string> titles_;
  std::map<std::int64_t, std::int64_t> section_of_, form_;
};

}  // namespace

MeshFile read_dyna(const std::string& file, std::string_view data) {
  return DynaReader{file, data}.read();
}

}  // namespace krater
