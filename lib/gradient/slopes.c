/* How the depth of a face at a pixel changes when vertices, pose, source or detector move. */
#include "gradient/slopes.h"

#include "core/maths.h"

#include <float.h>

/* The velocity of a point that a twist moves. */
static void turn_point(const double twist[6], const double point[3], double velocity[3]) {
    skg_cross(twist + 3, point, velocity);
    for (int k = 0; k < 3; k++) velocity[k] += twist[k];
}

/* The velocity of a point relative to the ray that meets it: turn x point + still + t along. */
typedef struct {
    double turn[3], still[3], along[3];
} relative_velocity;

/* With a point source the ray at a point moves by (1 - t) times the source's velocity, and t times that of the pixel, which stands at
 * source + (point - source) / t; with a parallel beam by that of the pixel, at point - t d, and t times that of d. */
static void find_relative(const skg_camera *camera, const skg_velocities *v, relative_velocity *r) {
    double swing[3];
    skg_cross(v->detector + 3, camera->parallel ? camera->first : camera->origin, swing);
    for (int k = 0; k < 3; k++) {
        const double source = v->source[k], detector = v->detector[k];
        r->turn[k] = v->pose[3 + k] - v->detector[3 + k];
        r->still[k] = v->pose[k] + (camera->parallel ? -detector : swing[k] - source);
        r->along[k] = camera->parallel ? swing[k] - v->beam[k] : source - detector - swing[k];
    }
}

static int64_t vertex_of(const skg_face_moments *faces, int64_t number) {
    return faces->source ? faces->source[number] : number;
}

/* How fast a vertex, by the device's number, moves by itself along a vector. */
static double vertex_moves(const skg_face_moments *faces, const skg_velocities *v, int64_t number,
                           const double along[3]) {
    const double *velocity = v->vertices + 3 * vertex_of(faces, number);
    double moves = 0;
    for (int k = 0; k < 3; k++) moves += along[k] * skg_dot(faces->pose + 4 * k, velocity);
    return moves;
}

/* A face in the world, and as its camera sees it. */
typedef struct {
    double at[3][3], seen[3][3];
} placed_face;

static void place_vertex(const skg_face_moments *faces, int64_t vertex, double at[3], double seen[3]) {
    double local[3];
    skg_mesh_vertex(faces->mesh, vertex, local);
    for (int r = 0; r < 3; r++) at[r] = skg_dot(faces->pose + 4 * r, local) + faces->pose[4 * r + 3];
    skg_camera_see(faces->camera, at, seen);
}

static void place_face(const skg_face_moments *faces, int64_t face, placed_face *f) {
    for (int k = 0; k < 3; k++) {
        place_vertex(faces, vertex_of(faces, faces->corners[3 * face + k]), f->at[k], f->seen[k]);
    }
}

/* fmax without a call. NaN is taken, so that nothing is narrower than it. */
static double larger(double a, double b) {
    return a >= b ? a : b;
}

/* Whether the device surely sees a face as a line (kernels/gradient/gradient.cl): what is half as wide as that is so after any rounding. */
static int is_line(const double *a, const double *b, const double *c, const int32_t *from, double rounding) {
    double longest = 0, far = 0;
    for (int k = 0; k < 2; k++) {
        far = larger(far, larger(fabs(a[k] - from[k]), larger(fabs(b[k] - from[k]), fabs(c[k] - from[k]))));
        longest = larger(longest, larger(fabs(a[k] - b[k]), larger(fabs(b[k] - c[k]), fabs(c[k] - a[k]))));
    }
    const double twice_area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    return fabs(twice_area) <= 0.5 * larger((double)SKG_LINE, SKG_LINE_PLACES * rounding * far) * longest;
}

static int any(const double *numbers, int count) {
    int found = 0;
    for (int k = 0; k < count; k++) found |= numbers[k] != 0;
    return found;
}

int skg_slopes_move(const skg_velocities *v) {
    return v->vertices || any(v->pose, 6) || any(v->source, 3) || any(v->detector, 6) || any(v->beam, 3);
}

void skg_slopes_see_vertices(const skg_face_moments *faces, int64_t first, int64_t end,
                             skg_seen_faces *seen) {
    for (int64_t v = first; v < end; v++) {
        double h[3];
        place_vertex(faces, vertex_of(faces, v), seen->at[v], h);
        seen->inverse[v] = faces->camera->parallel ? h[2] : 1 / h[2];
        for (int k = 0; k < 2; k++)
            seen->pixel[v][k] = faces->camera->parallel ? h[k] : h[k] * seen->inverse[v];
    }
}

void skg_slopes_see_faces(const skg_face_moments *faces, double rounding, int64_t first, int64_t end,
                          skg_seen_faces *seen) {
    const skg_camera *camera = faces->camera;
    for (int64_t face = first; face < end; face++) {
        const int32_t *corner = faces->corners + 3 * face;
        const double *a = seen->at[corner[0]], *b = seen->at[corner[1]], *c = seen->at[corner[2]];
        double side[2][3], normal[3], from[3];
        skg_add_scaled(b, -1, a, side[0]);
        skg_add_scaled(c, -1, a, side[1]);
        skg_add_scaled(a, -1, camera->origin, from);
        skg_cross(side[0], side[1], normal);
        const double height = skg_dot(normal, camera->parallel ? camera->first : from);
        const int line = is_line(seen->pixel[corner[0]], seen->pixel[corner[1]], seen->pixel[corner[2]],
                                 faces->pixel, rounding);
        const double scale = line || height == 0 ? 0 : 1 / height;
        skg_scale_vector(scale, normal, seen->pull[face]);
    }
}

void skg_slopes_find(const skg_face_moments *faces, const skg_velocities *velocities,
                     const skg_seen_faces *seen, double factor, int64_t first, int64_t end, double *slopes) {
    const int parallel = faces->camera->parallel;
    relative_velocity r;
    find_relative(faces->camera, velocities, &r);
    for (int64_t face = first; face < end; face++) {
        /* pull . (turn x point + still + t along) */
        double pull[3], turned[3];
        skg_scale_vector(factor, seen->pull[face], pull);
        skg_cross(pull, r.turn, turned);
        const double still = skg_dot(pull, r.still), along = skg_dot(pull, r.along);
        for (int k = 0; k < 3; k++) {
            const int32_t corner = faces->corners[3 * face + k];
            const double inverse = seen->inverse[corner];
            double moves = skg_dot(turned, seen->at[corner]) + still;
            if (velocities->vertices) moves += vertex_moves(faces, velocities, corner, pull);
            const double slope = parallel ? moves + inverse * along : moves * inverse + along;
            *slopes++ = fabs(slope) <= DBL_MAX ? slope : 0;
        }
    }
}

skg_status skg_slopes_spread(const skg_face_moments *faces, const skg_velocities *velocities, int64_t face,
                             double *values) {
    placed_face f;
    double normal[3], relative[3], slopes[3];
    relative_velocity r;
    SKG_ASSERT(0 <= face && face < faces->mesh->triangles);
    find_relative(faces->camera, velocities, &r);
    place_face(faces, face, &f);
    skg_face_outward(faces, f.at, normal);
    for (int k = 0; k < 3; k++) {
        skg_cross(r.turn, f.at[k], relative);
        for (int c = 0; c < 3; c++) relative[c] += r.still[c] + f.seen[k][2] * r.along[c];
        slopes[k] = skg_dot(normal, relative);
        if (velocities->vertices)
            slopes[k] += vertex_moves(faces, velocities, faces->corners[3 * face + k], normal);
    }
    return skg_steep_spread(faces->camera, f.seen, faces->weigh, faces->weigh_user, slopes, values);
}

double skg_slope_of_ray(const skg_camera *camera, const skg_velocities *velocities, const double ray[3]) {
    double pixel[3], moves[3];
    skg_add_scaled(camera->origin, 1, ray, pixel);
    turn_point(velocities->detector, pixel, moves);
    skg_add_scaled(moves, -1, velocities->source, moves);
    return skg_dot(ray, moves) / skg_dot(ray, ray);
}

double skg_slope_of_distance(const skg_camera *camera, const skg_velocities *velocities, const double from[3],
                             const double way[3], const double source[3]) {
    double normal[3], turned[3], place[3], moves[3];
    skg_cross(camera->column, camera->row, normal);
    skg_cross(velocities->detector + 3, normal, turned);
    skg_add_scaled(from, 1, way, place);
    turn_point(velocities->detector, place, moves);
    skg_add_scaled(moves, -1, source, moves);
    return (skg_dot(moves, normal) + skg_dot(way, turned)) / skg_dot(way, normal);
}
