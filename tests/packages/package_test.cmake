# Steps of package_test; see CMakeLists.txt for the variables. Stops at the first thing that is not as it should be.
cmake_minimum_required(VERSION 3.25)

include("${CMAKE_CURRENT_LIST_DIR}/../install/run.cmake")

file(REMOVE_RECURSE "${WORK_DIR}")
run(ignored ${CPACK} --config "${BUILD_DIR}/CPackConfig.cmake" -B "${WORK_DIR}/made")
file(GLOB packages "${WORK_DIR}/made/*.deb")
list(LENGTH packages count)
if(NOT count EQUAL 1)
  message(FATAL_ERROR "expected one package, there are: ${packages}")
endif()

run(fields ${DPKG_DEB} --field "${packages}")
expect("${fields}" "Package: dismantle\n" "Version: ${VERSION}")
# Every library that is chosen by Debian's packages of today, each from a part of the program of its own.
string(REGEX MATCH "Depends: [^\n]*" depends "${fields}")
expect("${depends}" "libc6 " "libstdc\\+\\+6 " "libompl16 " "libfcl0.7 " "libocct-data-exchange-7.6 " "libassimp5 " "libyaml-cpp0.7 "
  "libsqlite3-0 " "libfmt9 " "libpango-1.0-0 |libpangocairo-1.0-0 " "python3 " "python3-numpy")
if(depends MATCHES "libdismantle|-dev")
  message(FATAL_ERROR "the package depends on itself or on headers: ${depends}")
endif()

run(list ${DPKG_DEB} --contents "${packages}")
expect("${list}" "\\./usr/bin/dismantle\n" "\\./usr/bin/dismantle_contract_tests\n" "/dismantle/plugins/libstep\\.so\n" "/dismantle/step_reader\n"
  "/dismantle/plugins/libbest_order\\.so\n" "/usr/include/dismantle/step_check\\.h\n" "/cmake/dismantle/dismantleConfig\\.cmake\n"
  "/usr/lib/python3/dist-packages/dismantle/__init__\\.py\n" "/usr/lib/python3/dist-packages/dismantle/_core[^\n]*\\.so\n"
  "/usr/share/dismantle/configs/default\\.yaml\n" "/usr/share/man/man1/dismantle\\.1[^\n]*\n"
  "/usr/share/bash-completion/completions/dismantle\n")
if(list MATCHES "/home/|/build/|\\./usr/local")
  message(FATAL_ERROR "files that do not belong into a package:\n${list}")
endif()

# What was packed works where it is unpacked, without the build tree.
file(MAKE_DIRECTORY "${WORK_DIR}/root")
run(ignored ${DPKG_DEB} --extract "${packages}" "${WORK_DIR}/root")
unset(ENV{DISMANTLE_PLUGIN_PATH})
set(dismantle "${WORK_DIR}/root/usr/bin/dismantle")
run(ignored "${dismantle}" sample peg_in_hole -o "${WORK_DIR}/peg")
run(ignored "${dismantle}" plan "${WORK_DIR}/peg" -o "${WORK_DIR}/plan")
run(ignored "${dismantle}" verify "${WORK_DIR}/plan/plan.json" --assembly "${WORK_DIR}/peg")
