/* The verified range of path lengths, and the bound of the error there. Private. */
#ifndef SKG_VERIFICATION_H
#define SKG_VERIFICATION_H

#include "core/core.h"
#include "geometry/optics.h"
#include "scene/scene.h"
#include "spectral/model.h"

/* --- Rays through one part, traced on the host in double. */

/* The most rays along each side of a grid. */
enum { SKG_TRACED_SIDE = 64 };

/* A part as a camera sees it, and a grid of rays through it. */
typedef struct {
    const skg_camera *camera;
    const skg_mesh *mesh;
    int32_t near_source, reserved; /* 1: signed hits may be left over, since paths start inside */
    double (*seen)[6];             /* [vertices] x, y, w and path parameter; column and row where w > 0 */
    int64_t side;                  /* rays along each side of the grid */
    double column, row;            /* of the first ray, in pixels */
    double column_step, row_step;
    double *lengths; /* [side][side] mm, signed; 0 where the signed hits of a leaky mesh do not cancel */
    int32_t *counts; /* [side][side] signed hits */
    int32_t *met;    /* [side][side] hits */
    int64_t hits;
} skg_tracer;

/* *tracer is released by skg_tracer_release, after a failure too. It keeps the addresses that it is given. */
skg_status skg_tracer_open(const skg_camera *camera, const skg_scene_part_data *part, int near_source,
                           skg_tracer *tracer);
void skg_tracer_release(skg_tracer *tracer);

/* Lays side x side rays over the rectangle from low to high (column, row), and traces them. No ray: the rectangle is
 * empty. */
void skg_tracer_trace(skg_tracer *tracer, int64_t side, const double low[2], const double high[2]);

/* Likewise over the whole detector. */
void skg_tracer_trace_detector(skg_tracer *tracer, int64_t side);

/* The longest ray to a pixel for a path parameter of 1, mm. */
double skg_ray_longest(const skg_camera *camera);

/* The longest way of a ray from where it starts to its pixel, mm. */
double skg_way_longest(const skg_camera *camera);

/* The way of the rays of such a grid over the detector in mm: [side][side]. */
void skg_ways_find(const skg_camera *camera, int64_t side, double *ways);

/* --- The lengths of materials that the rays of a view meet: a coarse L-buffer in double, made on the host. */

typedef struct {
    int32_t planes, reserved; /* planes, then shades, which the caller fills */
    int64_t rays;
    double *lengths; /* [rays][planes] what a ray adds to the planes, mm times weight */
    /* [planes] mm, 0 or less; with a margin of a quarter, and a fiftieth of the range below it */
    double *low;
    double *high; /* [planes] mm */
    double *hits; /* [parts] mean per ray of the first view */
    double way;   /* what the longest ray without parts adds to the plane of the world; 0: vacuum */
} skg_ranges;

/* Traces rays to 64 x 64 points of the view's detector, to 24 x 24 of that of each of `more` other views, and to
 * 16 x 16 points of each part's own rectangle, so that small parts are met. A part that a view does not show
 * counts with the longest edge of its box. Of the model, planes and contributions are used. */
skg_status skg_ranges_find(const skg_scene *scene, const skg_view *view, int64_t more, const skg_view *views,
                           const skg_model *model, skg_ranges *ranges);
void skg_ranges_release(skg_ranges *ranges);

/* Margin for paths longer than the longest traced one, as a factor. */
#define SKG_TRACED_MARGIN 1.25

/* One part along the rays of a view. */
typedef struct {
    int64_t part;
    const double *lengths; /* [SKG_TRACED_SIDE][SKG_TRACED_SIDE] mm */
    double longest;        /* mm, the longest that was found */
    double deepest;        /* mm, its extent along the rays, at most */
    double farthest;       /* mm from the source, at most */
    int32_t met;           /* surfaces on a ray, at most */
} skg_trace;
typedef void skg_take_trace(void *user, const skg_trace *trace);

/* Traces rays over the view's detector through each part that contributes to a plane and is seen.
 *
 * wanted   [parts] 1: this part is traced; NULL: all are */
skg_status skg_ranges_trace(const skg_scene *scene, const skg_view *view, const skg_model *model,
                            const unsigned char *wanted, skg_take_trace *take, void *user);

/* --- Error of intensities by the precision of path lengths */

typedef struct {
    /* Of the relative error of intensities: relative where more than 1e-6 of the flat field arrives, else in units of 1e-6 of
     * the flat field. With the quantity attenuation, of its error in units of the greatest attenuation of these rays, or of 1 if
     * that is less. */
    double bound;
    /* Parts whose lengths may be wrong by more than 1 % of the longest, and the one with the largest share. */
    int64_t thin_count, thin;
    double thin_error, thin_longest; /* mm */
} skg_rounding;

/* Bounds the error that the rounding of lengths and exponents makes.
 *
 * options   its precision; with half precision images are rounded as well
 * seams     [parts] the share of its extent along the rays by which the length of a part that touches others may be wrong besides;
 *           NULL: 0
 * method    rays to 64 x 64 points of the detector; each part that a ray meets may be wrong by the bar of docs/numerics.md:
 *           a share of the longest path through the part, or of its extent along the rays if that is more; with half
 *           precision half a last place of a distance in metres for each surface that is met */
skg_status skg_rounding_find(const skg_scene *scene, const skg_view *view, const skg_model *model,
                             const skg_plan_options *options, const double *seams, skg_rounding *rounding);

/* Finds only thin parts, judged by their volumes: fills thin_count and the members after it, but not the bound. Costs nothing where no part
 * may be thin. */
skg_status skg_rounding_find_thin(const skg_scene *scene, const skg_view *view, const skg_model *model,
                                  const skg_plan_options *options, skg_rounding *rounding);

/* --- The transmission of a beam of several energies through lengths of materials, its error with fewer energies and
 * planes, and the search for the worst error. *
 * Errors are relative for transmissions above 1e-6; below, they are relative to 1e-6. */

/* The transmission from which on errors are relative. Smaller ones are lost in the noise of real images. */
#define SKG_RELATIVE_FROM 1e-6

/* The largest exponent of the energy that passes best. Single precision ends at exp(-87). */
#define SKG_EXPONENT_MAX 80

/* The exact beam, with every bin. A set is the weight of each bin in one channel, as a share of the flat field. */
typedef struct {
    int32_t bins, materials, sets;
    int32_t paired;       /* 1: sets k and sets/2 + k must use the same nodes */
    const double *mu;     /* [materials][bins] 1/mm */
    const double *shares; /* [bins][sets], each set sums to 1 */
    const double *low;    /* [materials] mm: range of the lengths */
    const double *high;
    double floor; /* transmission from which on errors are relative */
} skg_polychromatic;

/* Few energies: some of the bins, each with a weight in every set. */
typedef struct {
    int32_t count, reserved;
    int32_t *bin;   /* [count] rising */
    double *shares; /* [count][sets], >= 0 */
} skg_nodes;

/* Points: lengths [count][materials] in mm, with the exact transmission of each [count][sets]. */
typedef struct {
    int64_t count, capacity;
    double *lengths, *exact;
} skg_lengths;

/* Which points are taken. */
typedef struct {
    int64_t corners; /* all corners of the range, or this many */
    int64_t draws;   /* random points */
    int64_t rays;    /* at most this many of the rays, evenly spread */
    uint64_t seed;
} skg_sampling;

/* Lengths that rays meet, of which the first columns are those of the materials. */
typedef struct {
    int64_t count, width;
    const double *lengths; /* [count][width] mm */
} skg_rays;

void skg_nodes_release(skg_nodes *nodes);
void skg_lengths_release(skg_lengths *points);

/* Sets exact [sets] to the transmission of each set through lengths [materials], which are scaled down first until the
 * energy that passes best has at most the largest exponent. exponents: [bins], for the work. */
void skg_transmit_exact(const skg_polychromatic *beam, double *lengths, double *exact, double *exponents);

/* Sets passed [bins] to exp(-sum of lengths times mu). mu: [materials][bins] 1/mm. */
void skg_transmit(const skg_polychromatic *beam, const double *mu, const double *lengths, double *passed);

/* Adds points with their transmissions: no matter at all, the corners of the range, random points of the sequence that
 * `seed` starts, and rays. Half of the random points are even over the range, half have more thin lengths. */
skg_status skg_lengths_fill(const skg_polychromatic *beam, const skg_sampling *sampling, const skg_rays *rays,
                            skg_lengths *points);

/* The worst error over the sets, at one point, of nodes whose materials attenuate by mu ([materials][bins]).
 * exact: [sets] at that point. */
double skg_nodes_error(const skg_polychromatic *beam, const double *mu, const skg_nodes *nodes,
                       const double *lengths, const double *exact);

/* The error of -ln of the transmission, and the smallest transmission of a set that rays meet.
 *
 * error   absolute, at most, over the rays and sets
 * least   share of the flat field */
skg_status skg_nodes_log_error(const skg_polychromatic *beam, const double *mu, const skg_nodes *nodes,
                               const skg_rays *rays, double *error, double *least);

/* The worst error over the points, and uphill from the worst ten of them within the range.
 *
 * checked   the number of points that were compared
 * worst     NULL, or the list to which the ends of the ascents are added */
skg_status skg_nodes_verify(const skg_polychromatic *beam, const double *mu, const skg_nodes *nodes,
                            const skg_lengths *points, double *error, int64_t *checked, skg_lengths *worst);

#endif
