# SPDX-License-Identifier: MIT
# talus_unit_suite(NAME [SOURCE FILE]) builds the pFUnit suite NAME.pf into a program and a test.
# pFUnit is used where it is found (CMAKE_PREFIX_PATH), else tests/pf/.

find_package(PFUNIT 4.4 QUIET)
if(PFUNIT_FOUND)
  message(STATUS "Unit tests run under pFUnit ${PFUNIT_VERSION}")
else()
  message(STATUS "Unit tests run under tests/pf (pFUnit was not found)")
  add_library(talus_funit STATIC
    pf/funit_report.f90
    pf/funit_compare.f90
    pf/funit.f90)
  set_target_properties(talus_funit PROPERTIES
    Fortran_MODULE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/funit")
  target_include_directories(talus_funit PUBLIC "${CMAKE_CURRENT_BINARY_DIR}/funit")
  target_link_libraries(talus_funit PRIVATE talus_options)
endif()

# Small models, decks and runs that the suites share.
add_library(talus_models STATIC unit/models.f90 unit/decks.f90 unit/runs.f90 unit/speeds.f90)
set_target_properties(talus_models PROPERTIES
  Fortran_MODULE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/models")
target_include_directories(talus_models PUBLIC "${CMAKE_CURRENT_BINARY_DIR}/models")
target_link_libraries(talus_models PUBLIC talus_core PRIVATE talus_options)

# Build the program of one suite.
function(talus_unit_program name source)
  if(PFUNIT_FOUND)
    add_pfunit_ctest(${name} TEST_SOURCES "${source}" LINK_LIBRARIES talus_models)
    # pFUnit's generated source is not held to the style of TALUS.
    set_target_properties(${name} PROPERTIES COMPILE_WARNING_AS_ERROR OFF)
  else()
    set(program "${CMAKE_CURRENT_BINARY_DIR}/${name}.f90")
    set(translator "${PROJECT_SOURCE_DIR}/tests/pf/translate.py")
    add_custom_command(OUTPUT "${program}"
      COMMAND "${Python3_EXECUTABLE}" "${translator}"
        "${CMAKE_CURRENT_SOURCE_DIR}/${source}" "${program}"
      DEPENDS "${source}" "${translator}"
      COMMENT "Translating ${source}"
      VERBATIM)
    add_executable(${name} "${program}")
    set_target_properties(${name} PROPERTIES
      Fortran_MODULE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/modules/${name}")
    target_link_libraries(${name} PRIVATE talus_models talus_funit talus_options)
  endif()
endfunction()

# A suite passes when it says so: a `stop` in tested code would end it early with exit code 0.
# Each runs in a folder of its own, so that files written by suites side by side do not meet.
function(talus_unit_suite name)
  talus_unit_program(${name} unit/${name}.pf)
  if(NOT PFUNIT_FOUND)
    add_test(NAME ${name} COMMAND ${name})
  endif()
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/run/${name}")
  file(MAKE_DIRECTORY "${folder}")
  set_tests_properties(${name} PROPERTIES
    LABELS unit
    TIMEOUT 300
    WORKING_DIRECTORY "${folder}"
    # The program sees to it itself that its threads wait briefly.
    ENVIRONMENT "GOMP_SPINCOUNT=1000;OPENBLAS_NUM_THREADS=1;TALUS_SOURCE_DIR=${PROJECT_SOURCE_DIR}"
    PASS_REGULAR_EXPRESSION "\\([1-9][0-9]* tests?(, [0-9]+ disabled)?\\)"
    FAIL_REGULAR_EXPRESSION "FAILURES;Sanitizer;runtime error:;Encountered 1 or more")
endfunction()
