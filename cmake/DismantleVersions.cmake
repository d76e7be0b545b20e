# The versions of the libraries in a build, for `dismantle --version`. Each folder adds those that it found.

# dismantle_built_with(NAME VERSION): an empty version is shown as unknown.
function(dismantle_built_with name version)
  if(NOT version)
    set(version "(version unknown)")
  endif()
  get_property(known GLOBAL PROPERTY DISMANTLE_BUILT_WITH)
  if(NOT "${name} ${version}" IN_LIST known)
    set_property(GLOBAL APPEND PROPERTY DISMANTLE_BUILT_WITH "${name} ${version}")
  endif()
endfunction()

# dismantle_versions(OUT): "Eigen 3.4.0,fmt 9.1.0"
function(dismantle_versions out)
  get_property(known GLOBAL PROPERTY DISMANTLE_BUILT_WITH)
  list(SORT known CASE INSENSITIVE)
  list(JOIN known "," text)
  set(${out} "${text}" PARENT_SCOPE)
endfunction()
