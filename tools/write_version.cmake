# SPDX-License-Identifier: GPL-3.0-or-later
# Run at every build: writes HEADER with the version and the git revision, only if it changed.
set(git git -c safe.directory=* -C ${SOURCE_DIR})
execute_process(COMMAND ${git} rev-parse --short=12 HEAD
  OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
if(failed)
  set(revision "unknown")
else()
  execute_process(COMMAND ${git} status --porcelain --untracked-files=no
    OUTPUT_VARIABLE changes OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(changes)
    string(APPEND revision "+modified")
  endif()
endif()
set(content "// Written by tools/write_version.cmake at build time.
#pragma once
#define KRATER_VERSION \"${VERSION}\"
#define KRATER_GIT_REVISION \"${revision}\"
#define KRATER_COMPILER \"${COMPILER}\"
#define KRATER_BUILD_OPTIONS \"${OPTIONS}\"
#define KRATER_BUILD_TYPE \"${BUILD_TYPE}\"
")
if(EXISTS ${HEADER})
  file(READ ${HEADER} previous)
endif()
if(NOT "${previous}" STREQUAL "${content}")
  file(WRITE ${HEADER} "${content}")
endif()
