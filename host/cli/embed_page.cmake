# cmake -DPAGE=page.html -DSOURCE=out.c -DNAME=name -P embed_page.cmake: writes the page as the C array `name`. A line
# <script src="FILE"></script> becomes the script of that file, beside the page.
get_filename_component(folder ${PAGE} DIRECTORY)
file(READ ${PAGE} hex HEX)
file(STRINGS ${PAGE} lines REGEX "<script src=")
foreach(line IN LISTS lines)
  string(REGEX REPLACE ".*src=\"([^\"]*)\".*" "\\1" name "${line}")
  file(READ ${folder}/${name} script HEX)
  # in hexadecimal, so that no character of a script means anything here; 0a ends a line
  string(HEX "<script src=\"${name}\"></script>" tag)
  string(HEX "<script>\n" begin)
  string(HEX "</script>" end)
  string(REPLACE "${tag}" "${begin}${script}${end}" hex "${hex}")
endforeach()
string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
string(REGEX REPLACE "((0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,))" "\\1\n" bytes "${bytes}")
file(WRITE ${SOURCE} "extern const char ${NAME}[];\nconst char ${NAME}[] = {\n${bytes}0};\n")
