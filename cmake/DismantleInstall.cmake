# Install rules and the exported package. In a project of your own:
#   find_package(dismantle REQUIRED)   # dismantle::session plans and verifies (docs/use-as-a-library.md);
#                                      # dismantle::plugin_api, dismantle::plugins, dismantle::testing; dismantle::core and each
#                                      # library of lib/ but bench: dismantle::geometry, ::verification, ::preparation, ...
#   dismantle_add_plugin(my_planner SOURCES my_planner.cpp)
#   dismantle_add_contract_test(my_planner)   # if the tests were built: dismantle::contract_tests is the program
# `dismantle plugins new` writes such a project.
include(CMakePackageConfigHelpers)

set(DISMANTLE_PACKAGE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/dismantle")

get_property(libraries GLOBAL PROPERTY DISMANTLE_LIBRARIES)
install(TARGETS dismantle_core ${libraries} dismantle_plugin_api dismantle_plugins dismantle_testing EXPORT dismantleTargets
  RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}"
  LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}"
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}"
  INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
install(DIRECTORY core/include/ plugins/sdk/include/ plugins/host/include/ plugins/testing/include/ DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
  FILES_MATCHING PATTERN "*.h")
foreach(library parallel geometry statics fasteners tools verification preparation plan_io samples engine session)
  install(DIRECTORY lib/${library}/include/ DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" FILES_MATCHING PATTERN "*.h")
endforeach()
install(EXPORT dismantleTargets NAMESPACE dismantle:: DESTINATION "${DISMANTLE_PACKAGE_DIR}")

configure_package_config_file(cmake/dismantleConfig.cmake.in "${CMAKE_BINARY_DIR}/package/dismantleConfig.cmake"
  INSTALL_DESTINATION "${DISMANTLE_PACKAGE_DIR}")
# Before 1.0 every minor version may break compatibility.
write_basic_package_version_file("${CMAKE_BINARY_DIR}/package/dismantleConfigVersion.cmake"
  VERSION "${PROJECT_VERSION}" COMPATIBILITY SameMinorVersion)
install(FILES
  "${CMAKE_BINARY_DIR}/package/dismantleConfig.cmake" "${CMAKE_BINARY_DIR}/package/dismantleConfigVersion.cmake"
  cmake/DismantlePlugin.cmake cmake/dismantle_plugin.map
  DESTINATION "${DISMANTLE_PACKAGE_DIR}")

install(DIRECTORY configs DESTINATION "${CMAKE_INSTALL_DATADIR}/dismantle" FILES_MATCHING PATTERN "*.yaml")
# The pages, and what their links lead to, in folders as in the source: `cmake --install build/release --component pages`.
install(FILES README.md LICENSE CHANGELOG.md CONTRIBUTING.md DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT pages)
install(DIRECTORY docs configs DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT pages)
file(GLOB_RECURSE linked RELATIVE "${PROJECT_SOURCE_DIR}" CONFIGURE_DEPENDS apps/*/README.md core/README.md lib/*/README.md
  planners/*README.md plugins/*README.md simulators/*README.md tests/results/README.md lib/tools/catalogue/*.yaml
  planners/sequence/*.h planners/sequence/*/run.cpp apps/python/examples/*.py plugins/templates/* tests/plugins_good/acme_*/*.cpp)
list(FILTER linked EXCLUDE REGEX "node_modules|^build/")
foreach(file IN LISTS linked ITEMS tools/packages.txt)
  cmake_path(GET file PARENT_PATH folder)
  install(FILES "${file}" DESTINATION "${CMAKE_INSTALL_DOCDIR}/${folder}" COMPONENT pages)
endforeach()

# The programs, the built-in plugins and the Python module, without tests: what quickstart builds and the README uses.
get_property(built_in GLOBAL PROPERTY DISMANTLE_BUILT_IN_PLUGINS)
add_custom_target(programs DEPENDS dismantle ${built_in})
if(TARGET dismantle_python)
  add_dependencies(programs dismantle_python)
endif()
# What a plan of mesh files with the default configuration needs: quickstart shows one before it builds the rest.
add_custom_target(first_plan DEPENDS dismantle)
dismantle_uses(first_plan ${DISMANTLE_DEFAULT_PLUGINS} ${DISMANTLE_PROVER_PLUGINS})
# Targets that `cmake --install` builds and installs (CMakeLists.txt): of the tests only the contract tests, for plugin authors.
set(installed programs manual ${libraries})
foreach(target dismantle_contract_tests dismantle_python)
  if(TARGET ${target})
    list(APPEND installed ${target})
  endif()
endforeach()
add_custom_target(installable DEPENDS ${installed})
