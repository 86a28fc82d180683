# cmake -DLIST=interface.json -DHEADERS="a.h|b.h" -DFOLDER=older -DVERSION=older|present|newer -P versions.cmake
# Writes the public headers as another version of the library may have them, to compile programs of that version:
# older, every struct without its last field; newer, every struct with a field more. Beside them structs.h has
# X(name) for every struct.
cmake_minimum_required(VERSION 3.25)
file(READ ${LIST} list)
string(JSON structs GET "${list}" structs)
string(JSON count LENGTH "${structs}")
math(EXPR last "${count} - 1")
set(names "")
set(lines "")
foreach(s RANGE ${last})
  string(JSON name GET "${structs}" ${s} name)
  list(APPEND names ${name})
  string(APPEND lines "X(${name})\n")
endforeach()
file(MAKE_DIRECTORY ${FOLDER}/skiagraph)
file(WRITE ${FOLDER}/structs.h "${lines}")

# Without their last field these say nothing.
set(whole skg_view skg_filter skg_breath_hold skg_organ_link)
string(REPLACE "|" ";" headers "${HEADERS}")
foreach(header IN LISTS headers)
  file(READ ${header} text)
  foreach(name IN LISTS names)
    if(VERSION STREQUAL newer)
      string(REPLACE "} ${name};" "    int64_t later;\n} ${name};" text "${text}")
    elseif(VERSION STREQUAL older AND NOT name IN_LIST whole)
      # From the end of the field's comment to the end of the struct.
      string(REGEX REPLACE "[^;{}/]*;[ \n]*} ${name};" "\n} ${name};" text "${text}")
    endif()
  endforeach()
  get_filename_component(file ${header} NAME)
  file(WRITE ${FOLDER}/skiagraph/${file} "${text}")
endforeach()
