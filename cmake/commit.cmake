# Writes `OUT`, a header with the commit of SOURCE (empty: unknown), if it has changed. Run at every build.
cmake_minimum_required(VERSION 3.22)
set(commit "")
if(GIT AND EXISTS "${SOURCE}/.git")
  execute_process(COMMAND "${GIT}" -C "${SOURCE}" describe --always --dirty --abbrev=10 --exclude=*
    OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()
file(CONFIGURE OUTPUT "${OUT}" CONTENT "#pragma once\n#define DISMANTLE_COMMIT \"${commit}\"\n")
