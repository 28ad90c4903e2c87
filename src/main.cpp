// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/command_line.hpp"

int main(int argc, char** argv) { return krater::command_line(argc, argv); }
