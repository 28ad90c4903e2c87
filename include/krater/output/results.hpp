// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/results.hpp
/// What a run hands to the writers: plain arrays, no knowledge of blocks or lanes. Written by
/// src/output (the only HDF5 in the program). Files appear complete or not at all: they are written
/// beside (`NAME.part`) and renamed, so a killed run leaves everything it wrote before readable.
/// What is large is asked for piece by piece while it is written, and never copied as a whole. The
/// layout of the files is in src/output/README.md. Not thread-safe: one thread calls; a frame is
/// packed by all threads, and waits for the disk beside the computation; whatever else needs HDF5
/// waits for it.
#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace krater {

/// Results could not be written in mid-run (disk full, folder removed, ...); the text names the
/// file and the reason. A folder that cannot be created is an InputError: the user chose its place.
struct OutputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// `count` rows of a matrix, from the row `first` on, into `out`. Called from several threads.
template <class T>
using Rows = std::function<void(std::size_t first, std::size_t count, T* out)>;

/// One field of one body, points in order of their id. `components` values per point, a row per
/// point: vectors should have three components in every frame of reference (ParaView draws no
/// others), symmetric tensors xx yy zz yz xz xy.
struct FieldArray {
  std::string name, unit, meaning;
  int components = 1;
  std::vector<std::string> component_names;  ///< e.g. r z | xx yy zz yz xz xy; empty for scalars
  Rows<double> values;
};

/// The mesh whose cells the points of a body stand for, one point per cell and in its order.
struct FrameMesh {
  std::size_t nodes = 0;
  int corners = 8;                  ///< 8: hexahedra; 4: quadrilaterals
  Rows<std::int64_t> connectivity;  ///< nodes of a cell: bottom counter-clockwise, then the top
  Rows<double> coordinates;         ///< 3 per node, as those of the points
  std::vector<FieldArray> fields;   ///< a row per node
};

struct BodyFrame {
  std::string body;
  std::size_t points = 0;
  Rows<std::int64_t> ids;
  Rows<double>
      coordinates;  ///< 3 per point (x, y, z); axisymmetric (r, 0, z), plane strain (x, 0, z)
  std::vector<FieldArray> fields;
  std::optional<FrameMesh> mesh{};
  /// Where not all points are at hand: makes `count` rows of all arrays ready, from the row `first`
  /// on. Called before these are read, again and again, with more of them each time.
  std::function<void(std::size_t first, std::size_t count)> bring{};
};

struct OutputFrame {
  int number = 0;
  double time = 0;  ///< [s]
  std::int64_t step = 0;
  std::vector<BodyFrame> bodies;
};

/// A named scalar with unit, e.g. a history column or an entry of the audit.
struct Quantity {
  std::string name, unit;
  double value = 0;
};

using TextAttributes = std::vector<std::pair<std::string, std::string>>;

/// A column of a table, as `krater point` writes them: all of one length.
struct TableColumn {
  std::string name, unit, meaning;
  std::vector<double> values;
};

/// A series with its own times, beside the rows of the history: `columns` of one length, and what
/// is to be known of them.
struct SeriesTable {
  std::string name;
  std::vector<TableColumn> columns;
  TextAttributes texts;
  std::vector<std::pair<std::string, double>> numbers;
};

/// Everything needed to continue with the same bits: named blobs, written and read verbatim (NaN
/// payloads, -0.0 and denormals included). At most one of the four is filled.
struct CheckpointBlob {
  std::string name;                    ///< unique; '/' makes groups in the file
  std::vector<std::uint64_t> shape;    ///< empty: one-dimensional
  std::vector<double> doubles;         ///< either doubles ...
  std::vector<std::int64_t> integers;  ///< ... or integers
  std::string text;                    ///< ... or text (bytes, no shape)
  Rows<double> matrix{};               ///< ... or a large matrix of that shape
};
struct Checkpoint {
  std::vector<CheckpointBlob> blobs;
  const CheckpointBlob* find(const std::string& name) const;  ///< null when there is none
};

/// A value of summary.json: nested objects of numbers and strings.
struct Json {
  enum class Kind { object, array, number, integer, text, boolean, null } kind = Kind::object;
  std::vector<std::string> keys;  ///< object: of the items, in the order of their creation
  std::vector<Json> items;        ///< object, array
  double number = 0;
  std::int64_t integer = 0;
  std::string text;
  bool flag = false;
  static Json of(double x);
  static Json of(bool b);
  static Json of(std::string s);
  static Json of(const char* s);  ///< without it a literal would become a boolean
  template <std::integral T>
  requires(!std::same_as<T, bool>) static Json of(T i) {
    return of_integer(static_cast<std::int64_t>(i));
  }
  static Json array();
  static Json null();
  Json& operator[](const std::string& key);  ///< object member, created when missing, order kept
 private:
  static Json of_integer(std::int64_t i);
};

/// Folder of one run: created when the first file is written, so that a scene with errors leaves
/// nothing behind. Into a folder of an earlier run: a fresh run first removes that run's files
/// (frames, history, gauges, checkpoint, summary) and nothing else; a resumed run keeps them (see
/// `continue_from`).
class ResultsFolder {
 public:
  explicit ResultsFolder(std::string path, bool resume = false);
  ~ResultsFolder();  ///< flushes; call flush() before to see its errors
  ResultsFolder(const ResultsFolder&) = delete;
  ResultsFolder& operator=(const ResultsFolder&) = delete;

  const std::string& path() const;
  /// Root attributes (program, version, frame of reference, ...) of the HDF5 files written from now
  /// on.
  void set_attributes(TextAttributes attributes);
  /// After a restart: drops frames and rows of the history later than `time` [s]. Throws InputError
  /// when the history there has other columns than this `row`.
  void continue_from(double time, const std::vector<Quantity>& row);
  /// frames/NNNNNN.h5, frames.h5, frames.xmf: packs and writes, and leaves the disk to another
  /// thread. Errors may be thrown by the next call that waits.
  void write_frame(const OutputFrame& frame);
  void wait();  ///< until the last frame is on disk
  void write_history(
      const std::vector<Quantity>& row);  ///< a line of history.csv; the first column is time
  void write_checkpoint(const Checkpoint& checkpoint);  ///< checkpoint.h5
  /// gauge_NAME.csv and, with the next flush, the group gauges/NAME of history.h5.
  void write_gauge(SeriesTable table);
  /// NAME.csv and NAME.h5, whole.
  void write_table(const std::string& name, const std::vector<TableColumn>& columns);
  void write_summary(const Json& summary);                            ///< summary.json
  void write_text(const std::string& name, const std::string& text);  ///< resolved.yaml
  void write_log(const std::string& line);  ///< log.txt; never throws: no run ends for its log
  void flush();  ///< the frame is written; history.h5 catches up with history.csv

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

Checkpoint read_checkpoint(
    const std::string& file);           ///< throws InputError when unreadable or not ours
std::string to_text(const Json& json);  ///< indented JSON, non-finite numbers as null

}  // namespace krater
