# Settings that every target of the project shares.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# One tree for programs, one for libraries, one for plugins: the layout of the install.
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib")
set(DISMANTLE_PLUGIN_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib/dismantle/plugins")
set(DISMANTLE_PLUGIN_INSTALL_DIR "${CMAKE_INSTALL_LIBDIR}/dismantle/plugins")
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR};$ORIGIN;$ORIGIN/../..")

find_program(DISMANTLE_CCACHE ccache)
if(DISMANTLE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${DISMANTLE_CCACHE})
endif()

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)

add_library(dismantle_settings INTERFACE)
target_compile_options(dismantle_settings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
# The same source must give the same floating-point results in every build type of one compiler.
target_compile_options(dismantle_settings INTERFACE -ffp-contract=off)
if(DISMANTLE_CCACHE)
  target_compile_options(dismantle_settings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endif()

# Eigen and the common standard headers cost over a second per file: compile them once per library.
function(dismantle_precompile target)
  target_precompile_headers(${target} PRIVATE
    <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <cmath> <cstdint> <functional> <memory> <string> <vector>)
endfunction()

# dismantle_add_test(NAME SOURCES ... LIBRARIES ...): a Google Test program, run as one CTest test.
function(dismantle_add_test name)
  if(NOT DISMANTLE_BUILD_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  find_package(GTest REQUIRED)
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE dismantle_settings ${ARG_LIBRARIES} GTest::gtest GTest::gtest_main)
  target_precompile_headers(${name} PRIVATE <Eigen/Core> <Eigen/Geometry> <gtest/gtest.h> <string> <vector>)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/tests")
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES TIMEOUT 900
    ENVIRONMENT "DISMANTLE_PLUGIN_PATH=${DISMANTLE_PLUGIN_OUTPUT_DIRECTORY}")
endfunction()
