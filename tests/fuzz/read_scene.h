/* Shared code of the fuzz targets of scene files. */
#ifndef SKG_TESTS_READ_SCENE_H
#define SKG_TESTS_READ_SCENE_H

#include <skiagraph/types.h>

#include <stddef.h>

/* Reads a scene file and what is made of it; box.stl and table.txt lie beside it. Returns whether it could be read. */
int32_t fuzz_read_scene(const void *bytes, size_t size);

#endif
