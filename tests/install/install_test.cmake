# Steps of install_test; see CMakeLists.txt for the variables. Stops at the first thing that is not as it should be.
cmake_minimum_required(VERSION 3.25)

function(run output)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nfailed with status ${status}\n${out}\n${err}")
  endif()
  set(${output} "${out}" PARENT_SCOPE)
endfunction()

function(expect text pattern)
  if(NOT text MATCHES "${pattern}")
    message(FATAL_ERROR "expected /${pattern}/ in\n${text}")
  endif()
endfunction()

unset(ENV{DISMANTLE_PLUGIN_PATH})
file(REMOVE_RECURSE "${WORK_DIR}")
run(ignored ${CMAKE_COMMAND} --install "${BUILD_DIR}" --prefix "${WORK_DIR}/first")
# The install must not depend on where it was made: move it before it is used.
file(RENAME "${WORK_DIR}/first" "${WORK_DIR}/prefix")

# The project of this folder, and the examples of docs/write-a-*.md.
foreach(project consumer ../plugins_good/acme_straight ../plugins_good/acme_stepper)
  get_filename_component(name "${project}" NAME)
  run(ignored ${CMAKE_COMMAND} -S "${SOURCE_DIR}/${project}" -B "${WORK_DIR}/${name}" -G "${GENERATOR}"
    "-DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix" "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}" "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}"
    "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}")
  run(ignored ${CMAKE_COMMAND} --build "${WORK_DIR}/${name}")
endforeach()
run(out "${WORK_DIR}/consumer/consumer")
expect("${out}" "peg_in_hole")

set(dismantle "${WORK_DIR}/prefix/bin/dismantle")
run(out "${dismantle}" plugins list)
expect("${out}" "sdf_penalty")
expect("${out}" "progressive")
set(ENV{DISMANTLE_PLUGIN_PATH} "${WORK_DIR}/consumer:${WORK_DIR}/acme_straight:${WORK_DIR}/acme_stepper")
run(out "${dismantle}" plugins list)
expect("${out}" "consumer.never")
expect("${out}" "acme.straight")
expect("${out}" "acme.stepper")
run(out "${dismantle}" plugins describe consumer.never)
expect("${out}" "patience")
# The laws of path planners, on a plugin out of tree that obeys them and on one that does not: it knows no cancellation.
execute_process(COMMAND "${dismantle}" plugins check consumer.never RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
if(NOT status EQUAL 1)
  message(FATAL_ERROR "plugins check of a planner that ignores cancellation ended with status ${status}")
endif()
run(out "${dismantle}" plugins check "${WORK_DIR}/acme_straight/libacme_straight.so")
expect("${out}" "Skipped, by declared capabilities")
run(ignored "${dismantle}" sample l_slot -o "${WORK_DIR}/l_slot")
if(NOT EXISTS "${WORK_DIR}/l_slot/slider.obj")
  message(FATAL_ERROR "the installed program wrote no sample")
endif()
# The foreign planner runs: it gives up on every part, which is status 1 and a partial plan.
execute_process(COMMAND "${dismantle}" plan "${WORK_DIR}/l_slot" -o "${WORK_DIR}/plan" --path-planner consumer.never
  RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err)
if(NOT status EQUAL 1 OR NOT EXISTS "${WORK_DIR}/plan/plan.json")
  message(FATAL_ERROR "a plan with the foreign planner ended with status ${status}\n${out}\n${err}")
endif()
if(EXISTS "${BUILD_DIR}/share/dismantle/viewer.html" AND NOT EXISTS "${WORK_DIR}/plan/index.html")
  message(FATAL_ERROR "the installed program did not find its viewer\n${out}\n${err}")
endif()
file(READ "${WORK_DIR}/plan/plan.json" plan)
expect("${plan}" "partial")
file(REMOVE_RECURSE "${WORK_DIR}")
