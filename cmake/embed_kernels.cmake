# cmake -DFILES="a.cl;b.cl" -DTABLE=out.c -P embed_kernels.cmake: writes each file as a C array, and a table of them with
# the digests of each and of all, which take time to work out at the start of each process.
set(arrays "")
set(rows "")
set(count 0)
set(digests "")
foreach(path IN LISTS FILES)
  get_filename_component(name ${path} NAME)
  file(READ ${path} hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
  string(REGEX REPLACE "(0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,)" "\\1\n" bytes "${bytes}")
  string(APPEND arrays "static const char file_${count}[] = {\n${bytes}0};\n")
  file(SHA256 ${path} digest)
  string(APPEND rows "    {\"${name}\", file_${count}, \"${digest}\"},\n")
  string(APPEND digests "${name} ${digest}\n")
  math(EXPR count "${count} + 1")
endforeach()
if(count EQUAL 0)
  set(rows "    {0, 0, 0},\n")
endif()
string(SHA256 digest "${digests}")
file(WRITE ${TABLE}
  "#include \"device/programs.h\"\n${arrays}const skg_kernel_source skg_kernel_sources[] = {\n${rows}};\n"
  "const int skg_kernel_source_count = ${count};\nconst char skg_kernel_sources_digest[] = \"${digest}\";\n")
