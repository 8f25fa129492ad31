# SPDX-License-Identifier: MIT
# Compiler options of every TALUS target, carried by the interface target talus_options.
# Never value-changing optimisation: it would void the checks for NaN.

add_library(talus_options INTERFACE)

set(gnu "$<COMPILE_LANG_AND_ID:Fortran,GNU>")
set(gnu_debug "$<AND:${gnu},$<CONFIG:Debug>>")

target_compile_options(talus_options INTERFACE
  "$<${gnu}:-std=f2008;-pedantic;-Wall;-Wextra;-Wimplicit-interface;-Wimplicit-procedure>"
  "$<${gnu}:-Wconversion-extra;-Wcharacter-truncation;-fbacktrace>"
  # gfortran 12 takes descriptors of allocatables it sets up itself for uninitialised.
  # Debug's signalling NaN catches reals that are.
  "$<${gnu}:-Wno-uninitialized;-Wno-maybe-uninitialized>"
  "$<${gnu_debug}:-Og;-fcheck=all;-finit-real=snan>")

# The trap is armed by the main program; HDF5 1.14.3 itself raises `invalid` while it starts.
if(HDF5_VERSION VERSION_EQUAL 1.14.3)
  set(traps zero,overflow)
else()
  set(traps invalid,zero,overflow)
endif()
target_compile_options(talus_options INTERFACE "$<${gnu_debug}:-ffpe-trap=${traps}>")

# No fused multiply-add, which rounds once instead of twice: results are the same bits on machines
# that have it and on those that do not.
target_compile_options(talus_options INTERFACE "$<${gnu}:-ffp-contract=off>")
if(TALUS_AVX2)
  target_compile_options(talus_options INTERFACE "$<${gnu}:-mavx2>")
endif()
if(TALUS_NATIVE)
  target_compile_options(talus_options INTERFACE "$<${gnu}:-march=native>")
endif()

if(TALUS_COVERAGE)
  target_compile_options(talus_options INTERFACE "$<${gnu}:--coverage>")
  target_link_options(talus_options INTERFACE --coverage)
endif()

if(TALUS_SANITIZE)
  target_compile_options(talus_options INTERFACE
    "$<${gnu}:-fsanitize=${TALUS_SANITIZE};-fno-omit-frame-pointer>")
  target_link_options(talus_options INTERFACE "-fsanitize=${TALUS_SANITIZE}")
endif()
