/* Outputs of a scene that moves: outlines, meshes, a table, a contact sheet, a film. Functions that return int return an exit status and
 * print the error. */
#ifndef CLI_BREATHE_OUTPUTS_H
#define CLI_BREATHE_OUTPUTS_H

#include "breathe/fluoroscopy.h"
#include "common/file.h"

#include <jansson.h>
#include <stdio.h>

/* Finds the outlines of "ribs,diaphragm@0": the parts whose labels begin with a word of the list, at the
 * phase after '@' (0 without one). "ribs" also stands for "rib 1", "rib 2" and so on. */
int outline_find(fluoroscopy *f, const char *wanted);

/* Writes "LABEL-0042.ply" for every part that moves, with the displacement of each vertex in mm. */
int meshes_write(const fluoroscopy *f, const char *folder, int64_t frame);

/* motion.csv: its heading, and a line of the motion for each frame. The file appears with the last one. */

typedef struct {
    cli_file file;
} motion_table;

int table_open(const char *path, motion_table *table);

/* Adds a line of the motion in its present pose. */
int table_add(const fluoroscopy *f, double time_s, motion_table *table);

/* A signal that ends the command leaves the lines so far under the table's name. */
void table_keep(const motion_table *table);

/* Finishes the table or, if it is not whole, removes it. Does nothing to one that is not open if it is not whole. */
int table_close(motion_table *table, int is_whole);

/* The contact sheet: small pictures of up to 16 frames, side by side. */

typedef struct {
    int64_t frames, across, down;
    int64_t step;          /* a block of step x step pixels of a frame becomes one pixel */
    int64_t columns, rows; /* of a small picture */
    float *values;
} contact_sheet;

/* The caller frees sheet->values. */
int sheet_create(const fluoroscopy *f, int64_t frames, contact_sheet *sheet);

/* Adds image[which], frame number `frame` of `frames`, if it is one of those shown. */
void sheet_add(const fluoroscopy *f, int which, int64_t frame, int64_t frames, contact_sheet *sheet);
int sheet_write(const fluoroscopy *f, const contact_sheet *sheet, const char *path);

/* The dose of all frames together, each an exposure of the scene as it stands, without photons that are followed. sum: result; NULL: the scene
 * does not say how many photons there are. The caller releases it. */
skg_status film_dose(const fluoroscopy *f, int64_t frames, skg_dose **sum);
json_t *film_dose_json(const skg_dose *sum);
void film_dose_print(const skg_dose *sum);

/* The sequence of frames that the flags choose, and its times. */

typedef struct {
    double seconds, fps;
    double phase, at; /* of one picture; NaN: not given */
    int64_t frames;
    const char *place, *meshes;
    double plan_ms, sequence_ms;
    double pose_ms; /* of all frames of the sequence */
    skg_dose *dose; /* of all frames; NULL: not known, or one picture */
} sequence;

/* Moves the scene to a frame of the sequence. */
int sequence_pose(fluoroscopy *f, const sequence *s, int64_t frame);

/* Computes the frames and writes them to the one file s->place. */
int write_film(fluoroscopy *f, const sequence *s);

#endif
