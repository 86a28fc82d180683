/* A thorax, its radiographs with known pose, and what they have that a model lacks. */
#ifndef BENCH_REGISTER_SUBJECT_H
#define BENCH_REGISTER_SUBJECT_H

#include "common/bench.h"

enum { SUBJECT_VIEWS = 2 };

/* Contents of a radiograph beside the clean image of one energy: bits. */
enum { SUBJECT_NOISE = 1, SUBJECT_SPECTRUM = 2, SUBJECT_TISSUE = 4, SUBJECT_SCATTER = 8 };

/* Meshes of the body as a segmentation has them. */
enum { SUBJECT_AS_GIVEN, SUBJECT_DECIMATED, SUBJECT_SMOOTHED };

typedef struct {
    skg_context *context;
    skg_setup *setup;
    skg_scene *scene;
    skg_spectrum *mono, *tube; /* both of 2e5 photons a pixel */
    skg_view views[SUBJECT_VIEWS];
    int64_t part_count, parts[64]; /* the body */
    double middle[3];              /* of its vertices */
    int64_t vertices;
    double *positions; /* [vertices][3] of the body in the world */
} subject;

/* data: a folder of BodyParts3D, whose vertebrae are the body; NULL: the generated thorax and its spine. part: another body of that
 * scene, such as "implant*", which is of steel and there as soon as it is asked for; NULL. side: pixels along the side of a radiograph of 560 mm. */
void subject_make(const char *data, const char *part, long side, subject *out);
void subject_free(subject *s);

/* A radiograph of the scene as it stands, as transmission: [side][side], which the caller frees. kind: noise of 2e5 photons, a
 * tube's spectrum, a tenth more of what the parts lie inside, scatter as the scene makes it. */
double *subject_radiograph(const subject *s, int view, int kind);

/* Gives the body's meshes fewer vertices, one for each cell of 4 mm, or smooths them in ten rounds. The radiographs were made before. */
void subject_segment(const subject *s, int way);

/* Mean distance of the body's vertices from where they are after a twist about the world's origin. */
double subject_error(const subject *s, const double *twist);

#endif
