/* motion.csv: a line of the motion for each frame. */
#include "breathe/outputs.h"

#include "common/encode.h"
#include "common/interrupt.h"
#include "common/say.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int table_open(const char *path, motion_table *table) {
    const int exit_status = cli_file_open(path, &table->file);
    if (exit_status != CLI_DONE) return exit_status;
    fputs("t_s,phase,amplitude,thoracic,diaphragmatic,lung_ml,tidal_ml,lung_hu,diaphragm_left_mm,"
          "diaphragm_right_mm,liver_x_mm,liver_y_mm,liver_z_mm,liver_volume_ratio,flipped_triangles,"
          "conflict_mm,broken_links,needle_mm,conflict\n",
          table->file.stream);
    return CLI_DONE;
}

/* "liver: tendon, rib 8 left"; empty if there is no conflict. */
static void write_conflict(const skg_body_measure *m, FILE *stream) {
    static const char *const before[3] = {"", ": ", ", "};
    char *text = NULL;
    size_t size = 0;
    FILE *words = open_memstream(&text, &size);
    for (int i = 0; words && i < 3 && m->conflict[i]; i++) fprintf(words, "%s%s", before[i], m->conflict[i]);
    if (words) fclose(words);
    if (text && size > 0) cli_csv_text(text, stream);
    free(text);
    fputc('\n', stream);
}

int table_add(const fluoroscopy *f, double time_s, motion_table *table) {
    skg_motion_state s;
    skg_body_measure m;
    skg_body *body = NULL;
    skg_motion_state_init(&s);
    skg_body_measure_init(&m);
    skg_status status = skg_motion_state_get(f->motion, &s);
    if (status == SKG_OK) status = skg_motion_body_get(f->motion, &body);
    if (status == SKG_OK) status = skg_body_measure_get(body, &m);
    if (status != SKG_OK) return cli_fail(status);
    fprintf(table->file.stream,
            "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%" PRId64 ",%.9g,%" PRId64
            ",%.9g,",
            time_s, s.phase, s.amplitude, s.thoracic, s.diaphragmatic, m.lung_ml, m.tidal_ml, s.lung_hu,
            m.diaphragm_mm[0], m.diaphragm_mm[1], m.liver_mm[0], m.liver_mm[1], m.liver_mm[2],
            m.liver_volume_ratio, m.flipped_triangles, m.conflict_mm, m.broken_links, s.needle_mm);
    write_conflict(&m, table->file.stream);
    if (fflush(table->file.stream) == 0) return CLI_DONE;
    return cli_file_fail(table->file.path, strerror(errno));
}

void table_keep(const motion_table *table) {
    cli_keep_file(table->file.temporary, table->file.path);
}

int table_close(motion_table *table, int is_whole) {
    int exit_status = CLI_DONE;
    if (is_whole)
        exit_status = cli_file_commit(&table->file);
    else
        cli_file_discard(&table->file);
    cli_keep_file(NULL, NULL);
    return exit_status;
}
