# cmake -DPAGE=page.html -DSOURCE=out.c -P embed_page.cmake: writes the page as the C array cost_page.
file(READ ${PAGE} hex HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
string(REGEX REPLACE "((0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,))" "\\1\n" bytes "${bytes}")
file(WRITE ${SOURCE} "extern const char cost_page[];\nconst char cost_page[] = {\n${bytes}0};\n")
