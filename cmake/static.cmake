# skg_hide_symbols(RESULT "OBJECT;...") makes one object of all, in which only what is marked SKG_API is global: other functions
# of ours must not meet those of a program that links libskiagraph.a. RESULT is that object, or OBJECTS as they are where the
# tools cannot do it.
function(skg_hide_symbols result objects)
  set(options "")
  if(CMAKE_INTERPROCEDURAL_OPTIMIZATION)
    if(CMAKE_C_COMPILER_ID STREQUAL GNU)
      set(options -flto -flinker-output=nolto-rel) # the optimisation across files is done here
    else()
      set(unable "with optimisation across files this compiler gives no object that objcopy can read")
    endif()
  endif()
  if(NOT CMAKE_OBJCOPY)
    set(unable "there is no objcopy")
  endif()
  if(unable)
    message(WARNING "libskiagraph.a will have the private functions as global symbols: ${unable}")
    set(${result} "${objects}" PARENT_SCOPE)
    return()
  endif()
  set(list ${CMAKE_CURRENT_BINARY_DIR}/static-$<CONFIG>.rsp)
  set(one ${CMAKE_CURRENT_BINARY_DIR}/skiagraph${CMAKE_C_OUTPUT_EXTENSION})
  file(GENERATE OUTPUT ${list} CONTENT "\"$<JOIN:${objects},\"\n\">\"\n")
  add_custom_command(OUTPUT ${one} VERBATIM DEPENDS ${objects}
    COMMAND ${CMAKE_C_COMPILER} -r -nostdlib ${options} @${list} -o ${one}
    COMMAND ${CMAKE_OBJCOPY} --localize-hidden ${one}
    COMMENT "One object of the library, with its public symbols only")
  set_source_files_properties(${one} PROPERTIES EXTERNAL_OBJECT TRUE GENERATED TRUE)
  set(${result} ${one} PARENT_SCOPE)
endfunction()
