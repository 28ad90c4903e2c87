// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/points/layout.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "krater/core/errors.hpp"

namespace krater {

namespace {

template <class Columns>
auto find_column(Columns& columns, std::string_view name) {
  return std::find_if(columns.begin(), columns.end(),
                      [&](const Column& c) { return name == c.field->name; });
}

void check_record(const std::vector<Column>& columns, const std::vector<std::string>& readers) {
  for (const std::string& request : readers) {
    const auto bar = request.find('|');
    const std::string reader = request.substr(0, bar);
    const std::string field = request.substr(bar + 1);
    if (!find_column(columns, field)->written) {
      throw InputError{reader + " reads the field '" + field +
                       "' but nothing in this material writes it (add the block that computes it)"};
    }
  }
}

}  // namespace

int Layout::resolve(const FieldInfo& field) const {
  if (field.components == kPerAxis) return dimension_;
  if (field.components == kPerAxisSquared) return dimension_ * dimension_;
  return field.components;
}

int Layout::offset_or_absent(const Record& record, const FieldInfo& field) {
  const auto column = find_column(record.columns, field.name);
  return column == record.columns.end() ? -1 : column->offset;
}

int Layout::request(Record& record, const FieldInfo& field, double initial, const char* who,
                    bool writes) {
  auto column = find_column(record.columns, field.name);
  if (column == record.columns.end()) {
    const int components = resolve(field);
    record.columns.push_back({&field, components, record.stride, 0.0, false});
    record.stride += components * kLanes;
    column = record.columns.end() - 1;
  }
  if (writes) {
    // A stage that only accumulates into a column (initial 0) leaves the value to the one that
    // knows it.
    if (initial != 0.0 && column->initial != 0.0 && initial != column->initial) {
      throw std::logic_error{std::string{who} + ": field '" + field.name +
                             "' already has another initial value"};
    }
    if (initial != 0.0) column->initial = initial;
    column->written = true;
  } else if (!column->written) {
    record.readers.push_back(std::string{who} + '|' + field.name);
  }
  return column->offset;
}

const Column* Layout::find(const char* name) const {
  const auto column = find_column(state_.columns, name);
  return column == state_.columns.end() ? nullptr : &*column;
}

void Layout::check() const {
  check_record(state_.columns, state_.readers);
  check_record(local_.columns, local_.readers);
}

}  // namespace krater
