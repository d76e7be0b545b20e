# `cpack` in a build folder makes the Debian package: program, plugins, development files and Python module in one. Its dependencies are
# those that the linker recorded, found by dpkg-shlibdeps.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME dismantle)
set(CPACK_PACKAGE_CONTACT "Dismantle maintainers <maintainers@dismantle.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION "Finds in which order the parts of a rigid assembly come out, with a collision-free path for each,
 and proves both by an independent check; the reverse is the assembly instructions.")
set(CPACK_PACKAGE_DIRECTORY "${CMAKE_BINARY_DIR}/packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE gzip)  # packs in seconds
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3 (>= 3.11), python3-numpy")  # and those that package_depends.cmake finds
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "cmake (>= 3.25), g++, libeigen3-dev, graphviz")
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/package_python.cmake" "${PROJECT_SOURCE_DIR}/cmake/package_depends.cmake")
include(CPack)
