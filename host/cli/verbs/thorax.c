/* The verb `thorax`: writes a generated thorax with its scene. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/interrupt.h"
#include "common/progress.h"
#include "common/say.h"

#include <skiagraph/breathing.h>

#include <inttypes.h>
#include <stdio.h>

static int count_all(const skg_thorax *thorax, int64_t *parts, int64_t *triangles) {
    skg_status status = skg_thorax_part_count(thorax, parts);
    *triangles = 0;
    for (int64_t i = 0; i < *parts && status == SKG_OK; i++) {
        skg_thorax_part part;
        int64_t its_vertices, its;
        skg_thorax_part_init(&part);
        status = skg_thorax_part_get(thorax, i, &part);
        if (status == SKG_OK) status = skg_mesh_count(part.mesh, &its_vertices, &its);
        if (status == SKG_OK) *triangles += its;
    }
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

static int print(const cli_arguments *arguments, const char *folder, int64_t parts, int64_t triangles) {
    if (cli_given(arguments, "--json")) {
        json_t *object = json_object();
        json_object_set_new(object, "parts", json_integer(parts));
        json_object_set_new(object, "triangles", json_integer(triangles));
        json_object_set_new(object, "folder", cli_json_text(folder));
        return cli_json_print(object);
    }
    if (!cli_is_quiet())
        printf("%" PRId64 " parts of %" PRId64 " triangles; wrote %s/thorax.json\n", parts, triangles,
               folder);
    return CLI_DONE;
}

int cli_thorax(const cli_arguments *arguments) {
    skg_thorax_options options;
    skg_thorax *thorax = NULL;
    int64_t parts = 0, triangles = 0;
    const char *folder = cli_value(arguments, "-o");
    skg_thorax_options_init(&options);
    if (!folder) return cli_error(CLI_USAGE, "thorax: no folder is named; add -o DIR");
    options.simple = cli_given(arguments, "--simple");
    int exit_status = cli_integer(arguments, "--triangles", 10000, 20000000, &options.triangles);
    if (exit_status == CLI_DONE) exit_status = cli_make_folder(folder);
    if (exit_status != CLI_DONE) return exit_status;
    cli_progress_begin("generating and writing the thorax", 0);
    cli_keep("the files in %s are whole; the last one, thorax.json, was not written", folder);
    skg_status status = skg_thorax_create(&options, &thorax);
    if (status == SKG_OK) status = skg_thorax_save(thorax, folder);
    cli_progress_end();
    exit_status = status == SKG_OK ? count_all(thorax, &parts, &triangles) : cli_fail(status);
    if (exit_status == CLI_DONE) exit_status = print(arguments, folder, parts, triangles);
    skg_thorax_release(&thorax);
    return exit_status;
}
