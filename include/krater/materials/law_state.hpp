// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// State columns that a law owns. A law with history declares
///   using State = Columns<field::Distension>;       its columns: checkpoint, output and migration
///                                                    follow by themselves; a column that no other
///                                                    code knows is a struct of the law itself,
///                                                    struct X { static constexpr FieldInfo info; }
///   std::array<double, N> initial_state() const     of a new point
///   template <class Real> auto at(const std::array<Real, N>& state) const
/// and `at` gives the law as it is at that state: an object with the functions that the family asks
/// of a law without history. A stage binds every lane group so and writes back what the bound law
/// says of the end of the step; a law without a State is its own bound law, at no cost.
/// A column belongs to one law: declaring it twice, in one law or in two, is an error.
#pragma once

#include <array>
#include <type_traits>

#include "krater/points/batch.hpp"

namespace krater {

/// Throws std::logic_error where the layout has the column already (stage.cpp: hot code holds no
/// messages).
void require_unowned(const Layout& layout, const FieldInfo& field, const char* law);

}  // namespace krater

namespace krater::inline KRATER_ISA {

template <Field... F>
struct Columns {
  static constexpr int count = sizeof...(F);
  static constexpr std::array<const FieldInfo*, sizeof...(F)> infos{&F::info...};
};

template <class Law>
concept OwnsState = requires {
  typename Law::State;
};

/// The law at the state of a new point.
template <class Law>
KRATER_FORCE_INLINE decltype(auto) at_start(const Law& law) {
  if constexpr (OwnsState<Law>) {
    return law.at(law.initial_state());
  } else {
    return (law);
  }
}

/// The columns of a law without history: none.
template <class Law>
class StateOf {
 public:
  StateOf(const Law&, Layout&) {}
  KRATER_FORCE_INLINE const Law& at(const Law& law, const BatchData&, int) const { return law; }
};

template <class Law>
requires OwnsState<Law>
class StateOf<Law> {
 public:
  StateOf(const Law& law, Layout& layout) { declare(law, layout, typename Law::State{}); }

  KRATER_FORCE_INLINE auto at(const Law& law, const BatchData& batch, int g) const {
    std::array<Pack, count> state;
    for (unsigned k = 0; k < count; ++k) state[k] = column(batch, k)(g);
    return law.at(state);
  }
  KRATER_FORCE_INLINE void set(const BatchData& batch, int g,
                               const std::array<Pack, Law::State::count>& state) const {
    for (unsigned k = 0; k < count; ++k) column(batch, k).set(g, state[k]);
  }

 private:
  static constexpr unsigned count = Law::State::count;

  template <Field... F>
  void declare(const Law& law, Layout& layout, Columns<F...>) {
    const std::array<double, count> initial = law.initial_state();
    unsigned k = 0;
    const auto one = [&]<class Column>() {
      require_unowned(layout, Column::info, Law::name);
      offsets_[k] = layout.state<Column>(initial[k], Law::name).offset;
      ++k;
    };
    (one.template operator()<F>(), ...);
  }
  KRATER_FORCE_INLINE WriteView column(const BatchData& batch, unsigned k) const {
    return {batch.state + offsets_[k], batch.state_stride};
  }

  std::array<int, count> offsets_{};
};

/// Reads the columns of a law where they are not written: before its own stage.
template <class Law>
class StateReader {};

template <class Law>
requires OwnsState<Law>
class StateReader<Law> {
 public:
  StateReader() = default;
  explicit StateReader(Layout& layout) { ask(layout, typename Law::State{}); }

  KRATER_FORCE_INLINE auto operator()(const BatchData& batch, int g) const {
    std::array<Pack, Law::State::count> state;
    for (unsigned k = 0; k < Law::State::count; ++k)
      state[k] = ReadView{batch.state + offsets_[k], batch.state_stride}(g);
    return state;
  }

 private:
  template <Field... F>
  void ask(Layout& layout, Columns<F...>) {
    unsigned k = 0;
    ((offsets_[k++] = layout.input<F>(Law::name).offset), ...);
  }
  std::array<int, Law::State::count> offsets_{};
};

}  // namespace krater::inline KRATER_ISA
