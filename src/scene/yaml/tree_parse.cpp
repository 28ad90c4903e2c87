// SPDX-License-Identifier: GPL-3.0-or-later
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "krater/core/errors.hpp"
#include "scene/yaml/problems.hpp"
#include "scene/yaml/tree.hpp"

namespace krater::scene {

namespace {

constexpr std::uintmax_t kLargestFile = 16u << 20;
constexpr int kMostNodes = 200'000;  // anchors can unfold a small file into an enormous tree
constexpr int kDeepest = 40;         // and can point at themselves

struct Conversion {
  const std::string& file;
  Problems& problems;
  int nodes = 0;
  int last_line = 1;
};

/// yaml-cpp counts lines from 0 and gives -1 where it does not know.
int line_of(const YAML::Mark& mark, int fallback) {
  return mark.line < 0 ? fallback : mark.line + 1;
}

Node convert(const YAML::Node& yaml, const std::string& path, int depth, Conversion& conversion);

void convert_member(const std::pair<YAML::Node, YAML::Node>& member, Node& map, int depth,
                    Conversion& conversion) {
  const int line = line_of(member.first.Mark(), map.line);
  if (!member.first.IsScalar() || member.first.Scalar().empty()) {
    conversion.problems.add(conversion.file, line, map.path, "a key must be a plain word");
    return;
  }
  const std::string key = member.first.Scalar();
  const std::string path = map.path.empty() ? key : map.path + "." + key;
  if (key == "<<") {
    conversion.problems.add(
        conversion.file, line, path,
        "merge keys are not supported; repeat the keys, use an anchor for a whole "
        "block, or put a material on a card");
    return;
  }
  if (const Node* first = map.find(key)) {
    conversion.problems.add(conversion.file, line, path,
                            "duplicate key, first given on line " + std::to_string(first->line));
    return;
  }
  Node value = convert(member.second, path, depth + 1, conversion);
  value.key = key;
  value.line = line;
  map.items.push_back(std::move(value));
}

Node convert(const YAML::Node& yaml, const std::string& path, int depth, Conversion& conversion) {
  Node node;
  node.file = conversion.file;
  node.path = path;
  node.line = conversion.last_line = line_of(yaml.Mark(), conversion.last_line);
  if (++conversion.nodes > kMostNodes || depth > kDeepest) {
    throw InputError(node.where() + ": too large or too deep (does an anchor contain itself?)");
  }
  switch (yaml.Type()) {
    case YAML::NodeType::Undefined:
    case YAML::NodeType::Null:
      break;
    case YAML::NodeType::Scalar:
      node.kind = Node::Kind::scalar;
      node.text = yaml.Scalar();
      node.in_quotes = yaml.Tag() == "!";
      break;
    case YAML::NodeType::Sequence:
      node.kind = Node::Kind::list;
      for (const auto& item : yaml) {
        node.items.push_back(
            convert(item, path + "." + std::to_string(node.items.size()), depth + 1, conversion));
      }
      break;
    case YAML::NodeType::Map:
      node.kind = Node::Kind::map;
      for (const auto& member : yaml) {
        convert_member(std::pair<YAML::Node, YAML::Node>{member.first, member.second}, node, depth,
                       conversion);
      }
      break;
  }
  return node;
}

std::string line_text(const std::string& text, int line) {
  std::istringstream stream(text);
  std::string result;
  for (int i = 0; i < line; ++i) {
    if (!std::getline(stream, result)) return "";
  }
  return result;
}

[[noreturn]] void throw_syntax_error(const std::string& text, const std::string& file,
                                     const std::string& path, const YAML::Mark& mark,
                                     const std::string& message) {
  // A --set value is one line: its number would only mislead.
  const bool from_file = file.compare(0, 6, "--set ") != 0;
  const int line = mark.line < 0 ? 0 : mark.line + 1;
  std::string hint;
  for (int i = std::max(1, line - 1); line > 0 && i <= line; ++i) {
    const std::string shown = line_text(text, i);
    const std::size_t first = shown.find_first_not_of(' ');
    if (first != std::string::npos && shown[first] == '\t')
      hint = "; line " + std::to_string(i) + " is indented by a tab, YAML wants spaces";
  }
  throw InputError(describe_place(file, from_file ? line : 0, path) +
                   ": not valid YAML: " + message + hint);
}

/// Sees documents begin and nothing else.
class DocumentMarks final : public YAML::EventHandler {
 public:
  std::vector<YAML::Mark> marks;
  void OnDocumentStart(const YAML::Mark& mark) override { marks.push_back(mark); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

/// yaml-cpp reads the first document and passes over the rest, even where the rest is what it
/// failed to understand: after a stray comma it finds empty documents without end. Hence at most
/// two are looked for.
void refuse_second_document(const std::string& text, const std::string& file,
                            const std::string& path) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentMarks documents;
  if (!parser.HandleNextDocument(documents) || !parser.HandleNextDocument(documents)) return;
  const YAML::Mark& first = documents.marks.front();
  const YAML::Mark& second = documents.marks.back();
  if (second.pos == first.pos || second.line < 0)
    throw_syntax_error(text, file, path, first, "unexpected character");
  throw InputError(describe_place(file, second.line + 1, path) +
                   ": a second YAML document; only one is read");
}

YAML::Node load(const std::string& text, const std::string& file, const std::string& path) {
  try {
    refuse_second_document(text, file, path);
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw_syntax_error(text, file, path, error.mark, error.msg);
  }
}

void check_text(const std::string& text, const std::string& file) {
  int line = 1;
  for (char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '\n') ++line;
    if ((code < 0x20 && c != '\n' && c != '\r' && c != '\t') || code == 0x7f) {
      throw InputError(describe_place(file, line, "") + ": not a text file (byte " +
                       std::to_string(code) + ")");
    }
  }
}

}  // namespace

Node parse_yaml(const std::string& text, const std::string& file, const std::string& path,
                Problems& problems) {
  check_text(text, file);
  const YAML::Node document = load(text, file, path);
  Conversion conversion{file, problems};
  try {
    Node root = convert(document, path, 0, conversion);
    root.file = file;
    return root;
  } catch (const YAML::Exception& error) {
    throw_syntax_error(text, file, path, error.mark, error.msg);
  }
}

Node read_yaml_file(const std::string& file, const std::string& path, Problems& problems) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw InputError(file + ": no such file");
  if (fs::is_directory(status)) throw InputError(file + ": is a folder, not a scene file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file + ": cannot be read");
  if (fs::is_regular_file(status) && fs::file_size(file, error) > kLargestFile) {
    throw InputError(file + ": too large for a scene (over 16 MB)");
  }
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) throw InputError(file + ": cannot be read");
  Node root = parse_yaml(text, file, path, problems);
  if (root.kind == Node::Kind::null) throw InputError(file + ": is empty");
  if (root.kind != Node::Kind::map) {
    throw InputError(describe_place(file, root.line, path) + ": expected a block of keys, found " +
                     root.kind_name());
  }
  return root;
}

}  // namespace krater::scene
