#include "breathe.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int cli_table_open(const char *path, cli_table *table) {
    *table = (cli_table){0};
    size_t room = strlen(path) + 32;
    table->path = malloc(room);
    table->temporary = malloc(room);
    if (!table->path || !table->temporary) return cli_error(CLI_DEVICE, "out of host memory");
    snprintf(table->path, room, "%s", path);
    snprintf(table->temporary, room, "%s.part-%ld", path, (long)getpid());
    table->stream = fopen(table->temporary, "w");
    if (!table->stream) return cli_error(CLI_OUTPUT, "%s: cannot be written: %s", path, strerror(errno));
    fputs("t_s,phase,amplitude,thoracic,diaphragmatic,lung_ml,tidal_ml,lung_hu,diaphragm_left_mm,"
          "diaphragm_right_mm,liver_x_mm,liver_y_mm,liver_z_mm,liver_volume_ratio,flipped_triangles,"
          "conflict_mm,broken_links,needle_mm,conflict\n",
          table->stream);
    return CLI_DONE;
}

/* "liver: tendon, rib 8 left" in quotes, those of labels doubled; empty where there is none. */
static void write_conflict(const skg_body_measure *m, FILE *stream) {
    static const char *const before[3] = {"", ": ", ", "};
    if (m->conflict[0]) fputc('"', stream);
    for (int i = 0; i < 3 && m->conflict[i]; i++) {
        fputs(before[i], stream);
        for (const char *c = m->conflict[i]; *c; c++) {
            if (*c == '"') fputc('"', stream);
            fputc(*c, stream);
        }
    }
    fputs(m->conflict[0] ? "\"\n" : "\n", stream);
}

int cli_table_add(const cli_fluoroscopy *f, double time_s, cli_table *table) {
    skg_motion_state s;
    skg_body_measure m;
    skg_body *body = NULL;
    skg_motion_state_init(&s);
    skg_body_measure_init(&m);
    skg_status status = skg_motion_state_get(f->motion, &s);
    if (status == SKG_OK) status = skg_motion_body_get(f->motion, &body);
    if (status == SKG_OK) status = skg_body_measure_get(body, &m);
    if (status != SKG_OK) return cli_fail(status);
    fprintf(table->stream,
            "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%" PRId64 ",%.9g,%" PRId64
            ",%.9g,",
            time_s, s.phase, s.amplitude, s.thoracic, s.diaphragmatic, m.lung_ml, m.tidal_ml, s.lung_hu,
            m.diaphragm_mm[0], m.diaphragm_mm[1], m.liver_mm[0], m.liver_mm[1], m.liver_mm[2],
            m.liver_volume_ratio, m.flipped_triangles, m.conflict_mm, m.broken_links, s.needle_mm);
    write_conflict(&m, table->stream);
    return CLI_DONE;
}

int cli_table_close(cli_table *table) {
    int failed = ferror((FILE *)table->stream) | fclose(table->stream);
    table->stream = NULL;
    if (failed || rename(table->temporary, table->path) != 0)
        return cli_error(CLI_OUTPUT, "%s: cannot be written: %s", table->path, strerror(errno));
    return CLI_DONE;
}

void cli_table_discard(cli_table *table) {
    if (table->stream) {
        fclose(table->stream);
        remove(table->temporary);
    }
    free(table->path);
    free(table->temporary);
    *table = (cli_table){0};
}
