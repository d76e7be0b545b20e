# Settings of all targets.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# A change inside a shared library does not link again all programs that use it.
set(CMAKE_LINK_DEPENDS_NO_SHARED ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# Output folders for programs, libraries and plugins, in the layout of the install.
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib")
set(DISMANTLE_PLUGIN_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib/dismantle/plugins")
set(DISMANTLE_PLUGIN_INSTALL_DIR "${CMAKE_INSTALL_LIBDIR}/dismantle/plugins")
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR};$ORIGIN;$ORIGIN/../..")

find_program(DISMANTLE_CCACHE ccache)
if(DISMANTLE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Relative to the source folder, so that another clone takes from the cache what this one has compiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros
    "CCACHE_BASEDIR=${CMAKE_SOURCE_DIR}" ${DISMANTLE_CCACHE})
endif()

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
dismantle_built_with(Eigen "${Eigen3_VERSION}")
dismantle_built_with(fmt "${fmt_VERSION}")

add_library(dismantle_settings INTERFACE)
target_compile_options(dismantle_settings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
# GCC 12 reports false overflows in moves of std::string (GCC bugs 105329, 105651).
target_compile_options(dismantle_settings INTERFACE
  "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread;-Wno-restrict>")
# The same source must give the same floating-point results in every build type of one compiler.
target_compile_options(dismantle_settings INTERFACE -ffp-contract=off)
# Library functions are never interposed, so calls inside a library can bypass the PLT.
target_compile_options(dismantle_settings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
target_link_options(dismantle_settings INTERFACE -Wl,-Bsymbolic-functions)
# A library must link all libraries that it uses. (With sanitizers the program provides their symbols.)
if(NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
  target_link_options(dismantle_settings INTERFACE "LINKER:-z,defs")
endif()
if(DISMANTLE_CCACHE)
  target_compile_options(dismantle_settings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endif()

# Headers that most files include cost two to three seconds per file. They are precompiled once for all libraries and
# plugins, and once more, with Google Test, for all test programs.
# -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON with -DDISMANTLE_UNITY=OFF reveals missing includes.
set(DISMANTLE_COMMON_HEADERS
  <Eigen/Core> <Eigen/Geometry>
  <algorithm> <array> <atomic> <cerrno> <chrono> <cmath> <condition_variable> <cstdint> <cstring> <deque> <filesystem>
  <fstream> <functional> <limits> <map> <memory> <mutex> <numeric> <optional> <set> <span> <string> <thread>
  <unordered_map> <utility> <variant> <vector>
  <fmt/format.h>)

# dismantle_pch(NAME HEADER...): an empty library that holds a precompiled header for others.
function(dismantle_pch name)
  file(WRITE "${CMAKE_BINARY_DIR}/pch/${name}.cpp.in" "// Nothing but the precompiled header.\n")
  configure_file("${CMAKE_BINARY_DIR}/pch/${name}.cpp.in" "${CMAKE_BINARY_DIR}/pch/${name}.cpp" COPYONLY)
  add_library(${name} OBJECT "${CMAKE_BINARY_DIR}/pch/${name}.cpp")
  target_link_libraries(${name} PRIVATE dismantle_settings Eigen3::Eigen Threads::Threads fmt::fmt)
  target_precompile_headers(${name} PRIVATE ${ARGN})
endfunction()

# A precompiled header is valid only for targets with the same macros and the same kind of position-independent
# code.
function(dismantle_reuse_pch target name)
  target_precompile_headers(${target} REUSE_FROM ${name})
  target_compile_definitions(${target} PRIVATE $<TARGET_PROPERTY:fmt::fmt,INTERFACE_COMPILE_DEFINITIONS>)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "EXECUTABLE")
    target_compile_options(${target} PRIVATE -fPIC)
  endif()
endfunction()

dismantle_pch(dismantle_common_pch ${DISMANTLE_COMMON_HEADERS})
function(dismantle_precompile target)
  dismantle_reuse_pch(${target} dismantle_common_pch)
  dismantle_unity(${target} BATCH 8)
endfunction()
# The libraries of lib/ export their types, so the header types in them must be visible too.
dismantle_pch(dismantle_library_pch ${DISMANTLE_COMMON_HEADERS})
set_target_properties(dismantle_library_pch PROPERTIES CXX_VISIBILITY_PRESET default)

# dismantle_unity(TARGET [EXCEPT FOLDER] | TARGET BATCH N): compiles the files of one folder as one unit, or N files at a time,
# so that common headers are compiled once. Two helpers in one folder cannot have the same name. OFF compiles less after a
# change in one file.
option(DISMANTLE_UNITY "Compile the files of one folder together" ON)
function(dismantle_unity target)
  if(NOT DISMANTLE_UNITY)
    return()
  endif()
  cmake_parse_arguments(ARG "" "BATCH;EXCEPT" "" ${ARGN})
  if(ARG_BATCH)
    get_target_property(sources ${target} SOURCES)
    list(LENGTH sources count)
    if(count LESS 2)
      return()
    endif()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${ARG_BATCH})
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_filename_component(folder "${source}" ABSOLUTE)
    file(RELATIVE_PATH folder "${CMAKE_CURRENT_SOURCE_DIR}" "${folder}")
    get_filename_component(folder "${folder}" DIRECTORY)
    get_filename_component(name "${folder}" NAME)
    if(NOT ARG_EXCEPT OR NOT name STREQUAL ARG_EXCEPT)
      string(MAKE_C_IDENTIFIER "of_${folder}" group)
      set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${group}")
    endif()
  endforeach()
endfunction()

# dismantle_add_late_library(NAME SOURCES ... LIBRARIES ...): a library that a plugin or a program loads on first use
# (dismantle/plugin/late_library.h), with its own dependencies. It is in the folder of the other libraries.
function(dismantle_add_late_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_library(${name} MODULE ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE dismantle_settings ${ARG_LIBRARIES})
  dismantle_precompile(${name})
  install(TARGETS ${name} LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}")
endfunction()

# Settings of a Google Test program. Low optimisation, because each test runs once; the libraries under test keep theirs.
# GCC compiles what includes a precompiled header with the optimisation of that header, whatever the command line says, so
# the header has the option, too.
function(dismantle_use_test_pch target)
  if(NOT TARGET dismantle_test_pch)
    dismantle_pch(dismantle_test_pch ${DISMANTLE_COMMON_HEADERS} <gtest/gtest.h>)
    target_link_libraries(dismantle_test_pch PRIVATE GTest::gtest)
    target_compile_options(dismantle_test_pch PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  dismantle_reuse_pch(${target} dismantle_test_pch)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# What `./check --sanitize` builds, and runs as the CTest tests with the label `sanitized`, and with the thread sanitizer `threads`.
add_custom_target(sanitized_tests)
add_custom_target(threads_tests)

# dismantle_add_test(NAME SOURCES ... LIBRARIES ... [NEEDS FOLDER...] [USES FOLDER...] [THREADS FILTER] [COST SECONDS]
# [UNSANITIZED]): a Google Test program, run as one CTest test. It loads the plugins of these folders at run time. If one of
# NEEDS is missing, the test is left out with a message; those of USES are optional. THREADS: the tests that use threads, as a
# filter of Google Test; only these run with the thread sanitizer. COST: about how long a long test takes; the longest begin
# first. UNSANITIZED: a library of others is not clean under the sanitizers.
function(dismantle_add_test name)
  if(NOT DISMANTLE_BUILD_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "UNSANITIZED" "THREADS;COST" "SOURCES;LIBRARIES;NEEDS;USES" ${ARGN})
  dismantle_left_out(missing ${name} ${ARG_NEEDS})
  if(missing)
    return()
  endif()
  find_package(GTest REQUIRED)
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE dismantle_settings ${ARG_LIBRARIES} GTest::gtest GTest::gtest_main)
  dismantle_use_test_pch(${name})
  dismantle_unity(${name} BATCH 6)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/tests")
  dismantle_uses(${name} ${ARG_NEEDS} ${ARG_USES})
  set(filter "")
  set(labels "")
  if(ARG_THREADS)
    list(APPEND labels threads)
    add_dependencies(threads_tests ${name})
    if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=thread")
      set(filter "--gtest_filter=${ARG_THREADS}")
    endif()
  endif()
  if(NOT ARG_UNSANITIZED)
    list(APPEND labels sanitized)
    add_dependencies(sanitized_tests ${name})
  endif()
  add_test(NAME ${name} COMMAND ${name} ${filter})
  set(limit 2400)  # s, against hanging tests also on a slow machine; sanitizers slow tests down up to twenty times
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
    set(limit 7200)
  endif()
  if("$ENV{DISMANTLE_TESTS}" STREQUAL "nightly")
    set(limit 86400)  # the nightly form has up to a thousand times as many trials
  endif()
  if(ARG_COST)
    set_tests_properties(${name} PROPERTIES COST ${ARG_COST})
  endif()
  set_tests_properties(${name} PROPERTIES TIMEOUT ${limit} LABELS "${labels}"
    ENVIRONMENT "DISMANTLE_PLUGIN_PATH=${DISMANTLE_PLUGIN_OUTPUT_DIRECTORY}")
endfunction()
