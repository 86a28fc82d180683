/* Finds the outline of a part in an image, such as a dome of the diaphragm. */
#include "breathe/outputs.h"

#include "common/say.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Whether a label begins with a word of the list, or with its singular: "ribs" also stands for "rib 1". */
static int is_wanted(const char *label, const char *words, size_t length) {
    for (size_t at = 0; at < length;) {
        size_t end = at;
        while (end < length && words[end] != ',') end++;
        size_t count = end - at;
        for (int plural = 0; plural < 2 && count > (size_t)plural; plural++) {
            size_t same = 0, wanted = count - (size_t)plural;
            if (plural && tolower((unsigned char)words[end - 1]) != 's') break;
            while (same < wanted && label[same] &&
                   tolower((unsigned char)label[same]) == tolower((unsigned char)words[at + same]))
                same++;
            if (same == wanted && !isalpha((unsigned char)label[same])) return 1;
        }
        at = end + 1;
    }
    return 0;
}

/* Adds the pixels that the part covers and that have a neighbour that it does not cover. */
static void add_border(const fluoroscopy *f, const float *lengths) {
    const int64_t columns = f->session.view.columns, rows = f->session.view.rows;
    for (int64_t r = 0; r < rows; r++)
        for (int64_t c = 0; c < columns; c++) {
            const float *p = lengths + r * columns + c;
            if (!(*p > 0)) continue;
            if ((c > 0 && !(p[-1] > 0)) || (c + 1 < columns && !(p[1] > 0)) ||
                (r > 0 && !(p[-columns] > 0)) || (r + 1 < rows && !(p[columns] > 0)))
                f->outline[r * columns + c] = 1;
        }
}

int outline_find(fluoroscopy *f, const char *wanted) {
    const char *at = strrchr(wanted, '@');
    double phase = 0;
    if (at && cli_phase("--outline: @", at + 1, &phase) != CLI_DONE) return CLI_USAGE;
    const size_t length = at ? (size_t)(at - wanted) : strlen(wanted);
    int64_t parts = 0, found = 0;
    skg_output output;
    skg_output_init(&output);
    output.data = f->image[0];
    f->outline = calloc((size_t)f->pixels, 1);
    if (!f->outline) return cli_error(CLI_DEVICE, "out of host memory for the outline");
    skg_status status = skg_motion_pose_at_phase(f->motion, phase);
    if (status == SKG_OK) status = skg_scene_part_count(f->session.scene, &parts);
    for (int64_t p = 0; p < parts && status == SKG_OK; p++) {
        skg_part part;
        skg_job *job = NULL;
        skg_part_init(&part);
        status = skg_scene_part_get(f->session.scene, p, &part);
        if (status != SKG_OK || !is_wanted(part.label, wanted, length)) continue;
        output.kind = SKG_OUTPUT_LENGTHS;
        output.part = p;
        output.lengths = SKG_LENGTHS_SURFACE;
        status = skg_plan_submit(f->plan, 1, NULL, 1, &output, &job);
        if (status == SKG_OK) status = skg_job_wait(&job);
        if (!SKG_FAILED(status)) add_border(f, f->image[0]);
        if (status > SKG_OK) status = SKG_OK;
        found++;
    }
    if (status != SKG_OK) return cli_fail(status);
    return found
               ? CLI_DONE
               : cli_error(CLI_USAGE, "--outline %s: no part's label begins with one of these words", wanted);
}
