/* Scene files: the input is the file. */
#include "fuzz/fuzz.h"
#include "fuzz/read_scene.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    fuzz_read_scene(data, size);
    return 0;
}
