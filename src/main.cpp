// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/command_line.hpp"
#include "krater/core/ranks.hpp"
#include "krater/core/waiting.hpp"

int main(int argc, char** argv) {
  krater::wait_briefly(argv);
  krater::ranks::start(argc, argv);
  const int code = krater::command_line(argc, argv);
  krater::ranks::finish();
  return krater::ranks::first() ? code : 0;  // a launcher ends all when one is not 0, unheard
}
