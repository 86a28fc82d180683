/* The method is that of the kernel for the plane of the source (kernels/raster/source_plane.cl). A row of pixels and
 * the source span a plane, which cuts two edges of a triangle; a ray hits the triangle if it passes the two cuts
 * on different sides. Each cut is computed from the ends of its edge in one order, so that neighbouring
 * triangles agree and the signed hits of a closed mesh cancel. */
#include "geometry/retrace.h"

#include "core/maths.h"

#include <math.h>

/* A projected vertex: (x, y, w) is w times (column, row, 1), and t is the path parameter. A parallel beam has w
 * = 1. */
typedef struct {
    double x, y, w, t;
} seen;

typedef struct {
    const skg_camera *camera;
    const skg_pixel_list *pixels;
    double *paths;
    int turned;
} casting;

skg_status skg_pixel_list_make(int64_t columns, int64_t rows, int64_t first, int64_t end,
                               const int32_t *marks, skg_pixel_list *list) {
    skg_status status = SKG_OK;
    *list = (skg_pixel_list){0};
    for (int64_t k = first * columns; k < end * columns; k++) list->count += marks[k] != 0;
    SKG_TRY_CLEANUP(skg_alloc(rows + 1, sizeof *list->first, "bad pixels", &list->first));
    SKG_TRY_CLEANUP(skg_alloc(list->count, sizeof *list->columns, "bad pixels", &list->columns));
    for (int64_t r = 0, k = 0; r < rows; r++) {
        for (int64_t c = 0; c < columns && r >= first && r < end; c++)
            if (marks[r * columns + c]) list->columns[k++] = (int32_t)c;
        list->first[r + 1] = k;
    }
    return SKG_OK;
cleanup:
    skg_pixel_list_release(list);
    return status;
}

void skg_pixel_list_release(skg_pixel_list *list) {
    skg_free(&list->first);
    skg_free(&list->columns);
}

static seen see(const skg_camera *camera, const double *pose, const double at[3]) {
    double world[3], h[3];
    skg_pose_point(pose, at, world);
    skg_camera_see(camera, world, h);
    return camera->parallel ? (seen){h[0], h[1], 1, h[2] + 1} : (seen){h[0], h[1], h[2], h[2]};
}

/* Whether a vertex is far enough in front of the source to be divided by its w. */
static int in_front(double w) {
    return w > (double)SKG_NEAR;
}

/* The cut of the plane of row j with an edge whose ends are on both sides of it. */
static seen cut_edge(const seen *low, const seen *high, double j) {
    const double s = low->y - j * low->w, e = high->y - j * high->w;
    const double part = fmin(fmax(s / (s - e), 0), 1);
    return (seen){low->x + part * (high->x - low->x), 0, low->w + part * (high->w - low->w),
                  low->t + part * (high->t - low->t)};
}

/* The first pixel in the list from `first` to `end` that is at a column or to the right of it. */
static int64_t first_from(const int32_t *columns, int64_t first, int64_t end, double column) {
    while (first < end) {
        const int64_t middle = (first + end) / 2;
        if (columns[middle] < column)
            first = middle + 1;
        else
            end = middle;
    }
    return first;
}

static void cast_row(const casting *c, const seen *up, const seen *down, int64_t row) {
    const skg_camera *camera = c->camera;
    const int64_t end = c->pixels->first[row + 1];
    int64_t k = c->pixels->first[row];
    double last = HUGE_VAL;
    if (in_front(up->w) && in_front(down->w)) {
        const double a = up->x / up->w, b = down->x / down->w;
        k = first_from(c->pixels->columns, k, end, fmin(a, b) - 1);
        last = fmax(a, b) + 1;
    }
    for (; k < end && c->pixels->columns[k] <= last; k++) {
        const double i = c->pixels->columns[k], s = i * down->w - down->x, e = i * up->w - up->x;
        if ((s >= 0) == (e >= 0)) continue;
        const double part = fmin(fmax(s / (s - e), 0), 1), t = down->t + part * (up->t - down->t);
        const double start =
            camera->parallel ? camera->start[0] + camera->start[1] * i + camera->start[2] * (double)row : 0;
        const double path = fmin(fmax(t, start), 1);
        c->paths[k] += (s >= 0) == (c->turned == 0) ? path : -path;
    }
}

/* The rows between the lowest and the highest corner; all rows if a corner is not in front of the source. */
static void rows_of(const casting *c, const seen *const corner[3], int64_t *first, int64_t *end) {
    const int64_t rows = c->camera->rows;
    double low = HUGE_VAL, high = -HUGE_VAL;
    *first = 0;
    *end = rows;
    for (int k = 0; k < 3; k++) {
        if (!in_front(corner[k]->w)) return;
        low = fmin(low, corner[k]->y / corner[k]->w);
        high = fmax(high, corner[k]->y / corner[k]->w);
    }
    *first = low - 1 > 0 ? (low < (double)rows ? (int64_t)(low - 1) : rows) : 0;
    *end = high + 2 < (double)rows ? (high > -2 ? (int64_t)(high + 2) : 0) : rows;
}

static void cast_triangle(const casting *c, const seen *p0, const seen *p1, const seen *p2) {
    const seen *const corner[3] = {p0, p1, p2};
    int64_t row, end;
    rows_of(c, corner, &row, &end);
    for (; row < end; row++) {
        if (c->pixels->first[row] == c->pixels->first[row + 1]) continue;
        const double j = (double)row;
        int below[3];
        seen up = {0}, down = {0};
        for (int k = 0; k < 3; k++) below[k] = corner[k]->y - j * corner[k]->w <= 0;
        if (below[0] == below[1] && below[1] == below[2]) continue;
        for (int k = 0; k < 3; k++) {
            const int next = (k + 1) % 3;
            if (below[k] && !below[next]) up = cut_edge(corner[k], corner[next], j);
            if (!below[k] && below[next]) down = cut_edge(corner[next], corner[k], j);
        }
        cast_row(c, &up, &down, row);
    }
}

/* The mean of a loop, which is the hub of its cap. */
static seen see_middle(const skg_camera *camera, const skg_mesh *mesh, const skg_caps *caps, int64_t loop,
                       const double *pose) {
    const int64_t first = caps->first[loop], end = caps->first[loop + 1];
    double mean[3] = {0};
    for (int64_t k = first; k < end; k++) {
        double at[3];
        skg_mesh_vertex(mesh, caps->vertices[k], at);
        for (int a = 0; a < 3; a++) mean[a] += at[a] / (double)(end - first);
    }
    return see(camera, pose, mean);
}

static void cast_caps(const casting *c, const skg_mesh *mesh, const skg_caps *caps, const double *pose,
                      const seen *vertices) {
    for (int64_t l = 0; l < caps->loops; l++) {
        const int32_t *loop = caps->vertices + caps->first[l];
        const int64_t count = caps->first[l + 1] - caps->first[l];
        const seen apex = see_middle(c->camera, mesh, caps, l, pose);
        for (int64_t k = 0; k < count; k++)
            cast_triangle(c, &apex, &vertices[loop[(k + 1) % count]], &vertices[loop[k]]);
    }
}

skg_status skg_recast(const skg_camera *camera, const skg_mesh *mesh, const skg_caps *caps,
                      const double *pose, const skg_pixel_list *pixels, double *paths) {
    const double origin[3] = {0};
    skg_part_double part;
    seen *vertices = NULL;
    SKG_TRY(skg_alloc(mesh->vertices, sizeof *vertices, "repair", &vertices));
    for (int64_t v = 0; v < mesh->vertices; v++) {
        double at[3];
        skg_mesh_vertex(mesh, v, at);
        vertices[v] = see(camera, pose, at);
    }
    skg_camera_part(
        camera,
        &(skg_camera_place){.pose = pose, .origin = origin, .reference = 1, .flipped = mesh->orientation < 0},
        &part);
    const casting c = {camera, pixels, paths, part.turned != 0};
    for (int64_t k = 0; k < pixels->count; k++) paths[k] = 0;
    for (int64_t t = 0; t < mesh->triangles; t++) {
        const int32_t *corner = mesh->corners + 3 * t;
        cast_triangle(&c, &vertices[corner[0]], &vertices[corner[1]], &vertices[corner[2]]);
    }
    cast_caps(&c, mesh, caps, pose, vertices);
    skg_free(&vertices);
    return SKG_OK;
}

/* --- where caps are --- */

/* Pixels that are added around caps: more than the error of a device, so that a ray that a device may see pass a rim
 * counts as passing the hole. */
static const double MARGIN = 0.25;

/* Widens [low, high] by the columns of edge ab between two rows. */
static void widen(const seen *a, const seen *b, double from, double to, double *low, double *high) {
    const double ax = a->x / a->w, ay = a->y / a->w, dx = b->x / b->w - ax, dy = b->y / b->w - ay;
    double s = 0, e = 1;
    if (dy != 0) {
        s = fmax(fmin((from - ay) / dy, (to - ay) / dy), 0);
        e = fmin(fmax((from - ay) / dy, (to - ay) / dy), 1);
    } else if (ay < from || ay > to) {
        return;
    }
    if (s > e) return;
    *low = fmin(*low, fmin(ax + s * dx, ax + e * dx));
    *high = fmax(*high, fmax(ax + s * dx, ax + e * dx));
}

static void mark_triangle(const skg_camera *camera, const seen *const corner[3], int32_t *marks) {
    const double columns = (double)camera->columns, rows = (double)camera->rows;
    double top = HUGE_VAL, bottom = -HUGE_VAL;
    int ahead = 1;
    for (int k = 0; k < 3; k++) {
        ahead &= in_front(corner[k]->w);
        top = fmin(top, corner[k]->y / corner[k]->w);
        bottom = fmax(bottom, corner[k]->y / corner[k]->w);
    }
    const double first = ahead ? fmax(ceil(top - MARGIN), 0) : 0;
    const double last = ahead ? fmin(floor(bottom + MARGIN), rows - 1) : rows - 1;
    for (double row = first; row <= last; row++) {
        double low = ahead ? HUGE_VAL : 0, high = ahead ? -HUGE_VAL : columns;
        for (int k = 0; ahead && k < 3; k++)
            widen(corner[k], corner[(k + 1) % 3], row - MARGIN, row + MARGIN, &low, &high);
        const double end = fmin(floor(high + MARGIN), columns - 1);
        for (double column = fmax(ceil(low - MARGIN), 0); column <= end; column++)
            marks[(int64_t)row * camera->columns + (int64_t)column] = 1;
    }
}

void skg_recast_mark(const skg_camera *camera, const skg_mesh *mesh, const skg_caps *caps, const double *pose,
                     int32_t *marks) {
    for (int64_t l = 0; l < caps->loops; l++) {
        const int64_t first = caps->first[l], end = caps->first[l + 1];
        const seen apex = see_middle(camera, mesh, caps, l, pose);
        double at[3];
        skg_mesh_vertex(mesh, caps->vertices[end - 1], at);
        seen last = see(camera, pose, at);
        for (int64_t k = first; k < end; k++) {
            skg_mesh_vertex(mesh, caps->vertices[k], at);
            const seen next = see(camera, pose, at);
            mark_triangle(camera, (const seen *const[3]){&apex, &last, &next}, marks);
            last = next;
        }
    }
}
