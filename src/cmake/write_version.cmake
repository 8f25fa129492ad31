# SPDX-License-Identifier: MIT
# Writes the module talus_version at every build, and touches it only when the text changes.
# Called with -DSOURCE_DIR, -DTEMPLATE, -DOUTPUT, -DTALUS_VERSION.

set(TALUS_GIT_HASH unknown)
find_program(git NAMES git)
if(git AND EXISTS "${SOURCE_DIR}/.git")
  execute_process(COMMAND "${git}" -C "${SOURCE_DIR}" rev-parse --short=12 HEAD
    OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    execute_process(COMMAND "${git}" -C "${SOURCE_DIR}" diff --quiet HEAD -- src CMakeLists.txt
      ERROR_QUIET RESULT_VARIABLE changed)
    if(changed)
      string(APPEND hash "+")
    endif()
    set(TALUS_GIT_HASH "${hash}")
  endif()
endif()
configure_file("${TEMPLATE}" "${OUTPUT}" @ONLY)
