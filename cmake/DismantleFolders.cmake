# One folder is one plugin. The project builds and passes its tests without any of them; missing plugins are listed by name.
#
# The folders of the plugins of this project, for tests. `dismantle_folders` also finds other plugin folders.
set(DISMANTLE_SHIPPED_PLUGINS
  plugins/importers/ldraw plugins/importers/mesh_files plugins/importers/step
  simulators/fcl simulators/sdf_penalty simulators/sdf_velocity
  planners/path/bfs planners/path/bk_rrt planners/path/contact_search planners/path/mv_t_rrt
  planners/path/portfolio planners/path/prm planners/path/rrt planners/path/rrt_connect_removal
  planners/path/t_rrt planners/path/tolerant_rrt planners/path/tunnel_forest
  planners/sequence/best_order planners/sequence/blocking planners/sequence/chain planners/sequence/least_cut planners/sequence/mcts planners/sequence/ndbg planners/sequence/progressive planners/sequence/queue planners/sequence/random
  planners/sequence/state_based
  planners/transfer/rrt_connect
  planners/checks/base planners/checks/covers planners/checks/directions planners/checks/gravity planners/checks/identical_parts planners/checks/path_length
  planners/checks/reorientations planners/checks/steps planners/checks/time planners/checks/tool_access planners/checks/travel
  planners/immobility/configuration_cells planners/immobility/disc planners/immobility/enclosed_ball planners/immobility/hook
  planners/immobility/interlock_lp planners/immobility/overlap_lock planners/immobility/ring planners/immobility/spool planners/immobility/translations)
set(DISMANTLE_WITHOUT "" CACHE STRING "Plugin folders to leave out as if they were deleted, separated by semicolons")

set(DISMANTLE_MISSING_PLUGINS "")
foreach(folder IN LISTS DISMANTLE_SHIPPED_PLUGINS)
  if(folder IN_LIST DISMANTLE_WITHOUT OR NOT EXISTS "${PROJECT_SOURCE_DIR}/${folder}/CMakeLists.txt")
    list(APPEND DISMANTLE_MISSING_PLUGINS "${folder}")
  endif()
endforeach()
if(DISMANTLE_MISSING_PLUGINS)
  message(STATUS "Plugins left out: ${DISMANTLE_MISSING_PLUGINS}")
endif()

# The plugins of the default configuration, and those that read the samples: what configs/default.yaml names as `type`, and what
# its path planner `guided` is made of. (Plugins that are not there are left out of the defaults, so a list that lacks one would
# change plans without an error.)
set(DISMANTLE_DEFAULT_PLUGINS plugins/importers/mesh_files
  planners/path/portfolio planners/path/contact_search planners/path/tolerant_rrt planners/path/tunnel_forest)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/configs/default.yaml")
file(STRINGS "${PROJECT_SOURCE_DIR}/configs/default.yaml" lines REGEX "^[^#]*type:")
foreach(line IN LISTS lines)
  string(REGEX REPLACE "#.*" "" line "${line}")
  string(REGEX MATCHALL "type: *[a-z_]+" types "${line}")
  foreach(type IN LISTS types)
    string(REGEX REPLACE "type: *" "" id "${type}")
    foreach(folder IN LISTS DISMANTLE_SHIPPED_PLUGINS)
      if(folder MATCHES "/${id}$" AND NOT folder IN_LIST DISMANTLE_DEFAULT_PLUGINS)
        list(APPEND DISMANTLE_DEFAULT_PLUGINS "${folder}")
      endif()
    endforeach()
  endforeach()
endforeach()

# The immobility provers.
set(DISMANTLE_PROVER_PLUGINS ${DISMANTLE_SHIPPED_PLUGINS})
list(FILTER DISMANTLE_PROVER_PLUGINS INCLUDE REGEX "^planners/immobility/")

# dismantle_folders(DEPTH): adds each folder with a CMakeLists.txt that is DEPTH levels below the current one.
function(dismantle_folders depth)
  string(REPEAT "*/" ${depth} pattern)
  file(GLOB lists RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}" CONFIGURE_DEPENDS "${pattern}CMakeLists.txt")
  file(RELATIVE_PATH here "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
  foreach(list IN LISTS lists)
    get_filename_component(folder "${list}" DIRECTORY)
    if(NOT "${here}/${folder}" IN_LIST DISMANTLE_WITHOUT)
      add_subdirectory("${folder}")
    endif()
  endforeach()
endfunction()

# dismantle_missing(OUT FOLDER...): returns the given plugin folders that are not part of this build.
function(dismantle_missing out)
  set(missing "")
  foreach(folder IN LISTS ARGN)
    if(folder IN_LIST DISMANTLE_MISSING_PLUGINS)
      list(APPEND missing "${folder}")
    endif()
  endforeach()
  set(${out} "${missing}" PARENT_SCOPE)
endfunction()

# dismantle_left_out(OUT NAME FOLDER...): the missing plugins among those that test NAME needs; prints them.
function(dismantle_left_out out name)
  dismantle_missing(missing ${ARGN})
  if(missing)
    message(STATUS "Test left out: ${name} needs ${missing}")
  endif()
  set(${out} "${missing}" PARENT_SCOPE)
endfunction()

# dismantle_uses(TARGET FOLDER...): the target loads these plugins at run time, so they are built before it; missing ones are
# ignored. `all` stands for every plugin of the build.
function(dismantle_uses target)
  foreach(folder IN LISTS ARGN)
    set_property(GLOBAL APPEND PROPERTY DISMANTLE_USES "${target}|${folder}")
  endforeach()
endfunction()

# Deferred, because the target of a plugin is known only after its folder was read.
function(dismantle_resolve_uses)
  get_property(uses GLOBAL PROPERTY DISMANTLE_USES)
  get_property(built_in GLOBAL PROPERTY DISMANTLE_BUILT_IN_PLUGINS)
  foreach(use IN LISTS uses)
    string(REPLACE "|" ";" use "${use}")
    list(GET use 0 target)
    list(GET use 1 folder)
    if(folder STREQUAL "all")
      set(plugins "${built_in}")
    else()
      get_property(plugins GLOBAL PROPERTY "DISMANTLE_PLUGINS_OF_${folder}")
    endif()
    if(plugins)
      add_dependencies(${target} ${plugins})
    elseif(NOT folder STREQUAL "all" AND NOT folder IN_LIST DISMANTLE_MISSING_PLUGINS)
      message(FATAL_ERROR "${target} uses the plugin of ${folder}, which has none")
    endif()
  endforeach()
endfunction()
cmake_language(DEFER DIRECTORY "${PROJECT_SOURCE_DIR}" CALL dismantle_resolve_uses)
