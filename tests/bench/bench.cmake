# SPDX-License-Identifier: GPL-3.0-or-later
# Benchmarks: not part of the default build; `tools/bench` builds and runs them.
set(bench ${CMAKE_CURRENT_LIST_DIR})
add_executable(krater_bench_laws EXCLUDE_FROM_ALL
  ${bench}/laws.cpp ${bench}/calibration.cpp ${bench}/../contract/material_support.cpp)
target_include_directories(krater_bench_laws PRIVATE ${bench}/.. ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(krater_bench_laws PRIVATE krater_core)
foreach(level IN LISTS levels)
  krater_add_hot(krater_bench_calibration_${level} ${level} ${bench}/calibration_hot.cpp)
  set_target_properties(krater_bench_calibration_${level} PROPERTIES EXCLUDE_FROM_ALL ON)
  target_include_directories(krater_bench_calibration_${level} PRIVATE ${bench}/..)
  target_sources(krater_bench_laws PRIVATE $<TARGET_OBJECTS:krater_bench_calibration_${level}>)
endforeach()
