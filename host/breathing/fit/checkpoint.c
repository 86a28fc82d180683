/* Where a search is, as a file of text. */
#include "core/files.h"
#include "core/text.h"
#include "fit/types.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char first_line[] = "skiagraph fit checkpoint 2";

static skg_status add_mesh(const skg_mesh *mesh, skg_digester *sum) {
    int64_t vertices, triangles;
    double *positions;
    SKG_TRY(skg_mesh_count(mesh, &vertices, &triangles));
    SKG_TRY(skg_alloc(3 * vertices, sizeof *positions, "fit", &positions));
    const skg_status status = skg_mesh_positions_get(mesh, positions, 0);
    if (status == SKG_OK) skg_digest_add(sum, positions, (size_t)(3 * vertices) * sizeof *positions);
    skg_free(&positions);
    return status;
}

/* Digest of the problem of a checkpoint: scene, targets, parameters with their ranges, method and seed. */
static skg_status identify(const skg_fit *fit, char text[SKG_DIGEST_TEXT]) {
    skg_digester sum;
    skg_digest_start(&sum);
    SKG_TRY(skg_setup_hash_get(fit->setup, text, SKG_DIGEST_TEXT));
    skg_digest_add_text(&sum, text);
    for (int64_t g = 0; g < fit->goal_count; g++) {
        skg_digest_add(&sum, &fit->goals[g].part, sizeof fit->goals[g].part);
        skg_digest_add(&sum, &fit->goals[g].state.phase, sizeof fit->goals[g].state.phase);
        SKG_TRY(add_mesh(fit->goals[g].mesh, &sum));
    }
    skg_digest_add(&sum, fit->chosen, sizeof fit->chosen);
    skg_digest_add(&sum, fit->low, sizeof fit->low);
    skg_digest_add(&sum, fit->high, sizeof fit->high);
    skg_digest_add(&sum, &fit->options.method, sizeof fit->options.method);
    skg_digest_add(&sum, &fit->options.seed, sizeof fit->options.seed);
    const skg_digest digest = skg_digest_end(&sum);
    skg_digest_text(&digest, text);
    return SKG_OK;
}

skg_status skg_fit_checkpoint_save(skg_fit *fit, const char *path) {
    SKG_PLAIN;
    char identity[SKG_DIGEST_TEXT];
    skg_output_file file;
    SKG_NEEDS(fit);
    SKG_NEEDS(path);
    SKG_TRY(skg_fit_begin(fit));
    SKG_TRY(identify(fit, identity));
    SKG_TRY(skg_output_open(path, &file));
    fprintf(file.stream, "%s\n%s\n", first_line, identity);
    for (int c = 0; c < SEARCH_COUNTERS; c++) fprintf(file.stream, "%" PRId64 "\n", fit->search.counters[c]);
    for (int64_t i = 0; i < fit->search.number_count; i++) /* hexadecimal: no bit is lost */
        fprintf(file.stream, "%a\n", fit->search.numbers[i]);
    fputs("end\n", file.stream);
    return skg_output_commit(&file);
}

/* Reads all into copies, so that a file that is cut off changes nothing. */
static int read_state(const skg_fit *fit, FILE *stream, int64_t *counters, double *numbers) {
    char word[8] = "";
    for (int c = 0; c < SEARCH_COUNTERS; c++)
        if (fscanf(stream, "%" SCNd64, counters + c) != 1 || counters[c] < 0) return 0;
    for (int64_t i = 0; i < fit->search.number_count; i++)
        if (fscanf(stream, "%la", numbers + i) != 1) return 0;
    return fscanf(stream, "%7s", word) == 1 && strcmp(word, "end") == 0 && counters[SEARCH_POPULATION] >= 1 &&
           counters[SEARCH_POPULATION] <= fit->search.max_points;
}

static skg_status read_file(skg_fit *fit, FILE *stream, const char *path, double *numbers) {
    char identity[SKG_DIGEST_TEXT], line[128] = "";
    int64_t counters[SEARCH_COUNTERS];
    SKG_TRY(identify(fit, identity));
    if (!fgets(line, sizeof line, stream) || strncmp(line, first_line, strlen(first_line)) != 0)
        return skg_fail(SKG_ERR_FORMAT, "%s: is no checkpoint of a fit; name another file", path);
    if (!fgets(line, sizeof line, stream) || strncmp(line, identity, strlen(identity)) != 0)
        return skg_fail(
            SKG_ERR_FORMAT,
            "%s: is the checkpoint of another fit: scene, targets, parameters, bounds, method or seed differ. "
            "Remove it, or name another file",
            path);
    if (!read_state(fit, stream, counters, numbers))
        return skg_fail(SKG_ERR_FORMAT, "%s: is damaged; remove it", path);
    memcpy(fit->search.counters, counters, sizeof counters);
    memcpy(fit->search.numbers, numbers, (size_t)fit->search.number_count * sizeof *numbers);
    return SKG_OK;
}

skg_status skg_fit_checkpoint_load(skg_fit *fit, const char *path) {
    SKG_PLAIN;
    double *numbers;
    SKG_NEEDS(fit);
    SKG_NEEDS(path);
    SKG_TRY(skg_fit_begin(fit));
    if (fit->search.counters[SEARCH_GENERATION] > 0)
        return skg_fail(SKG_ERR_ARGUMENT, "fit: a checkpoint is loaded before the first step");
    FILE *stream = NULL;
    SKG_TRY(skg_input_open(path, SKG_INPUT_TEXT, &stream, NULL));
    skg_status status = skg_alloc(fit->search.number_count, sizeof *numbers, "fit", &numbers);
    if (status == SKG_OK) {
        status = read_file(fit, stream, path, numbers);
        skg_free(&numbers);
    }
    fclose(stream);
    return status;
}
