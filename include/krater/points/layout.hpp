// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file points/layout.hpp
/// Which columns a body's points have. Asking for a field is declaring it: a column exists only if
/// some stage, the method or the output asked for it; a column that is read but never written is an
/// error at assembly.
///
/// Points are stored in lane groups of 8 (AoSoA): the record of a group is `stride()` doubles,
/// component k of a field with offset o lies at `record[o + 8 k .. o + 8 k + 7]`. State records
/// persist; local records exist while a batch is updated.
#include <string>
#include <vector>

#include "krater/points/fields.hpp"

namespace krater {

inline constexpr int kLanes = 8;

/// Handles: how a stage uses a field. The type says what is allowed, `offset` is in doubles inside
/// the record.
template <Field F>
struct Input {
  int offset;
};  ///< state, read only
template <Field F>
struct State {
  int offset;
};  ///< state, read and written
template <Field F>
struct LocalInput {
  int offset;
};  ///< local, read only
template <Field F>
struct LocalOutput {
  int offset;
};  ///< local, written
template <Field F>
struct Optional {
  int offset;
};  ///< state, zeros when nobody declared it (offset -1)
template <Field F>
struct LocalOptional {
  int offset;
};  ///< local, zeros when nobody wrote it (offset -1)

struct Column {
  const FieldInfo* field;
  int components;  ///< resolved for the dimension
  int offset;      ///< doubles inside the record
  double initial;  ///< value of a new point
  bool written;    ///< some stage or the method writes it
};

class Layout {
 public:
  explicit Layout(int dimension) : dimension_{dimension} {}

  int dimension() const { return dimension_; }
  int stride() const { return state_.stride; }        ///< doubles per lane group, state
  int local_stride() const { return local_.stride; }  ///< doubles per lane group, local
  int local_stride_or_one() const { return local_.stride > 0 ? local_.stride : 1; }
  const std::vector<Column>& columns() const { return state_.columns; }
  const std::vector<Column>& locals() const { return local_.columns; }
  const Column* find(const char* name) const;  ///< nullptr if there is no such state column

  /// Read a state column that the method or a stage declared (or will declare) as state; see
  /// check().
  template <Field F>
  Input<F> input(const char* reader) {
    return {request(state_, F::info, 0.0, reader, false)};
  }
  /// Declare and write a state column; `initial` is the value of a new point.
  template <Field F>
  State<F> state(double initial, const char* writer) {
    return {request(state_, F::info, initial, writer, true)};
  }
  template <Field F>
  LocalInput<F> local_input(const char* reader) {
    return {request(local_, F::info, 0.0, reader, false)};
  }
  template <Field F>
  LocalOutput<F> local_output(const char* writer) {
    return {request(local_, F::info, 0.0, writer, true)};
  }
  /// Present only if declared before this call: ask after the writers (stages are made in stage
  /// order).
  template <Field F>
  Optional<F> optional() const {
    return {offset_or_absent(state_, F::info)};
  }
  template <Field F>
  LocalOptional<F> local_optional() const {
    return {offset_or_absent(local_, F::info)};
  }

  /// Every column that is read is written by somebody; throws InputError naming reader and field.
  void check() const;

 private:
  struct Record {
    std::vector<Column> columns;
    int stride = 0;
    std::vector<std::string> readers;  ///< "reader|field" of requests not written at the time
  };
  int request(Record& record, const FieldInfo& field, double initial, const char* who, bool writes);
  static int offset_or_absent(const Record& record, const FieldInfo& field);
  int resolve(const FieldInfo& field) const;

  int dimension_;
  Record state_, local_;
};

}  // namespace krater
