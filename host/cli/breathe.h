/* What the verb breathe is made of: pictures of a sequence, and the files beside them. Functions that return
 * int return an exit status, with the sentence said. */
#ifndef SKG_CLI_BREATHE_H
#define SKG_CLI_BREATHE_H

#include "session.h"

typedef struct {
    cli_session session;
    skg_motion *motion;
    skg_plan *plan;
    int64_t pixels;
    float *image[2];  /* [rows][columns] of -ln(I/I0): one may be made while the other is used */
    double low, high; /* shown from black to white, one range for all frames */
    int range_told;   /* lengths outside the verified range were warned of */
    char *outline;    /* [rows][columns] 1 where an outline is drawn; NULL: none */
} cli_fluoroscopy;

/* The image of the motion as it is posed, into image[which]: started, then waited for. */
int cli_start_image(cli_fluoroscopy *f, int which, skg_job **job);
int cli_wait_image(cli_fluoroscopy *f, skg_job **job);

/* "ribs,diaphragm@0": the outlines of these parts at that phase (breathe_outline.c). */
int cli_find_outline(cli_fluoroscopy *f, const char *wanted);

/* Writes image[which], outline drawn in, as a PNG. */
int cli_write_frame(cli_fluoroscopy *f, int which, const char *path);

/* Small pictures of up to 16 frames, side by side (breathe_sheet.c). */
typedef struct {
    int64_t frames, across, down, step; /* step: pixels of a frame that become one */
    int64_t columns, rows;              /* of a small picture */
    float *values;
} cli_sheet;

int cli_sheet_make(const cli_fluoroscopy *f, int64_t frames, cli_sheet *sheet);
void cli_sheet_add(const cli_fluoroscopy *f, int which, int64_t frame, int64_t frames, cli_sheet *sheet);
int cli_sheet_write(const cli_fluoroscopy *f, const cli_sheet *sheet, const char *path);

/* One PLY per part that moves, "LABEL-0042.ply", with the displacement of each vertex in mm
 * (breathe_meshes.c). */
int cli_write_meshes(const cli_fluoroscopy *f, const char *folder, int64_t frame);

/* motion.csv: its heading, and a line of the motion as it is posed (breathe_table.c). */
typedef struct {
    char *path, *temporary;
    void *stream;
} cli_table;

int cli_table_open(const char *path, cli_table *table);
int cli_table_add(const cli_fluoroscopy *f, double time_s, cli_table *table);
int cli_table_close(cli_table *table); /* the file is there from now on */
void cli_table_discard(cli_table *table);

#endif
