# dismantle_add_library(NAME [PUBLIC lib...] [PRIVATE lib...]): the library of a folder of lib/, from src/**.cpp, with its public
# headers in include/. It exports all symbols, so that its tests can also use internal ones.
function(dismantle_add_library name)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "src/*.cpp")
  set(target dismantle_${name})
  add_library(${target} SHARED ${sources})
  add_library(dismantle::${name} ALIAS ${target})
  target_include_directories(${target}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE src)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE dismantle_settings ${ARG_PRIVATE})
  target_compile_definitions(${target} PRIVATE DISMANTLE_VERSION="${PROJECT_VERSION}")
  set_target_properties(${target} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION 0 EXPORT_NAME ${name}
    CXX_VISIBILITY_PRESET default)
  dismantle_reuse_pch(${target} dismantle_library_pch)
  set_property(GLOBAL APPEND PROPERTY DISMANTLE_LIBRARIES ${target})
endfunction()
