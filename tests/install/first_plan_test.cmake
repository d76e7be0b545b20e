# Steps of first_plan_test; see CMakeLists.txt for the variables.
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/run.cmake")

file(REMOVE_RECURSE "${WORK_DIR}")
file(MAKE_DIRECTORY "${WORK_DIR}/bin" "${WORK_DIR}/lib/dismantle/plugins")
file(COPY "${PROGRAM}" DESTINATION "${WORK_DIR}/bin")  # a copy, because the program looks for plugins beside itself
file(GLOB libraries "${LIBRARIES}/*.so*" "${LIBRARIES}/dismantle/*_reader")
# Hard links: the program looks for plugins beside its library, and symbolic links would lead it to the build tree.
foreach(library IN LISTS libraries)
  file(RELATIVE_PATH name "${LIBRARIES}" "${library}")
  file(CREATE_LINK "${library}" "${WORK_DIR}/lib/${name}" COPY_ON_ERROR)
endforeach()
foreach(plugin IN LISTS PLUGINS)
  get_filename_component(name "${plugin}" NAME)
  file(CREATE_LINK "${plugin}" "${WORK_DIR}/lib/dismantle/plugins/${name}" COPY_ON_ERROR)
endforeach()

# Presets of an installed program.
file(MAKE_DIRECTORY "${WORK_DIR}/share/dismantle")
file(CREATE_LINK "${CONFIGS}" "${WORK_DIR}/share/dismantle/configs" SYMBOLIC)

unset(ENV{DISMANTLE_PLUGIN_PATH})
set(ENV{LD_LIBRARY_PATH} "${WORK_DIR}/lib")
get_filename_component(name "${PROGRAM}" NAME)
set(dismantle "${WORK_DIR}/bin/${name}")
run(ignored "${dismantle}" sample stacked_box -o "${WORK_DIR}/sample")
run(said "${dismantle}" plan "${WORK_DIR}/sample" -o "${WORK_DIR}/plan")
expect("${said}" "objective: ")  # the default configuration leaves out what is not there
run(ignored "${dismantle}" verify "${WORK_DIR}/plan/plan.json" --assembly "${WORK_DIR}/sample")
run(listed "${dismantle}" plugins list)
if(listed MATCHES "mcts")
  message(FATAL_ERROR "plugins beyond those of PLUGINS were found:\n${listed}")
endif()
