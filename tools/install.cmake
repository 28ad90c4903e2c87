# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install` and `cpack -G DEB` put where. The program finds cards and Python packages from where it lies:
# installed (paths relative to its own), and in the build tree (links to the sources).
include(GNUInstallDirs)
set(share ${CMAKE_INSTALL_DATADIR}/krater)
# Debian's folder for every python3; below /usr that python looks there by itself, elsewhere PYTHONPATH names it.
set(KRATER_PYTHON_DIR lib/python3/dist-packages CACHE STRING "Where the module krater_results goes, below the prefix")

install(TARGETS krater RUNTIME)
install(DIRECTORY inputs/materials DESTINATION ${share})
install(DIRECTORY inputs/ DESTINATION ${share}/examples PATTERN materials EXCLUDE)
install(FILES README.md LICENSE src/THEORY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES src/output/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME RESULTS.md)

# Tools that read results or draw scenes: each is also a command, krater-plot-run for plot_run. Those of developers
# (build, test, validate, bench) need the sources and stay there.
set(tools plot_run plot_scene plot_point show_summary three_cells to_vtkhdf)
if(EXISTS ${PROJECT_SOURCE_DIR}/tools/report)
  list(APPEND tools report)
endif()
list(TRANSFORM tools PREPEND tools/ OUTPUT_VARIABLE programs)
install(PROGRAMS ${programs} DESTINATION ${share}/tools)
file(GLOB modules CONFIGURE_DEPENDS tools/*.py)
list(FILTER modules EXCLUDE REGEX "/(check|validate|bench|hard|write)_[^/]*$|/(stability|expectations|krater_results)[.]py$")
install(FILES ${modules} DESTINATION ${share}/tools)
if(EXISTS ${PROJECT_SOURCE_DIR}/tools/report_page)  # parts of the page that tools/report makes
  install(DIRECTORY tools/report_page DESTINATION ${share}/tools)
endif()
install(DIRECTORY tools/krater_study DESTINATION ${share}/tools FILES_MATCHING PATTERN "*.py" PATTERN __pycache__ EXCLUDE)
install(FILES tools/krater_results.py DESTINATION ${KRATER_PYTHON_DIR})
file(RELATIVE_PATH from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_DATADIR}/krater/tools)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/commands)
foreach(tool IN LISTS tools)
  string(REPLACE "_" "-" command krater-${tool})
  file(CREATE_LINK ${from_bin}/${tool} ${PROJECT_BINARY_DIR}/commands/${command} SYMBOLIC)
  install(FILES ${PROJECT_BINARY_DIR}/commands/${command} DESTINATION ${CMAKE_INSTALL_BINDIR})
endforeach()

# The pages of the manual system say what --help says, and are written from it.
add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/krater.1
  COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/write_man.py $<TARGET_FILE:krater> ${PROJECT_BINARY_DIR}/krater.1
  DEPENDS krater tools/write_man.py VERBATIM COMMENT "Manual page")
add_custom_target(krater_man ALL DEPENDS ${PROJECT_BINARY_DIR}/krater.1)
install(FILES ${PROJECT_BINARY_DIR}/krater.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES tools/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME krater)

# Where the program looks for them.
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/inputs/materials ${PROJECT_BINARY_DIR}/materials SYMBOLIC)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/tools/krater_study ${PROJECT_BINARY_DIR}/krater_study SYMBOLIC)
file(RELATIVE_PATH cards ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_DATADIR}/krater/materials)
file(RELATIVE_PATH study ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_DATADIR}/krater/tools/krater_study)
set_source_files_properties(src/scene/yaml/cards.cpp PROPERTIES COMPILE_DEFINITIONS
  "KRATER_INSTALLED_CARDS=\"${cards}\"")
set_source_files_properties(src/app/study.cpp PROPERTIES COMPILE_DEFINITIONS
  "KRATER_INSTALLED_STUDY=\"${study}\";KRATER_PYTHON=\"${Python3_EXECUTABLE}\"")

# A Debian package: dpkg-shlibdeps finds the libraries, the tools need Python's.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME krater)
set(CPACK_PACKAGE_CONTACT "Krater <krater@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS
  "python3, python3-numpy, python3-scipy, python3-pandas, python3-h5py, python3-matplotlib, python3-yaml")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "bash-completion, ffmpeg, python3-vtk9, xvfb")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "Material Point Method for impact, penetration and fragmentation
 Bodies are material points that carry mass, velocity, stress and damage through
 a background grid. One scene file in YAML describes a case, axisymmetric, in
 plane strain or in 3D. With material cards, examples and tools for pictures.")
include(CPack)
