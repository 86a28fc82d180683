# Python3_EXECUTABLE: the interpreter that makes files during the build and runs the tests. Unless the caller names it, it
# is the first one of Python 3.10 or later that has NumPy, cffi and pytest: that of the environment which ./check makes in
# the build folder, the one on the path, or Debian's own. Without any of them it is the one that CMake finds.
if(NOT Python3_EXECUTABLE)
  foreach(candidate ${skiagraph_BINARY_DIR}/venv/bin/python python3 /usr/bin/python3)
    execute_process(
      COMMAND ${candidate} -c "import cffi, numpy, pytest, sys; print(sys.executable); sys.exit(sys.version_info < (3, 10))"
      RESULT_VARIABLE missing OUTPUT_VARIABLE executable OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(missing EQUAL 0)
      set(Python3_EXECUTABLE ${executable})
      break()
    endif()
  endforeach()
endif()
find_package(Python3 QUIET COMPONENTS Interpreter)
