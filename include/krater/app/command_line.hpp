// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/command_line.hpp
/// krater run | check | point | study | models | schema. Exit codes: 0 done, 2 bad input, 3
/// numerical failure, 4 interrupted.
#include <string>

namespace krater {

int command_line(int argc, char** argv);

/// `krater check`: what would be run. Throws InputError.
struct RunOptions;
void print_check(const RunOptions& options);
/// `krater models [NAME]`.
void print_models(const char* name);
/// The same as one JSON object.
void print_models_json(const char* name);
/// `krater models --cards WORD`: cards in whose name, comment, law or constant the word stands.
/// Throws InputError where there is none.
void print_cards(const std::string& word);

}  // namespace krater
