/* Shared code of the fuzz targets of scene files. */
#include "fuzz/read_scene.h"

#include "fuzz/fuzz.h"

#include <skiagraph/motion.h>

#include <string.h>

static const char box[] =
    "solid b\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\n"
    "endloop\nendfacet\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
    "vertex 0 0 1\nendloop\nendfacet\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\n"
    "vertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\nfacet normal 0 0 0\nouter loop\n"
    "vertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid b\n";
static const char table[] = "# energy, value\n20 3\n60 1.5\n100 1.2\n";

int32_t fuzz_read_scene(const void *bytes, size_t size) {
    static int ready = 0;
    skg_setup *setup = NULL;
    if (!ready) {
        fuzz_write("box.stl", box, strlen(box));
        fuzz_write("table.txt", table, strlen(table));
        ready = 1;
    }
    const skg_status status = skg_setup_load(NULL, fuzz_write("scene.json", bytes, size), 0, NULL, &setup);
    fuzz_expect_sentence(status);
    if (status == SKG_OK) {
        skg_view view;
        skg_motion *motion = NULL;
        skg_plan_options options;
        skg_view_init(&view);
        skg_plan_options_init(&options);
        fuzz_expect_sentence(skg_setup_view_get(setup, &view));
        fuzz_expect_sentence(skg_setup_options_get(setup, &options));
        fuzz_expect_sentence(skg_view_check(&view));
        fuzz_expect_sentence(skg_motion_create(NULL, setup, &motion));
        skg_motion_release(&motion);
    }
    skg_setup_release(&setup);
    return status;
}
