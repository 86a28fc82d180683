#include "geometry/slopes.h"

#include "core/vector.h"

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

void skg_slopes_find(const skg_face_moments *faces, const skg_velocities *velocities, double factor,
                     double *slopes) {
    const skg_camera *camera = faces->camera;
    for (int64_t f = 0; f < faces->mesh->triangles; f++) {
        double at[3][3], t[3], side[2][3], normal[3], from[3], relative[3];
        int64_t vertices[3];
        for (int k = 0; k < 3; k++) {
            const int32_t number = faces->corners[3 * f + k];
            double local[3], seen[3];
            vertices[k] = faces->source ? faces->source[number] : number;
            skg_mesh_vertex(faces->mesh, vertices[k], local);
            for (int r = 0; r < 3; r++)
                at[k][r] = skg_dot(faces->pose + 4 * r, local) + faces->pose[4 * r + 3];
            skg_camera_see(camera, at[k], seen);
            t[k] = seen[2];
        }
        for (int k = 0; k < 2; k++) skg_add_scaled(at[k + 1], -1, at[0], side[k]);
        skg_cross(side[0], side[1], normal);
        skg_add_scaled(at[0], -1, camera->origin, from);
        const double height = skg_dot(normal, camera->parallel ? camera->first : from);
        for (int k = 0; k < 3; k++) {
            find_velocity(faces, velocities, vertices[k], at[k], t[k], relative);
            const double slope =
                factor * skg_dot(normal, relative) / (camera->parallel ? height : height * t[k]);
            slopes[3 * f + k] = isfinite(slope) ? slope : 0;
        }
    }
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
