/* CTSimU scenarios: the input is the file. */
#include "fuzz/fuzz.h"
#include "fuzz/read_scene.h"

#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char cube[] = "v 0 0 0\nv 0 9 0\nv 9 0 0\nv 0 0 9\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n";
    static int ready = 0;
    if (!ready) fuzz_write("cube.obj", cube, strlen(cube));
    ready = 1;
    fuzz_read_scene(data, size);
    return 0;
}
