/* A scene small enough for a simulator (Oclgrind: races, bounds): every strategy, with and without the source's
 * plane, must give one hash. Parts add to planes by lists. Exit status 0: it did.
 * raster_simulated single|long|double: float terms with sums of 32 or 64 bits; double terms. */
#include "kernels/picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int32_t bits = 32, precision = SKG_PRECISION_SINGLE;

static uint64_t hash_of(skg_context *context, int32_t strategy, int32_t shape_of_tile, int32_t source) {
    shape sphere = shape_sphere(40, 12, 6), box = shape_box(30, 20, 10);
    body bodies[2] = {body_make(&sphere, 0), body_make(&box, 1)};
    bodies[1].pose[3] = 33.3;
    skg_view view = view_make(40, 24, 4);
    if (source) view.source[0] = 3, view.source[2] = 5;
    const skg_raster_options options = {
        .kernels = {.bits = bits, .precision = precision, .source_plane = source, .seams = 1, .listed = 1},
        .strategy = strategy,
        .shape = shape_of_tile,
        .tile = shape_of_tile ? 16 : 0,
        .planes = 2};
    picture result = {0};
    if (picture_take(context, &options, &view, 2, bodies, 0x1p28, &result) != SKG_OK) {
        fprintf(stderr, "%s\n", skg_last_error());
        exit(EXIT_FAILURE);
    }
    const uint64_t hash = result.hash;
    picture_free(&result);
    shape_free(&sphere);
    shape_free(&box);
    return hash;
}

int main(int count, char **words) {
    skg_context *context = NULL;
    if (count != 2) return EXIT_FAILURE;
    if (strcmp(words[1], "single") != 0) bits = 64;
    if (strcmp(words[1], "double") == 0) precision = SKG_PRECISION_DOUBLE;
    int failed = 0;
    if (skg_context_create(NULL, &context) != SKG_OK) {
        fprintf(stderr, "%s\n", skg_last_error());
        return EXIT_FAILURE;
    }
    for (int32_t source = 0; source < 2; source++) {
        const uint64_t first = hash_of(context, SKG_STRATEGY_COPIES, 0, source);
        failed |= hash_of(context, SKG_STRATEGY_ATOMICS, 0, source) != first;
        failed |= hash_of(context, SKG_STRATEGY_TILES, SKG_TILE_BANDS, source) != first;
        failed |= hash_of(context, SKG_STRATEGY_TILES, SKG_TILE_SQUARES, source) != first;
    }
    skg_context_release(&context);
    if (failed) fprintf(stderr, "strategies differ\n");
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
