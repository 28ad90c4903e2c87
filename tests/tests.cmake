# SPDX-License-Identifier: GPL-3.0-or-later
# Tests, by layer (ctest labels unit, contract, verification, scene, style). One ctest entry per test
# source file, by its folder; an entry that finds no test case fails.
# Files named *_support.cpp are compiled with the tests and hold no cases.
find_package(doctest CONFIG REQUIRED)

set(layers unit contract verification)
set(cost_unit 1)
set(cost_contract 10)
set(cost_verification 50)
set(test_sources ${CMAKE_CURRENT_LIST_DIR}/test_main.cpp)
set(isa_digest ${CMAKE_CURRENT_LIST_DIR}/unit/core/isa_digest.cpp)
# Tests set their numbers of threads themselves; idle threads must not spin when ctest runs two tests.
set(test_environment OMP_NUM_THREADS=1 OMP_WAIT_POLICY=passive
  KRATER_SOURCE_DIR=${PROJECT_SOURCE_DIR} KRATER_BUILD_DIR=${PROJECT_BINARY_DIR})

foreach(layer IN LISTS layers)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/${layer}/*.cpp)
  list(REMOVE_ITEM files ${isa_digest})
  list(APPEND test_sources ${files})
  list(FILTER files EXCLUDE REGEX "_support\\.cpp$")
  foreach(file IN LISTS files)
    cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_LIST_DIR} OUTPUT_VARIABLE relative)
    string(REGEX REPLACE "(_test)?\\.cpp$" "" name ${relative})
    add_test(NAME ${name} COMMAND krater_tests --no-colors
      --source-file=*/tests/${relative} WORKING_DIRECTORY ${PROJECT_BINARY_DIR})
    set_tests_properties(${name} PROPERTIES LABELS ${layer} COST ${cost_${layer}} TIMEOUT 900
      ENVIRONMENT "${test_environment}" FAIL_REGULAR_EXPRESSION "test cases: +0 ")
  endforeach()
endforeach()

add_executable(krater_tests ${test_sources})
target_include_directories(krater_tests PRIVATE ${CMAKE_CURRENT_LIST_DIR} ${PROJECT_SOURCE_DIR}/src)
target_compile_definitions(krater_tests PRIVATE KRATER_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
target_link_libraries(krater_tests PRIVATE krater_core doctest::doctest PkgConfig::HDF5 yaml-cpp)
if(EXISTS ${isa_digest})
  foreach(level IN LISTS levels)
    krater_add_hot(krater_isa_digest_${level} ${level} ${isa_digest})
    target_sources(krater_tests PRIVATE $<TARGET_OBJECTS:krater_isa_digest_${level}>)
    list(APPEND isa_check_arguments --level isa_${level} $<TARGET_OBJECTS:krater_isa_digest_${level}>)
  endforeach()
endif()

# Scene tests: scripts that drive the program as a user does.
file(GLOB scripts CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/scene/*.py)
list(FILTER scripts EXCLUDE REGEX "/(_[^/]*|[^/]*_support\\.py)$")
if(TARGET krater)
  foreach(script IN LISTS scripts)
    cmake_path(GET script STEM name)
    add_test(NAME scene/${name} COMMAND ${Python3_EXECUTABLE} ${script})
    set_tests_properties(scene/${name} PROPERTIES LABELS scene COST 100 TIMEOUT 1200
      ENVIRONMENT "${test_environment};KRATER=$<TARGET_FILE:krater>;PYTHONDONTWRITEBYTECODE=1"
      SKIP_RETURN_CODE 77)
  endforeach()
endif()

# Style: layering, formatting, and the separation of the instruction-set levels.
add_test(NAME style/includes
  COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/check_includes.py)
add_test(NAME style/includes_self_test
  COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/check_includes.py --self-test)
add_test(NAME style/references
  COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/check_references.py)
add_test(NAME style/references_self_test
  COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/check_references.py --self-test)
add_test(NAME style/format COMMAND ${PROJECT_SOURCE_DIR}/tools/check_format)
set_tests_properties(style/format PROPERTIES SKIP_RETURN_CODE 77)
set(style_tests style/includes style/includes_self_test style/references style/references_self_test style/format)
if(isa_check_arguments)
  add_test(NAME style/isa COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/check_isa.py
    ${isa_check_arguments} COMMAND_EXPAND_LISTS)
  list(APPEND style_tests style/isa)
endif()
set_tests_properties(${style_tests} PROPERTIES LABELS style TIMEOUT 120)

include(${CMAKE_CURRENT_LIST_DIR}/bench/bench.cmake)
