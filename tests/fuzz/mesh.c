/* Mesh files through our own readers: the first byte chooses the format, the rest is the file. What loads is
 * saved, and has to load again. */
#include "fuzz/fuzz.h"

#include <skiagraph/mesh.h>

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char *const names[3] = {"m.stl", "m.ply", "m.obj"};
    skg_mesh *mesh = NULL, *again = NULL;
    skg_mesh_health health;
    if (size < 1) return 0;
    const char *name = data[0] & 128 ? "m.off" : names[data[0] % 3];
    const skg_status status = skg_mesh_load(NULL, fuzz_write(name, data + 1, size - 1), 1, &mesh);
    fuzz_expect_sentence(status);
    if (status != SKG_OK) return 0;
    skg_mesh_health_init(&health);
    if (skg_mesh_health_get(mesh, &health) != SKG_OK) abort();
    if (data[0] & 64) {
        if (skg_mesh_save(mesh, fuzz_path("saved.ply")) != SKG_OK) abort();
        if (skg_mesh_load(NULL, fuzz_path("saved.ply"), 1, &again) != SKG_OK) abort();
    }
    skg_mesh_release(&again);
    skg_mesh_release(&mesh);
    return 0;
}
