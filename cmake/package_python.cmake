# Run by cpack before it packs: Debian's interpreter looks for packages of all versions in lib/python3/dist-packages. The folder has
# the same depth as the one in which the module was installed, so the module still finds its libraries beside it.
file(GLOB inits "${CPACK_TEMPORARY_DIRECTORY}/usr/lib/python3*/*-packages/dismantle/__init__.py")
foreach(init IN LISTS inits)
  get_filename_component(package "${init}" DIRECTORY)
  set(wanted "${CPACK_TEMPORARY_DIRECTORY}/usr/lib/python3/dist-packages")
  file(MAKE_DIRECTORY "${wanted}")
  file(RENAME "${package}" "${wanted}/dismantle")
  get_filename_component(folder "${package}" DIRECTORY)
  get_filename_component(version "${folder}" DIRECTORY)
  file(REMOVE_RECURSE "${version}")
endforeach()
