# dismantle_add_plugin(NAME SOURCES ... [LIBRARIES ...])
# A shared library in the plugin folder that exports nothing but its header. Installed with the package,
# so that plugins out of tree are built the same way.
function(dismantle_add_plugin name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
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
endfunction()

# dismantle_add_contract_test(NAME): a test of CTest that tries the laws of its kind on the plugin NAME, as `dismantle plugins
# check` does. Importers read the files in the folder `examples` of this project, if there is one.
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
