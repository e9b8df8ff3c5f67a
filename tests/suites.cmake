# SPDX-License-Identifier: MIT
# Writes CTest's tests of a test program, one for each suite. Runs after the program was linked:
#   cmake -DPROGRAM=... -DMODULE=... -DRUNNER=suite.sh -DOUT=... -P suites.cmake
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE list COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "\n[A-Za-z][A-Za-z0-9_/]*\\.[ \n]" suites "${list}")
set(tests "")
foreach(suite ${suites})
  string(REGEX REPLACE "[\n .]" "" suite "${suite}")
  set(cost 0)
  if("${MODULE}.${suite}" MATCHES "^(lattice.Fit|lattice.Splitting|dynamics.RandomScenes)$")
    set(cost 300)  # long tests first
  endif()
  string(APPEND tests "add_test([=[${MODULE}.${suite}]=] [=[${RUNNER}]=] [=[${PROGRAM}]=] [=[${suite}]=])\n"
    "set_tests_properties([=[${MODULE}.${suite}]=] PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 3600 COST ${cost})\n")
endforeach()
if(tests STREQUAL "")
  message(FATAL_ERROR "${PROGRAM} lists no suites")
endif()
file(WRITE ${OUT} "${tests}")
