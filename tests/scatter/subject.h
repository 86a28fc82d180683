/* Scenes that scatter, and their frames. The device is run_context of support/run.h. */
#ifndef SKG_TESTS_SCATTER_SUBJECT_H
#define SKG_TESTS_SCATTER_SUBJECT_H

#include "support/run.h"

#include <skiagraph/scatter_series.h>

typedef struct {
    skg_scene *scene;
    skg_view view;
    double kev, photons; /* of the beam */
    skg_spectrum *beam;  /* instead of these, borrowed; NULL: none */
    skg_plan_options options;
    skg_scatter scatter;
    skg_collimation jaws; /* used if kind is not SKG_COLLIMATION_OPEN */
    skg_plan *plan;       /* after subject_plan */
} subject;

/* Nothing yet in a beam of 60 keV and 1e5 photons per pixel, from z = -500 mm to a detector of 40 x 30 pixels of 5 mm at z = 200
 * mm; 4,096 histories, falloff on. */
void subject_open(subject *s);
void subject_close(subject *s);

/* Adds a part whose middle is at (x, y, z); releases the mesh. Returns its number. */
int64_t subject_add(subject *s, skg_mesh *mesh, const char *material, double x, double y, double z,
                    int64_t inside);
int64_t subject_add_box(subject *s, double x, double y, double z, const char *material);

/* A box of water, 80 x 60 x 40 mm, with one of bone in it. */
void subject_fill(subject *s);

/* Makes the plan, or says why not. */
skg_status subject_try(subject *s);
void subject_plan(subject *s);

/* The images of a frame, [rows][columns] floats, to be freed; NULL: as the plan stands. */
typedef struct {
    int64_t count;
    float *image, *scatter, *sigma;
} pictures;
pictures subject_pictures(subject *s, const skg_frame *frame);
void pictures_free(pictures *p);

double subject_sum(const subject *s, const float *image);
skg_scatter_report subject_report(const subject *s);

#endif
