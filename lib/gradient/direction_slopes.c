/* How parts, source and detector move along a direction, and the slopes of their faces. */
#include "gradient/direction_slopes.h"

#include "core/maths.h"
#include "core/threads.h"
#include "gradient/faces.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { RANGE = 2048, BLOCK = 64 }; /* vertices or faces of a range; faces whose slopes are found together */

/* --- which parts move */

skg_velocities skg_moving_velocities(const skg_moving_parts *moving, int64_t direction, int64_t part) {
    SKG_ASSERT(0 <= direction && direction < moving->count && 0 <= part && part < moving->pass->scene->count);
    const skg_pass_direction *d = &moving->directions[direction];
    skg_velocities v = d->of_view;
    if (d->direction->poses) memcpy(v.pose, d->direction->poses + 6 * part, sizeof v.pose);
    if (d->direction->vertices) v.vertices = d->direction->vertices[part];
    return v;
}

static int moves_along(const skg_moving_parts *moving, int64_t direction, int64_t part) {
    const skg_velocities v = skg_moving_velocities(moving, direction, part);
    return skg_slopes_move(&v);
}

static skg_status place_parts(skg_job *job, skg_moving_parts *moving) {
    int64_t first = 0;
    for (int64_t p = 0; p < moving->pass->scene->count; p++) {
        skg_face_moments *faces = &moving->faces[p];
        SKG_TRY(skg_gradient_place_faces(job, moving->pass, p, faces));
        moving->edges[p] = (skg_part_edges){.all = &moving->of_edges, .part = p};
        const skg_camera_place place = skg_geometry_place(&moving->pass->parts[p], 0);
        skg_part_double entry;
        skg_camera_part(&moving->pass->camera, &place, &entry);
        faces->pixel[0] = entry.pixel_i, faces->pixel[1] = entry.pixel_j;
        faces->weigh = skg_edge_weigh;
        faces->weigh_user = &moving->edges[p];
        moving->first[p] = first;
        first += faces->mesh->triangles;
        for (int64_t d = 0; d < moving->count; d++) moving->moves[p] |= (uint8_t)moves_along(moving, d, p);
    }
    return SKG_OK;
}

/* --- memory of the parts that move */

/* The vertices of a mesh as the device has them. */
static int64_t vertices_of(const skg_geometry *geometry, int64_t part) {
    const skg_mesh_layout *layout = &geometry->layouts[geometry->mesh_of_part[part]];
    return layout->vertices + layout->copies;
}

/* Divides a block among the parts that move; from: NULL: only counts. Returns the doubles that it takes. */
static int64_t divide(const skg_geometry *geometry, const skg_moving_parts *moving, double *from) {
    int64_t used = 0;
    for (int64_t p = 0; p < moving->pass->scene->count; p++) {
        const int64_t vertices = vertices_of(geometry, p), faces = moving->faces[p].mesh->triangles;
        if (!moving->moves[p]) continue;
        if (from)
            moving->seen[p] = (skg_seen_faces){.at = (double(*)[3])(from + used),
                                               .pixel = (double(*)[2])(from + used + 3 * vertices),
                                               .inverse = from + used + 5 * vertices,
                                               .pull = (double(*)[3])(from + used + 6 * vertices)};
        used += 6 * vertices + 3 * faces;
    }
    return used;
}

/* Ranges of the faces of the parts that move, or of the vertices that they have. Returns their number. */
static int64_t list_ranges(const skg_geometry *geometry, const skg_moving_parts *moving, int of_vertices,
                           skg_slope_range *ranges) {
    int64_t made = 0;
    for (int64_t p = 0; p < moving->pass->scene->count; p++) {
        const int64_t count = of_vertices ? vertices_of(geometry, p) : moving->faces[p].mesh->triangles;
        for (int64_t f = 0; moving->moves[p] && f < count; f += RANGE, made++)
            if (ranges)
                ranges[made] =
                    (skg_slope_range){.part = p, .first = f, .end = f + RANGE < count ? f + RANGE : count};
    }
    return made;
}

static skg_status see_vertices(void *user, int64_t number) {
    const skg_moving_parts *moving = user;
    const skg_slope_range *range = &moving->ranges[number];
    skg_slopes_see_vertices(&moving->faces[range->part], range->first, range->end,
                            &moving->seen[range->part]);
    return SKG_OK;
}

static skg_status see_parts(const skg_geometry *geometry, skg_moving_parts *moving) {
    const int64_t of_vertices = list_ranges(geometry, moving, 1, NULL);
    const int64_t of_faces = list_ranges(geometry, moving, 0, NULL);
    double *block = NULL;
    SKG_TRY(skg_alloc(divide(geometry, moving, NULL) + 1, sizeof *block, "derivative", &block));
    moving->block = block;
    (void)divide(geometry, moving, block);
    SKG_TRY(skg_alloc(of_vertices > of_faces ? of_vertices : of_faces, sizeof *moving->ranges, "derivative",
                      &moving->ranges));
    (void)list_ranges(geometry, moving, 1, moving->ranges);
    SKG_TRY(skg_parallel(of_vertices, see_vertices, moving));
    moving->range_count = list_ranges(geometry, moving, 0, moving->ranges);
    return SKG_OK;
}

skg_status skg_moving_parts_create(skg_job *job, const skg_pass *pass, int64_t count,
                                   const skg_pass_direction *directions, skg_moving_parts *moving) {
    const int64_t parts = pass->scene->count;
    *moving = (skg_moving_parts){.pass = pass, .count = count, .directions = directions};
    SKG_TRY(skg_alloc(parts, sizeof *moving->faces, "derivative", &moving->faces));
    SKG_TRY(skg_alloc(parts, sizeof *moving->edges, "derivative", &moving->edges));
    SKG_TRY(skg_alloc(parts, sizeof *moving->first, "derivative", &moving->first));
    SKG_TRY(skg_alloc(parts, sizeof *moving->moves, "derivative", &moving->moves));
    SKG_TRY(skg_alloc(parts, sizeof *moving->moves_now, "derivative", &moving->moves_now));
    SKG_TRY(skg_alloc(parts, sizeof *moving->seen, "derivative", &moving->seen));
    SKG_TRY(skg_edge_weights_create(pass, &moving->of_edges));
    SKG_TRY(place_parts(job, moving));
    return see_parts(&job->machine->geometry, moving);
}

void skg_moving_parts_release(skg_moving_parts *moving) {
    skg_edge_weights_release(&moving->of_edges);
    skg_free(&moving->faces);
    skg_free(&moving->edges);
    skg_free(&moving->first);
    skg_free(&moving->moves);
    skg_free(&moving->moves_now);
    skg_free(&moving->seen);
    skg_free(&moving->ranges);
    skg_free(&moving->block);
}

/* --- slopes */

typedef struct {
    skg_moving_parts *moving;
    int64_t direction;
    skg_reals reals; /* [triangles][3] */
    double limit;    /* of magnitudes */
} slopes_run;

/* Cuts slopes off, counts them, and rounds them. number: of the first */
static void take_slopes(const slopes_run *run, int64_t number, int64_t count, const double *slopes,
                        skg_slope_range *range) {
    for (int64_t i = 0; i < count; i++) {
        const double size = fabs(slopes[i]), cut = size > run->limit ? run->limit : size;
        const double slope = copysign(cut, slopes[i]);
        range->sum += size;
        range->used += size != 0;
        range->cut += size > run->limit;
        range->largest = cut > range->largest ? cut : range->largest;
        if (run->reals.is_double)
            ((double *)run->reals.memory)[number + i] = slope;
        else
            ((float *)run->reals.memory)[number + i] = (float)slope;
    }
}

static skg_status find_range(void *user, int64_t number) {
    const slopes_run *run = user;
    skg_moving_parts *moving = run->moving;
    skg_slope_range *range = &moving->ranges[number];
    const int64_t part = range->part;
    const skg_pass *pass = moving->pass;
    const double reference = pass->parts[part].reference;
    const double rounding =
        pass->kernels.precision == SKG_PRECISION_DOUBLE ? DBL_EPSILON : (double)FLT_EPSILON;
    double slopes[3 * BLOCK];
    if (!moving->is_seen)
        skg_slopes_see_faces(&moving->faces[part], rounding, range->first, range->end, &moving->seen[part]);
    if (!moving->moves_now[part]) return SKG_OK;
    const skg_velocities v = skg_moving_velocities(moving, run->direction, part);
    range->sum = range->largest = 0;
    range->used = range->cut = 0;
    for (int64_t f = range->first; f < range->end; f += BLOCK) {
        const int64_t end = f + BLOCK < range->end ? f + BLOCK : range->end;
        skg_slopes_find(&moving->faces[part], &v, &moving->seen[part],
                        pass->camera.parallel || !(reference > 0) ? 1 : reference, f, end, slopes);
        take_slopes(run, 3 * (moving->first[part] + f), 3 * (end - f), slopes, range);
    }
    return SKG_OK;
}

/* The sums of the ranges of the parts that move now. */
static skg_slope_range total_of(const skg_moving_parts *moving) {
    skg_slope_range total = {.part = -1};
    for (int64_t r = 0; r < moving->range_count; r++) {
        const skg_slope_range *range = &moving->ranges[r];
        if (!moving->moves_now[range->part]) continue;
        total.sum += range->sum;
        total.used += range->used;
        total.cut += range->cut;
        total.largest = range->largest > total.largest ? range->largest : total.largest;
    }
    return total;
}

skg_status skg_slopes_make(skg_job *job, skg_moving_parts *moving, int64_t direction, double *largest,
                           int64_t *saturated) {
    slopes_run run = {.moving = moving, .direction = direction, .limit = HUGE_VAL};
    SKG_TRY(skg_gradient_reserve_slopes(&job->machine->geometry, skg_gradient_of(job)->memory, &run.reals));
    for (int64_t p = 0; p < moving->pass->scene->count; p++)
        moving->moves_now[p] = (uint8_t)moves_along(moving, direction, p);
    SKG_TRY(skg_parallel(moving->range_count, find_range, &run));
    moving->is_seen = 1;
    skg_slope_range total = total_of(moving);
    if (total.used && total.largest > ldexp(total.sum / (double)total.used, 24)) {
        run.limit = ldexp(total.sum / (double)total.used, 24);
        SKG_TRY(skg_parallel(moving->range_count, find_range, &run));
        total = total_of(moving);
    }
    *largest = total.largest;
    *saturated += total.cut;
    return SKG_OK;
}
