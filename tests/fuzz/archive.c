/* Meshes in ZIP archives (3MF): the input is the archive. */
#include "fuzz/fuzz.h"

#include <skiagraph/mesh.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    skg_mesh *mesh = NULL;
    fuzz_expect_sentence(skg_mesh_load(NULL, fuzz_write("m.3mf", data, size), 1, &mesh));
    skg_mesh_release(&mesh);
    return 0;
}
