# Run by cpack before it packs: the Debian packages of the libraries that the linker recorded, found by dpkg-shlibdeps. CPack can do so,
# too, but it starts two processes for each of the hundreds of files of the package to find out which are binaries.
find_program(dpkg_shlibdeps dpkg-shlibdeps REQUIRED)
set(binaries "")
file(GLOB_RECURSE files LIST_DIRECTORIES false RELATIVE "${CPACK_TEMPORARY_DIRECTORY}" "${CPACK_TEMPORARY_DIRECTORY}/usr/*")
foreach(name IN LISTS files)
  file(READ "${CPACK_TEMPORARY_DIRECTORY}/${name}" begin LIMIT 4 HEX)
  if(begin STREQUAL "7f454c46")  # ELF
    list(APPEND binaries "${name}")
  endif()
endforeach()
# It reads debian/control, and looks for the package's own libraries beside DEBIAN. Neither may be packed.
set(made "${CPACK_TEMPORARY_DIRECTORY}/debian" "${CPACK_TEMPORARY_DIRECTORY}/DEBIAN")
file(MAKE_DIRECTORY ${made})
file(WRITE "${CPACK_TEMPORARY_DIRECTORY}/debian/control" "")
execute_process(COMMAND "${dpkg_shlibdeps}" "-l${CPACK_TEMPORARY_DIRECTORY}/usr/lib" --ignore-missing-info -O ${binaries}
  WORKING_DIRECTORY "${CPACK_TEMPORARY_DIRECTORY}" OUTPUT_VARIABLE found RESULT_VARIABLE failed ERROR_VARIABLE problems)
file(REMOVE_RECURSE ${made})
if(failed OR NOT found MATCHES "shlibs:Depends=([^\n]+)")
  message(FATAL_ERROR "dpkg-shlibdeps: ${problems}${found}")
endif()
string(PREPEND CPACK_DEBIAN_PACKAGE_DEPENDS "${CMAKE_MATCH_1}, ")
