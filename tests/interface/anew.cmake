# cmake -DPYTHON=python3 -DMAKER=interface.py -DSOURCE=. -DBUILD=build -DLIST=interface.json -DCC=cc -P anew.cmake
# Where Doxygen is found: the list made anew is the one that is checked in, to the byte.
cmake_minimum_required(VERSION 3.25)
set(made ${BUILD}/interface-anew.json)
execute_process(COMMAND ${CMAKE_COMMAND} -E env CC=${CC} ${PYTHON} ${MAKER} ${SOURCE} ${BUILD} ${made}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${made} ${LIST} RESULT_VARIABLE differs)
if(differs)
  execute_process(COMMAND diff ${LIST} ${made})
  message(FATAL_ERROR "The list of the interface is stale; make it anew: cmake --build BUILD --target interface_list")
endif()
