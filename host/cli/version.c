/* Implements `skiagraph version`: the version, and how the command was built. */
#include "version.h"

#include "common/args.h"
#include "common/encode.h"
#include "common/say.h"

#include <skiagraph/skiagraph.h>

#include <jansson.h>
#include <stdio.h>

/* Libraries by their versions when the command was built; without one: what is missing then. */
static const struct {
    const char *name, *version, *missing;
} libraries[] = {
    {"Assimp", SKG_WITH_ASSIMP, ""},
    {"Cairo", SKG_WITH_CAIRO, ""},
    {"CivetWeb", SKG_WITH_CIVETWEB, "the verb live"},
    {"giflib", SKG_WITH_GIF, "films as .gif"},
    {"HDF5", SKG_WITH_HDF5, "scans as .h5, reconstruct"},
    {"libtiff", SKG_WITH_TIFF, ""},
    {"meshoptimizer", SKG_WITH_MESHOPTIMIZER, "meshes of pages with fewer triangles"},
    {"MPI", SKG_WITH_MPI, "scans by several processes"},
};
enum { LIBRARIES = sizeof libraries / sizeof *libraries };

static int print_json(void) {
    json_t *with = json_object();
    for (int i = 0; i < LIBRARIES; i++)
        json_object_set_new(with, libraries[i].name,
                            *libraries[i].version ? json_string(libraries[i].version) : json_null());
    return cli_json_print(json_pack("{s:s, s:s, s:s, s:o}", "version", skg_version(), "compiler",
                                    SKG_BUILT_BY, "system", SKG_BUILT_FOR, "libraries", with));
}

int cli_version(int json) {
    const char *before = "with";
    if (json) return print_json();
    printf("skiagraph %s\nbuilt by %s for %s, ", skg_version(), SKG_BUILT_BY, SKG_BUILT_FOR);
    for (int i = 0; i < LIBRARIES; i++)
        if (*libraries[i].version) {
            printf("%s %s %s", before, libraries[i].name, libraries[i].version);
            before = ",";
        }
    printf("\n");
    for (int i = 0; i < LIBRARIES; i++)
        if (!*libraries[i].version) printf("without %s: no %s\n", libraries[i].name, libraries[i].missing);
    return CLI_DONE;
}
