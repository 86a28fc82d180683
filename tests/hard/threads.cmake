# cmake -DPROGRAM=... -DFOLDER=... -P threads.cmake: images by any number of threads have the same bits, also by more threads
# than there are cores, whose turns the system decides. 16 threads are many enough that the plan itself chooses tiles.
set(numbers 1 2 3 16)
if(NOT "$ENV{SKG_BITS_THREADS}" STREQUAL "") # others, for a longer run
  separate_arguments(numbers UNIX_COMMAND "1 $ENV{SKG_BITS_THREADS}")
endif()
foreach(threads ${numbers})
  set(ENV{POCL_MAX_PTHREAD_COUNT} ${threads})
  set(ENV{SKG_BITS_FILE} ${FOLDER}/bits_${threads}.txt)
  execute_process(COMMAND ${PROGRAM} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${threads} threads: status ${result}")
  endif()
  file(READ ${FOLDER}/bits_${threads}.txt bits_${threads})
  if(NOT bits_1 STREQUAL bits_${threads} OR bits_1 STREQUAL "")
    message(FATAL_ERROR "One thread:\n${bits_1}\n${threads} threads:\n${bits_${threads}}")
  endif()
endforeach()
