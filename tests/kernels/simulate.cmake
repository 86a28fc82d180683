# cmake -DOCLGRIND=... -DPROGRAM=... -DWORDS=... -DLOG=... -DLAUNCHES=... -P simulate.cmake: fails when the program
# fails or the simulator has anything to report (its own exit status is always 0). The kernels that ran are listed in
# the file LAUNCHES. Optimised code is beyond Oclgrind 21.10: it widens 1-bit vectors wrongly and lacks intrinsics.
file(REMOVE ${LOG} ${LAUNCHES})
get_filename_component(folder ${LAUNCHES} DIRECTORY)
file(MAKE_DIRECTORY ${folder})
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env SKG_LAUNCHES=${LAUNCHES}
          ${OCLGRIND} --data-races --check-api --log ${LOG}
          --build-options "-cl-opt-disable -D SKG_ELEMENTWISE=0" ${PROGRAM} ${WORDS}
  RESULT_VARIABLE result)
file(READ ${LOG} report)
if(NOT result EQUAL 0 OR NOT report STREQUAL "")
  string(SUBSTRING "${report}" 0 4000 report)
  message(FATAL_ERROR "status ${result}\n${report}")
endif()
