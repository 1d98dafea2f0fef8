# What every target shares: the language, the warnings, the sanitizers, the include root.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  # With precompiled headers its cache holds only so: see "Precompiled headers" in ccache's manual.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
endif()

add_library(lodestar_properties INTERFACE)
target_include_directories(lodestar_properties INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/lodestar>)
target_compile_features(lodestar_properties INTERFACE $<INSTALL_INTERFACE:cxx_std_20>)
# A field left out of a designated initializer takes the default that its struct gives it: meant so.
# For our own sources: who uses an installed library chooses his own.
target_compile_options(lodestar_properties INTERFACE
  "$<BUILD_INTERFACE:-Wall;-Wextra;-Wpedantic;-Wconversion;-Werror;-Wno-missing-field-initializers>")
if(NOT LODESTAR_TOGETHER)
  target_compile_options(lodestar_properties INTERFACE $<BUILD_INTERFACE:-Wshadow>)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  # libstdc++ 12 calls its own deprecated temporary buffers in std::stable_sort.
  target_compile_options(lodestar_properties INTERFACE -Wno-deprecated-declarations)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  # Remarks of how g++ 10 changed what it passes in registers: all of this is compiled by one compiler.
  target_compile_options(lodestar_properties INTERFACE $<BUILD_INTERFACE:-Wno-psabi>)
endif()
if(LODESTAR_SANITIZE)
  target_compile_options(lodestar_properties INTERFACE -fsanitize=${LODESTAR_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  target_link_options(lodestar_properties INTERFACE -fsanitize=${LODESTAR_SANITIZE})
endif()
if(LODESTAR_SANITIZE STREQUAL "thread")
  # gcc 12 then warns of fences in the standard library, and of a std::optional's insides that are never read.
  target_compile_options(lodestar_properties INTERFACE -Wno-tsan -Wno-maybe-uninitialized)
endif()
if(LODESTAR_FUZZ)
  target_compile_options(lodestar_properties INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(CCACHE_PROGRAM AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(lodestar_properties INTERFACE $<BUILD_INTERFACE:-fpch-preprocess>)
endif()

# Precompiled headers: what is slow to read and that many include, read once for each set of compiler flags. A source
# includes what it uses all the same: the presets with sanitizers build without them.
set(lodestar_headers_of_all <algorithm> <array> <cmath> <cstdint> <deque> <filesystem> <fstream> <functional> <map> <memory>
  <optional> <set> <span> <string> <variant> <vector> <Eigen/Cholesky> <Eigen/Eigenvalues> <Eigen/Geometry>)

# lodestar_library(NAME SOURCES ... USES ... [PRECOMPILES HEADER... | SHARES OTHER]): one room's target, its arrows on one
# line. It precompiles these headers besides those of all, or uses what another has precompiled. Several sources are compiled
# as one, for most of a compiler's time goes into headers. What hides a name is then found only where each source is compiled
# alone, as by the presets for lint and sanitizers.
function(lodestar_library name)
  cmake_parse_arguments(ARG "" "SHARES" "SOURCES;USES;PRECOMPILES" ${ARGN})
  add_library(lodestar_${name} STATIC ${ARG_SOURCES})
  target_link_libraries(lodestar_${name} PUBLIC lodestar_properties ${ARG_USES})
  if(ARG_SHARES)
    target_precompile_headers(lodestar_${name} REUSE_FROM lodestar_${ARG_SHARES})
  elseif(ARG_PRECOMPILES)
    target_precompile_headers(lodestar_${name} PRIVATE ${lodestar_headers_of_all} ${ARG_PRECOMPILES})
  endif()
  if(LODESTAR_TOGETHER)
    set_target_properties(lodestar_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
  endif()
endfunction()

# lodestar_test(NAME SOURCES ... USES ... [SLOW PATTERN]): the tests of one folder in one program. Those that match
# the pattern carry the label slow; the sanitizers leave them out. A test is compiled once and run once: with less
# optimization than what it tests, which is in the libraries, both together take less time. What warns by following values
# is wrong there now and then (g++ 12, of strings that are joined).
function(lodestar_test name)
  cmake_parse_arguments(ARG "" "SLOW" "SOURCES;USES" ${ARGN})
  add_executable(${name}_test ${ARG_SOURCES})
  target_link_libraries(${name}_test PRIVATE lodestar_properties ${ARG_USES} GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name}_test PRIVATE LODESTAR_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_compile_options(${name}_test PRIVATE
    $<$<CONFIG:Release>:-O1;-Wno-array-bounds;-Wno-maybe-uninitialized;-Wno-stringop-overflow>)
  if(name STREQUAL maps)
    target_precompile_headers(${name}_test PRIVATE ${lodestar_headers_of_all} <boost/container/static_vector.hpp>
      <nlohmann/json.hpp> <octomap/OcTree.h> <opencv2/core.hpp> <yaml-cpp/yaml.h> <gmock/gmock.h> <gtest/gtest.h>)
  elseif(ARG_USES MATCHES lodestar_)
    target_precompile_headers(${name}_test REUSE_FROM maps_test)
  endif()
  set(discovery WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} DISCOVERY_TIMEOUT 60)
  if(ARG_SLOW)
    gtest_discover_tests(${name}_test ${discovery} TEST_FILTER -${ARG_SLOW} PROPERTIES TIMEOUT 600)
    gtest_discover_tests(${name}_test ${discovery} TEST_FILTER ${ARG_SLOW} TEST_LIST ${name}_slow
      PROPERTIES TIMEOUT 600 LABELS slow)
  else()
    gtest_discover_tests(${name}_test ${discovery} PROPERTIES TIMEOUT 600)
  endif()
endfunction()
