// SPDX-License-Identifier: GPL-3.0-or-later
// PLY (G. Turk 1994): a header that declares elements and their properties, then the elements, as
// text or binary. Vertices need x, y, z, faces a list vertex_indices; everything else is passed
// over.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "geometry/surfaces/mesh_formats.hpp"
#include "geometry/surfaces/mesh_text.hpp"

namespace krater {
namespace {

constexpr double kMostCorners = 9e15;  // whole numbers end there; lists may be of floats

struct Type {
  const char* name;
  const char* other;
  std::size_t bytes;
  char kind;  ///< i signed, u unsigned, f floating
};

constexpr std::array types{Type{"char", "int8", 1, 'i'},     Type{"uchar", "uint8", 1, 'u'},
                           Type{"short", "int16", 2, 'i'},   Type{"ushort", "uint16", 2, 'u'},
                           Type{"int", "int32", 4, 'i'},     Type{"uint", "uint32", 4, 'u'},
                           Type{"float", "float32", 4, 'f'}, Type{"double", "float64", 8, 'f'}};

struct Property {
  std::string name;
  const Type* type = nullptr;
  const Type* count = nullptr;  ///< of a list
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

enum class Format { ascii, little, big };

class PlyReader {
 public:
  PlyReader(const std::string& file, std::string_view data)
      : file_(file), data_(data), text_(file, data) {}

  Triangles read() {
    read_header();
    at_ = text_.offset();
    Triangles out;
    for (const Element& element : elements_) {
      check_count(element);
      for (std::int64_t n = 0; n < element.count; ++n) read_element(element, out);
    }
    if (out.vertices.empty() || out.facets.empty()) fail("no vertices or no faces in the file");
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    if (format_ == Format::ascii) text_.fail(message);
    throw std::invalid_argument(file_ + ": byte " + std::to_string(at_) + ": " + message);
  }

  const Type* type(std::string_view name) const {
    for (const Type& t : types) {
      if (name == t.name || name == t.other) return &t;
    }
    text_.fail("unknown type " + MeshText::shown(name));
  }

  void read_format() {
    const std::string_view word = text_.word();
    if (word == "ascii") {
      format_ = Format::ascii;
    } else if (word == "binary_little_endian") {
      format_ = Format::little;
    } else if (word == "binary_big_endian") {
      format_ = Format::big;
    } else {
      text_.fail("unknown format " + MeshText::shown(word));
    }
  }

  void read_property() {
    if (elements_.empty()) text_.fail("a property before the first element");
    Property p;
    std::string_view word = text_.word();
    if (word == "list") {
      p.count = type(text_.word());
      if (p.count->kind == 'f') text_.fail("the length of a list is a whole number");
      word = text_.word();
    }
    p.type = type(word);
    p.name = text_.word();
    elements_.back().properties.push_back(p);
  }

  void read_header() {
    text_.expect("ply");
    bool has_format = false;
    for (std::string_view key = text_.word(); key != "end_header"; key = text_.word()) {
      if (key.empty()) text_.fail("the file ends within its header");
      if (key == "format") {
        read_format();
        has_format = true;
      } else if (key == "element") {
        Element e;
        e.name = text_.word();
        e.count = text_.integer(text_.word());
        elements_.push_back(e);
      } else if (key == "property") {
        read_property();
      } else if (key != "comment" && key != "obj_info") {
        text_.fail("unknown word in the header: " + MeshText::shown(key));
      }
      text_.next_line();
    }
    if (!has_format) text_.fail("the header names no format");
    text_.next_line();
  }

  void check_count(const Element& element) {
    std::size_t least = 0;
    for (const Property& p : element.properties) {
      least += format_ == Format::ascii ? 2 : (p.count ? p.count->bytes : p.type->bytes);
    }
    const std::size_t left = format_ == Format::ascii ? text_.left() : data_.size() - at_;
    if (element.count < 0 || element.count > 0xfffffff0 ||
        static_cast<std::uint64_t>(element.count) > (left + 1) / std::max<std::size_t>(least, 1)) {
      fail("the header promises " + std::to_string(element.count) + " elements '" + element.name +
           "', but only " + std::to_string(left) + " bytes follow");
    }
  }

  double value(const Type& t) {
    if (format_ == Format::ascii) return text_.number();
    if (data_.size() - at_ < t.bytes) fail("the file is cut short");
    std::uint64_t bits = 0;
    for (std::size_t n = 0; n < t.bytes; ++n) {
      const std::size_t from = format_ == Format::little ? t.bytes - 1 - n : n;
      bits = (bits << 8) | static_cast<unsigned char>(data_[at_ + from]);
    }
    at_ += t.bytes;
    if (t.kind == 'f') {
      const double x =
          t.bytes == 4 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)))
                       : std::bit_cast<double>(bits);
      if (!std::isfinite(x)) fail("a number is not finite");
      return x;
    }
    if (t.kind == 'i') {
      const int unused = static_cast<int>(64 - 8 * t.bytes);
      return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
    }
    return static_cast<double>(bits);
  }

  void read_element(const Element& element, Triangles& out) {
    Vector3 x{};
    int found = 0;
    for (const Property& p : element.properties) {
      if (!p.count) {
        const double v = value(*p.type);
        if (element.name != "vertex" || p.name.size() != 1 || p.name[0] < 'x' || p.name[0] > 'z') {
          continue;
        }
        x[static_cast<std::size_t>(p.name[0] - 'x')] = v;
        ++found;
        continue;
      }
      const double count = value(*p.count);
      const std::size_t left = format_ == Format::ascii ? text_.left() : data_.size() - at_;
      if (count < 0 || count > static_cast<double>(left)) fail("a list longer than the file");
      const bool face =
          element.name == "face" && (p.name == "vertex_indices" || p.name == "vertex_index");
      corners_.clear();
      for (int n = 0; n < static_cast<int>(count); ++n) {
        const double corner = value(*p.type);
        if (!face) continue;
        if (!(std::abs(corner) < kMostCorners))
          fail("a corner of a face is the number of no vertex");
        corners_.push_back(static_cast<std::int64_t>(corner));
      }
      if (!face) continue;
      try {
        add_face(corners_, out.vertices.size(), out);
      } catch (const std::invalid_argument& error) {
        fail(error.what());
      }
    }
    if (element.name != "vertex") return;
    if (found != 3) fail("a vertex needs the properties x, y and z");
    out.vertices.push_back(x);
  }

  const std::string& file_;
  std::string_view data_;
  MeshText text_;
  Format format_ = Format::ascii;
  std::vector<Element> elements_;
  std::vector<std::int64_t> corners_;
  std::size_t at_ = 0;  ///< binary: the next byte
};

}  // namespace

Triangles read_ply(const std::string& file, std::string_view data) {
  return PlyReader(file, data).read();
}

}  // namespace krater
