/* Shared code of tests of the public interface: a device, plans of a few lines, images and their bits. A failing call ends the test. */
#ifndef SKG_TESTS_RUN_H
#define SKG_TESTS_RUN_H

#include "support/shapes.h"

#include <skiagraph/skiagraph.h>

/* The device, opened by a checked fixture: tcase_add_checked_fixture(tests, run_open, run_close). Tests that run in one process share it. */
extern skg_context *run_context;
void run_open(void);
void run_close(void);
int run_has_double(void); /* 1: the device knows precision double */

/* n x n pixels of `pitch` mm around the z axis at z = 200 mm, point source at z = -1000 mm. */
skg_view run_view(int64_t n, double pitch);

skg_mesh *run_mesh(const solid *s);

/* Adds a part of `mu` per cm; pose may be NULL, inside -1. Returns its number. */
int64_t run_part(skg_scene *scene, const char *label, skg_mesh *mesh, double mu, const double *pose,
                 int64_t inside);

/* A scene of one part with 1 per cm. */
skg_scene *run_scene(const solid *s, const double *pose);

/* Choices of tests; all zero: single precision, everything else as the plan thinks. */
typedef struct {
    int32_t precision, strategy, tile, quantity;
} run_choice;

/* A plan of 100 keV and one photon per pixel, without a search for overlaps. */
skg_plan *run_plan(skg_scene *scene, const skg_view *view, run_choice choice);

/* The lengths of part 0 by SKG_OUTPUT_LENGTHS, SKG_LENGTHS_SURFACE, one frame as it stands: float32 for single, float64
 * for double, handed out as doubles [rows][columns]; to be freed. */
double *run_lengths(skg_plan *plan, const skg_view *view);

/* Path lengths of a solid by a plan of its own. */
double *run_solid(const solid *s, const double *pose, const skg_view *view, run_choice choice);

/* The image as it stands, in doubles [rows][columns]; to be freed. */
double *run_image(skg_plan *plan, const skg_view *view);

/* FNV-1a, 64 bits. */
uint64_t run_hash(const void *bytes, int64_t count);

#endif
