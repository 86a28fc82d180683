# skg_room(FOLDER SOURCES FILE... [LINKS TARGET...] [HOOKS CONSTANT...]): one room of the library, an object library of its
# own, named like the last part of FOLDER. `breathing/body` is the room `body`, whose headers are "body/file.h".
#
# A room includes the headers of another as "room/file.h". It finds only its own and those of the rooms that were
# declared before it: its include path is a folder of links to these rooms. An include that points upward does not
# compile. Public headers (<skiagraph/...>) and the kernels' shared ones are visible to all, except that a room of lib
# does not see the public headers of host. The test `house` reads the same order from the property SKG_ROOMS.
#
# HOOKS are constants that a header of this room declares and a room above defines: a struct of functions that the lower
# room calls without knowing who defines it. The test `house` reads them from the property SKG_HOOKS.
set_property(GLOBAL PROPERTY SKG_ROOMS "")
set_property(GLOBAL PROPERTY SKG_HOOKS "")

# Makes the folder PATH with a link to each folder of the list FOLDERS, named like it.
function(skg_link_folders path folders)
  file(MAKE_DIRECTORY ${path})
  foreach(folder IN LISTS folders)
    get_filename_component(name ${folder} NAME)
    file(CREATE_LINK ${folder} ${path}/${name} SYMBOLIC)
  endforeach()
endfunction()

function(skg_room folder)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LINKS;HOOKS" ${ARGN})
  get_filename_component(name ${folder} NAME)
  get_property(rooms GLOBAL PROPERTY SKG_ROOMS)
  list(APPEND rooms ${CMAKE_CURRENT_SOURCE_DIR}/${folder})
  list(REMOVE_DUPLICATES rooms)
  set_property(GLOBAL PROPERTY SKG_ROOMS "${rooms}")
  set_property(GLOBAL APPEND PROPERTY SKG_HOOKS ${ROOM_HOOKS})
  set(sight ${skiagraph_BINARY_DIR}/rooms/${name})
  skg_link_folders(${sight} "${rooms}")
  list(TRANSFORM ROOM_SOURCES PREPEND ${folder}/ REGEX "^[^/].*")
  add_library(skg_${name} OBJECT ${ROOM_SOURCES})
  target_include_directories(skg_${name} PRIVATE
    ${sight} ${CMAKE_CURRENT_SOURCE_DIR}/include ${skiagraph_SOURCE_DIR}/kernels/shared)
  target_link_libraries(skg_${name} PRIVATE skg_interface ${ROOM_LINKS})
  # The objects, for the library and for tests of private code.
  target_sources(skg_objects INTERFACE $<TARGET_OBJECTS:skg_${name}>)
  if(ROOM_LINKS)
    target_link_libraries(skg_objects INTERFACE ${ROOM_LINKS})
  endif()
endfunction()
