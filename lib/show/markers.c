/* Source, beam, detector and axes as triangles. */
#include "show/drawing.h"

#include "core/maths.h"

#include <math.h>

enum { SIDES = 8 };

/* The corners of the detector one after the other, in widths and heights. */
static const int turn[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

/* Sizes in pixels at the centre of the picture. */
static const double BEAM_RADIUS = 0.7, FRAME_RADIUS = 1.1, AXIS_RADIUS = 1.6, SOURCE_RADIUS = 7,
                    POINT_RADIUS = 2.2;

#define BEAM_COLOUR SKG_SHOW_COLOUR(236, 158, 30, 255)

/* Luminance of the background, 0 to 255, below which frames and paths are light. */
static const double DARK = 110;

static int is_dark(const skg_look *look) {
    const uint8_t *ground = look->background;
    return ground && 0.3 * ground[0] + 0.6 * ground[1] + 0.1 * ground[2] < DARK;
}

static uint32_t frame_colour(const skg_look *look) {
    return is_dark(look) ? SKG_SHOW_COLOUR(156, 162, 172, 255) : SKG_SHOW_COLOUR(70, 74, 82, 255);
}

static uint32_t path_colour(const skg_look *look) {
    return is_dark(look) ? SKG_SHOW_COLOUR(176, 136, 240, 255) : SKG_SHOW_COLOUR(120, 70, 190, 255);
}

/* Two directions of length 1 across a third one. */
static void frame_of(const double along[3], double u[3], double v[3]) {
    int least = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(along[k]) < fabs(along[least])) least = k;
    const double axis[3] = {least == 0, least == 1, least == 2};
    skg_cross(along, axis, u);
    skg_scale_vector(1 / skg_length(u), u, u);
    skg_cross(along, u, v);
}

/* A tube, or a cone if the radius at its end is 0. */
static skg_status add_tube(skg_show_model *model, const double from[3], const double to[3], double radius,
                           double end_radius, uint32_t colour) {
    double along[3], u[3], v[3], ring[SIDES][3];
    const int64_t first = model->vertices;
    skg_add_scaled(to, -1, from, along);
    if (skg_length(along) == 0) return SKG_OK;
    SKG_TRY(skg_show_model_reserve(model, 2 * SIDES, 2 * SIDES));
    skg_scale_vector(1 / skg_length(along), along, along);
    frame_of(along, u, v);
    for (int i = 0; i < SIDES; i++) {
        const double angle = 2 * SKG_PI * i / SIDES;
        double at[3];
        for (int k = 0; k < 3; k++) ring[i][k] = cos(angle) * u[k] + sin(angle) * v[k];
        skg_add_scaled(from, radius, ring[i], at);
        skg_show_model_add_vertex(model, at);
        skg_add_scaled(to, end_radius, ring[i], at);
        skg_show_model_add_vertex(model, at);
    }
    for (int i = 0; i < SIDES; i++) {
        const int next = (i + 1) % SIDES;
        const int64_t a = first + 2 * i, b = first + 2 * next;
        double lower[3][3], upper[3][3];
        for (int k = 0; k < 3; k++) {
            lower[0][k] = lower[1][k] = upper[0][k] = ring[i][k];
            lower[2][k] = upper[1][k] = upper[2][k] = ring[next][k];
        }
        skg_show_model_add_triangle(model, (const int64_t[3]){a, a + 1, b}, lower, colour);
        skg_show_model_add_triangle(model, (const int64_t[3]){a + 1, b + 1, b}, upper, colour);
    }
    return SKG_OK;
}

/* A line of some pixels in radius, from the first point in front of the eye on. */
static skg_status add_line(skg_show_model *model, const skg_show_camera *camera, const double from[3],
                           const double to[3], double radius, double end_radius, uint32_t colour) {
    const double *ends[2] = {from, to},
                 depths[2] = {skg_show_camera_depth(camera, from), skg_show_camera_depth(camera, to)};
    double cut[2][3];
    for (int k = 0; k < 2; k++) {
        if (depths[k] >= camera->nearest) continue;
        if (depths[1 - k] <= camera->nearest) return SKG_OK;
        const double share = (camera->nearest - depths[k]) / (depths[1 - k] - depths[k]);
        double along[3];
        skg_add_scaled(ends[1 - k], -1, ends[k], along);
        skg_add_scaled(ends[k], share, along, cut[k]);
    }
    for (int k = 0; k < 2; k++)
        if (depths[k] < camera->nearest) ends[k] = cut[k];
    return add_tube(model, ends[0], ends[1], radius * skg_show_camera_pixel(camera, ends[0]),
                    end_radius * skg_show_camera_pixel(camera, ends[1]), colour);
}

/* A ball of rings and meridians. */
static skg_status add_ball(skg_show_model *model, const skg_show_camera *camera, const double centre[3],
                           double pixels, uint32_t colour) {
    enum { RINGS = 6, TURN = 12 };
    const double radius = pixels * skg_show_camera_pixel(camera, centre);
    const int64_t first = model->vertices;
    double normals[RINGS + 1][TURN][3];
    SKG_TRY(skg_show_model_reserve(model, (RINGS + 1) * TURN, 2 * RINGS * TURN));
    for (int i = 0; i <= RINGS; i++)
        for (int j = 0; j < TURN; j++) {
            const double polar = SKG_PI * i / RINGS, around = 2 * SKG_PI * j / TURN;
            double *n = normals[i][j], at[3];
            n[0] = sin(polar) * cos(around), n[1] = sin(polar) * sin(around), n[2] = cos(polar);
            skg_add_scaled(centre, radius, n, at);
            skg_show_model_add_vertex(model, at);
        }
    for (int i = 0; i < RINGS; i++)
        for (int j = 0; j < TURN; j++) {
            const int next = (j + 1) % TURN,
                      of[2][3][2] = {{{i, j}, {i + 1, j}, {i + 1, next}}, {{i, j}, {i + 1, next}, {i, next}}};
            for (int t = 0; t < 2; t++) {
                int64_t corners[3];
                double at[3][3];
                for (int k = 0; k < 3; k++) {
                    corners[k] = first + of[t][k][0] * TURN + of[t][k][1];
                    memcpy(at[k], normals[of[t][k][0]][of[t][k][1]], sizeof at[k]);
                }
                skg_show_model_add_triangle(model, corners, at, colour);
            }
        }
    return SKG_OK;
}

/* The opening of the jaws. */
static skg_status add_jaws(skg_show_model *model, const skg_view *view, const skg_look *look,
                           const skg_show_camera *camera) {
    double opening[4][3];
    if (!look->collimation || look->collimation->kind != SKG_COLLIMATION_RECTANGLE) return SKG_OK;
    SKG_TRY(skg_collimation_corners_get(look->collimation, view, 1, opening[0]));
    for (int i = 0; i < 4; i++)
        SKG_TRY(add_line(model, camera, opening[i], opening[(i + 1) % 4], FRAME_RADIUS, FRAME_RADIUS,
                         frame_colour(look)));
    return SKG_OK;
}

static skg_status add_beam(skg_show_model *model, const skg_view *view, const skg_look *look,
                           const skg_show_camera *camera, const double low[3], const double high[3]) {
    double corners[4][3], start[3], next_start[3];
    SKG_TRY(skg_show_beam_corners(view, look, corners));
    for (int i = 0; i < 4; i++) {
        skg_show_beam_start(view, low, high, corners[i], start);
        SKG_TRY(add_line(model, camera, start, corners[i], BEAM_RADIUS, BEAM_RADIUS, BEAM_COLOUR));
        if (view->projection == SKG_PROJECTION_POINT) continue;
        skg_show_beam_start(view, low, high, corners[(i + 1) % 4],
                            next_start); /* on the plane where rays start */
        SKG_TRY(add_line(model, camera, start, next_start, BEAM_RADIUS, BEAM_RADIUS, BEAM_COLOUR));
    }
    SKG_TRY(add_jaws(model, view, look, camera));
    skg_show_beam_start(view, low, high, view->centre, start);
    return add_ball(model, camera, start, SOURCE_RADIUS, BEAM_COLOUR);
}

static skg_status add_axes(skg_show_model *model, const skg_show_camera *camera, const double low[3],
                           const double high[3]) {
    static const uint32_t colours[3] = {SKG_SHOW_COLOUR(208, 52, 44, 255), SKG_SHOW_COLOUR(46, 150, 60, 255),
                                        SKG_SHOW_COLOUR(44, 92, 210, 255)};
    const double length = fmax(high[0] - low[0], fmax(high[1] - low[1], high[2] - low[2])) * 0.2;
    for (int k = 0; k < 3; k++) {
        const double along[3] = {k == 0, k == 1, k == 2};
        double neck[3], tip[3];
        skg_add_scaled(low, 0.8 * length, along, neck);
        skg_add_scaled(low, length, along, tip);
        SKG_TRY(add_line(model, camera, low, neck, AXIS_RADIUS, AXIS_RADIUS, colours[k]));
        SKG_TRY(add_line(model, camera, neck, tip, 3 * AXIS_RADIUS, 0, colours[k]));
    }
    return SKG_OK;
}

static skg_status add_path(skg_show_model *model, const skg_look *look, const skg_show_camera *camera) {
    for (int64_t i = 0; i < look->path_count; i++) {
        const double *at = look->path + 3 * i;
        SKG_TRY(add_ball(model, camera, at, POINT_RADIUS, path_colour(look)));
        if (i > 0) SKG_TRY(add_line(model, camera, at - 3, at, BEAM_RADIUS, BEAM_RADIUS, path_colour(look)));
    }
    return SKG_OK;
}

/* How many flat strips a detector is drawn as, side by side. */
static int strips_of(const skg_view *view) {
    enum { STRIPS = 24 };
    return view->radius > 0 ? STRIPS : 1;
}

/* The frame of the detector: each side in turn, those along rows from strip to strip. */
static skg_status add_frame(skg_show_model *model, const skg_view *view, const skg_look *look,
                            const skg_show_camera *camera) {
    const int strips = strips_of(view);
    for (int i = 0; i < 4; i++)
        for (int s = 0; s < (i % 2 ? 1 : strips); s++) {
            const int *from = turn[i], *to = turn[(i + 1) % 4];
            const double first = (double)s / strips, last = i % 2 ? 1 : (double)(s + 1) / strips;
            double ends[2][3];
            skg_show_detector_place(view, from[0] + first * (to[0] - from[0]),
                                    from[1] + first * (to[1] - from[1]), ends[0]);
            skg_show_detector_place(view, from[0] + last * (to[0] - from[0]),
                                    from[1] + last * (to[1] - from[1]), ends[1]);
            SKG_TRY(
                add_line(model, camera, ends[0], ends[1], FRAME_RADIUS, FRAME_RADIUS, frame_colour(look)));
        }
    return SKG_OK;
}

/* Adds the area of the detector: (0, 0), (1, 0), (1, 1) and (0, 0), (1, 1), (0, 1) in widths and heights. */
static skg_status add_detector(skg_show_model *model, const skg_view *view, const skg_show_camera *camera) {
    const int64_t before = model->triangles;
    const int strips = strips_of(view);
    SKG_TRY(skg_show_model_reserve(model, 4 * strips, 2 * strips));
    for (int s = 0; s < strips; s++) {
        const int64_t first = model->vertices;
        double at[4][2], corner[3];
        for (int i = 0; i < 4; i++) {
            at[i][0] = (double)(s + turn[i][0]) / strips, at[i][1] = turn[i][1];
            skg_show_detector_place(view, at[i][0], at[i][1], corner);
            skg_show_model_add_vertex(model, corner);
        }
        for (int t = 0; t < 2; t++) {
            double places[3][2];
            for (int k = 0; k < 6; k++) places[k / 2][k % 2] = at[k / 2 > 0 ? k / 2 + t : 0][k % 2];
            skg_show_model_add_image(model, (const int64_t[3]){first, first + t + 1, first + t + 2}, places);
        }
    }
    SKG_TRY(skg_show_clip_near(model, camera, before));
    model->images = model->triangles - before;
    return SKG_OK;
}

skg_status skg_show_markers_add(skg_show_model *model, const skg_view *view, const skg_look *look,
                                const skg_show_camera *camera, const double low[3], const double high[3]) {
    const int64_t first = model->triangles;
    SKG_TRY(add_beam(model, view, look, camera, low, high));
    SKG_TRY(add_axes(model, camera, low, high));
    SKG_TRY(add_path(model, look, camera));
    SKG_TRY(add_frame(model, view, look, camera));
    SKG_TRY(skg_show_clip_near(model, camera, first));
    return add_detector(model, view, camera);
}
