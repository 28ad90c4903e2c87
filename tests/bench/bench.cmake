# SPDX-License-Identifier: GPL-3.0-or-later
# Benchmarks: not part of the default build; `tools/bench` builds and runs them.
set(bench ${CMAKE_CURRENT_LIST_DIR})
foreach(level IN LISTS levels)
  krater_add_hot(krater_bench_calibration_${level} ${level} ${bench}/calibration_hot.cpp)
  set_target_properties(krater_bench_calibration_${level} PROPERTIES EXCLUDE_FROM_ALL ON)
  target_include_directories(krater_bench_calibration_${level} PRIVATE ${bench}/..)
endforeach()

function(krater_add_bench name)
  add_executable(krater_bench_${name} EXCLUDE_FROM_ALL ${bench}/${name}.cpp ${ARGN})
  target_include_directories(krater_bench_${name} PRIVATE ${bench}/.. ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(krater_bench_${name} PRIVATE krater_core)
endfunction()
function(krater_calibrates name)
  target_sources(krater_bench_${name} PRIVATE ${bench}/calibration.cpp)
  foreach(level IN LISTS levels)
    target_sources(krater_bench_${name} PRIVATE
      $<TARGET_OBJECTS:krater_bench_calibration_${level}>)
  endforeach()
endfunction()

krater_add_bench(laws ${bench}/../contract/material_support.cpp)
krater_calibrates(laws)
krater_add_bench(machine)
krater_calibrates(machine)
krater_add_bench(steps)
