# One interface target carries the warnings and the floating-point rules of the project's own code.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

option(VDBEAM_WARNINGS_AS_ERRORS "Treat warnings as errors" ${PROJECT_IS_TOP_LEVEL})
set(VDBEAM_SANITIZE "" CACHE STRING "Sanitizers to compile with, e.g. address,undefined or thread")

add_library(vdbeam_options INTERFACE)
# A unity build compiles several files as one, where the constants of one are globals to the others:
# only locals that shadow locals count there.
# No contraction outside the SIMD kernels: the same source gives the same bits at every optimisation
# level, which the bit-identity tests rely on.
target_compile_options(vdbeam_options INTERFACE -Wall -Wextra -Wpedantic -Wconversion
                       -Wno-sign-conversion $<IF:$<CXX_COMPILER_ID:GNU>,-Wshadow=local,-Wshadow>
                       -ffp-contract=off -fno-math-errno)
# GCC 12 sees overlaps in moved strings that there are not (its bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(vdbeam_options INTERFACE -Wno-restrict)
endif()
if(VDBEAM_WARNINGS_AS_ERRORS)
  target_compile_options(vdbeam_options INTERFACE -Werror)
endif()
if(VDBEAM_SANITIZE)
  add_compile_options(-fsanitize=${VDBEAM_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${VDBEAM_SANITIZE})
  # GCC's analysis sees uninitialised values in the checks that the sanitizers insert (its manual,
  # -fsanitize), e.g. in every std::variant.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(vdbeam_options INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # What ccache's manual asks for where headers are precompiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
endif()

# What most files include, compiled once for each program: a quarter to a half of the time of a build.
set(VDBEAM_PRECOMPILED_HEADERS
    <algorithm> <array> <cmath> <cstdint> <cstring> <filesystem> <fstream> <functional> <limits> <map>
    <memory> <mutex> <numeric> <optional> <random> <set> <span> <sstream> <string> <thread> <utility>
    <variant> <vector> <fmt/format.h> <tbb/parallel_for.h>)
# For code where the compiler takes longer than the program would gain.
set(VDBEAM_LIGHT_OPTIMISATION $<$<CONFIG:Release>:-O1>)
