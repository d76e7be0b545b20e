# dismantle_add_plugin(NAME SOURCES ... [LIBRARIES ...] [OFFERS "KIND ID"...])
# A shared library in the plugin folder that exports only its header and the list OFFERS. OFFERS lists all registered types in
# order of registration ("path_planner acme.rrt"); with it the library is loaded only when one of them is requested. Installed
# with the package, so that out-of-tree plugins are built the same way.
function(dismantle_add_plugin name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES;OFFERS" ${ARGN})
  add_library(${name} MODULE ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE dismantle::plugin_api ${ARG_LIBRARIES})
  set_target_properties(${name} PROPERTIES
    CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    PREFIX "lib")
  set(exports "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/dismantle_plugin.map")
  target_link_options(${name} PRIVATE "LINKER:--version-script=${exports}")
  set_property(TARGET ${name} APPEND PROPERTY LINK_DEPENDS "${exports}")
  if(DEFINED DISMANTLE_PLUGIN_OUTPUT_DIRECTORY)  # in tree
    set_property(GLOBAL APPEND PROPERTY DISMANTLE_BUILT_IN_PLUGINS ${name})
    file(RELATIVE_PATH folder "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
    set_property(GLOBAL APPEND PROPERTY "DISMANTLE_PLUGINS_OF_${folder}" ${name})
    target_link_libraries(${name} PRIVATE dismantle_settings)
    set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY "${DISMANTLE_PLUGIN_OUTPUT_DIRECTORY}")
    dismantle_precompile(${name})
    install(TARGETS ${name} LIBRARY DESTINATION "${DISMANTLE_PLUGIN_INSTALL_DIR}")
  endif()
  if(ARG_OFFERS)
    dismantle_offers(${name} ${ARG_OFFERS})
  endif()
endfunction()

# dismantle_offers(NAME "KIND ID"...): adds the list of types of the plugin NAME, as a symbol that is read from the bytes of the
# file.
function(dismantle_offers name)
  list(JOIN ARGN ", " offers)
  set(source "${CMAKE_CURRENT_BINARY_DIR}/${name}_offers.cpp")
  file(CONFIGURE OUTPUT "${source}" @ONLY CONTENT
    "extern \"C\" {
extern __attribute__((visibility(\"default\"))) const char dismantle_plugin_types[];
const char dismantle_plugin_types[] = \"@offers@\";
}
")
  target_sources(${name} PRIVATE "${source}")
  set_source_files_properties("${source}" PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# dismantle_add_contract_test(NAME): a CTest test that tests the plugin NAME against the laws of its kind, like `dismantle
# plugins check`. Importers read the files in the folder `examples` of the project, if it exists.
function(dismantle_add_contract_test name)
  if(NOT TARGET dismantle::contract_tests)
    message(FATAL_ERROR "This Dismantle was installed without its contract tests: build it with -DDISMANTLE_BUILD_TESTS=ON, "
      "or leave out dismantle_add_contract_test(${name}).")
  endif()
  set(examples "")
  if(IS_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}/examples")
    set(examples --examples "${CMAKE_CURRENT_SOURCE_DIR}/examples")
  endif()
  add_test(NAME ${name}_contract COMMAND dismantle::contract_tests --gtest_brief=1 ${examples} "$<TARGET_FILE:${name}>")
endfunction()
