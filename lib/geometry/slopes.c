#include "geometry/slopes.h"

#include "core/maths.h"

/* The velocity of a point that a twist moves. */
static void turn_point(const double twist[6], const double point[3], double velocity[3]) {
    skg_cross(twist + 3, point, velocity);
    for (int k = 0; k < 3; k++) velocity[k] += twist[k];
}

/* The velocity of a corner relative to the ray that meets it. */
static void find_velocity(const skg_face_moments *faces, const skg_velocities *v, int64_t vertex,
                          const double at[3], double t, double relative[3]) {
    const skg_camera *camera = faces->camera;
    double pixel[3], of_pixel[3];
    turn_point(v->pose, at, relative);
    for (int r = 0; v->vertices && r < 3; r++)
        relative[r] += skg_dot(faces->pose + 4 * r, v->vertices + 3 * vertex);
    for (int k = 0; k < 3; k++)
        pixel[k] = at[k] - (camera->parallel ? t * camera->first[k] : (1 - t) * camera->origin[k]);
    skg_cross(v->detector + 3, pixel, of_pixel); /* with a point source t times the rotation of the pixel */
    for (int k = 0; k < 3; k++)
        relative[k] -= camera->parallel ? v->detector[k] + of_pixel[k] + t * v->beam[k]
                                        : (1 - t) * v->source[k] + t * v->detector[k] + of_pixel[k];
}

/* A face in the world, and as its camera sees it. */
typedef struct {
    int64_t vertices[3];
    double at[3][3], seen[3][3];
} placed_face;

static void place_face(const skg_face_moments *faces, int64_t face, placed_face *f) {
    for (int k = 0; k < 3; k++) {
        const int32_t number = faces->corners[3 * face + k];
        double local[3];
        f->vertices[k] = faces->source ? faces->source[number] : number;
        skg_mesh_vertex(faces->mesh, f->vertices[k], local);
        for (int r = 0; r < 3; r++)
            f->at[k][r] = skg_dot(faces->pose + 4 * r, local) + faces->pose[4 * r + 3];
        skg_camera_see(faces->camera, f->at[k], f->seen[k]);
    }
}

/* Whether the device sees a face as a line, narrower than 1e-4 pixels, or may do so after rounding. A face that is somewhat wider is
 * integrated as exactly, so that more of them do no harm. */
static int is_edge_on(const skg_camera *camera, const placed_face *f, double rounding) {
    double at[3][2], longest = 0, far = 0;
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 2; c++) {
            at[k][c] = f->seen[k][c] / (camera->parallel ? 1 : f->seen[k][2]);
            far = fmax(far, fabs(at[k][c]));
        }
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 2; c++) longest = fmax(longest, fabs(at[k][c] - at[(k + 1) % 3][c]));
    const double twice_area =
        (at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) - (at[2][0] - at[0][0]) * (at[1][1] - at[0][1]);
    return fabs(twice_area) <= (1e-4 + 32 * rounding * far) * longest;
}

static int any(const double *numbers, int count) {
    int found = 0;
    for (int k = 0; k < count; k++) found |= numbers[k] != 0;
    return found;
}

int skg_slopes_move(const skg_velocities *v) {
    return v->vertices || any(v->pose, 6) || any(v->source, 3) || any(v->detector, 6) || any(v->beam, 3);
}

void skg_slopes_find(const skg_face_moments *faces, const skg_velocities *velocities, double factor,
                     double rounding, int64_t first, int64_t end, double *slopes, uint8_t *edge_on) {
    const skg_camera *camera = faces->camera;
    for (int64_t face = first; face < end; face++) {
        placed_face f;
        double normal[3], from[3], relative[3];
        place_face(faces, face, &f);
        edge_on[face] = (uint8_t)is_edge_on(camera, &f, rounding);
        skg_face_outward(faces, f.at, normal);
        skg_add_scaled(f.at[0], -1, camera->origin, from);
        const double height = skg_dot(normal, camera->parallel ? camera->first : from);
        for (int k = 0; k < 3; k++) {
            const double t = f.seen[k][2];
            find_velocity(faces, velocities, f.vertices[k], f.at[k], t, relative);
            const double slope =
                factor * skg_dot(normal, relative) / (camera->parallel ? height : height * t);
            slopes[3 * face + k] = isfinite(slope) && !edge_on[face] ? slope : 0;
        }
    }
}

skg_status skg_slopes_spread(const skg_face_moments *faces, const skg_velocities *velocities, int64_t face,
                             double *values) {
    placed_face f;
    double normal[3], relative[3], slopes[3];
    place_face(faces, face, &f);
    skg_face_outward(faces, f.at, normal);
    for (int k = 0; k < 3; k++) {
        find_velocity(faces, velocities, f.vertices[k], f.at[k], f.seen[k][2], relative);
        slopes[k] = skg_dot(normal, relative);
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
