# cmake -DOCLGRIND=... -DPROGRAM=... -DLOG=... -P simulate.cmake: fails when the program fails or the simulator has
# anything to say (its own exit status is always 0). Optimised code is beyond Oclgrind 21.10: it widens 1-bit vectors
# wrongly and lacks intrinsics.
execute_process(
  COMMAND ${OCLGRIND} --data-races --check-api --log ${LOG}
          --build-options "-cl-opt-disable -D SKG_ELEMENTWISE=0" ${PROGRAM}
  RESULT_VARIABLE result)
file(READ ${LOG} said)
if(NOT result EQUAL 0 OR NOT said STREQUAL "")
  message(FATAL_ERROR "status ${result}\n${said}")
endif()
