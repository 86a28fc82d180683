/* Filtered backprojection of cone beams. */
#include "core/core.h"
#include "core/files.h"
#include "core/log.h"
#include "core/maths.h"
#include "core/text.h"
#include "core/threads.h"
#include "image/image.h"
#include "reconstruct/fourier.h"
#include "reconstruct/orbit.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* FITTED: columns at an edge that the continuation of a row is fitted to. */
enum { VOXELS_MAX = 4096, FITTED = 16 };

struct skg_fdk {
    skg_scan *scan;
    skg_fdk_options options;
    skg_orbit orbit;
    skg_row_filter filter;
    int64_t columns, rows, projections, fine;
    int64_t pad[2];    /* columns that are added before the first and behind the last one */
    int64_t added;     /* projections */
    int64_t truncated; /* rows of them */
    float *image;      /* [rows][fine], weighted and filtered */
    float *volume;     /* [z][y][x], 1/cm */
};

void skg_fdk_options_init_sized(void *options, int32_t size) {
    const skg_fdk_options defaults = {.axis = {0, 0, 1}, .voxels = {128, 128, 128}, .voxel_mm = 1};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

static skg_status check_options(const skg_fdk_options *o) {
    if (o->filter != SKG_FDK_FILTER_RAMP && o->filter != SKG_FDK_FILTER_HANN)
        return skg_fail(SKG_ERR_ARGUMENT, "reconstruction: filter %" PRId32 " is no SKG_FDK_FILTER_ value",
                        o->filter);
    for (int k = 0; k < 3; k++)
        if (o->voxels[k] < 1 || o->voxels[k] > VOXELS_MAX)
            return skg_fail(SKG_ERR_ARGUMENT, "reconstruction: %" PRId64 " voxels along %c; give 1 to %d",
                            o->voxels[k], "xyz"[k], VOXELS_MAX);
    if (o->truncation != SKG_FDK_TRUNCATION_NONE && o->truncation != SKG_FDK_TRUNCATION_EXTRAPOLATE)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "reconstruction: truncation %" PRId32 " is no SKG_FDK_TRUNCATION_ value",
                        o->truncation);
    if (!(o->voxel_mm > 0) || isinf(o->voxel_mm))
        return skg_fail(SKG_ERR_ARGUMENT, "reconstruction: voxels of %g mm", o->voxel_mm);
    if (!skg_all_finite(o->axis, 3) || !(skg_length(o->axis) > 0) || !skg_all_finite(o->centre, 3) ||
        !skg_all_finite(o->middle, 3))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "reconstruction: axis, centre or middle is not finite, or the axis has no "
                        "length");
    return SKG_OK;
}

/* Whether column 0 is on the side of the near edge of a displaced detector. */
static int near_is_first(const skg_fdk *fdk, const skg_orbit_pose *pose) {
    return fdk->orbit.displaced * skg_orbit_place(pose, fdk->rows / 2, 0) < 0;
}

/* Columns that are added to each row. A filtered row goes on where the detector ends: a displaced detector is made symmetrical, for
 * voxels are seen there, too. Rows that are continued may become three times as long. */
static skg_status find_padding(skg_fdk *fdk) {
    const skg_orbit *orbit = &fdk->orbit;
    skg_orbit_pose pose = {0};
    SKG_TRY(skg_orbit_pose_get(fdk->scan, &fdk->options, orbit, 0, &pose));
    const int64_t more = fdk->options.truncation == SKG_FDK_TRUNCATION_EXTRAPOLATE ? fdk->columns : 0;
    fdk->pad[0] = fdk->pad[1] = more;
    if (!orbit->displaced) return SKG_OK;
    const double wide = fmax(-orbit->low, orbit->high);
    const int first = near_is_first(fdk, &pose), step = first ? -1 : 1;
    int64_t column = first ? 0 : fdk->columns - 1, *pad = &fdk->pad[first ? 0 : 1];
    for (*pad = 0; *pad < 4 * fdk->columns && fabs(skg_orbit_place(&pose, fdk->rows / 2, column)) < wide;
         ++*pad)
        column += step;
    *pad += more;
    return SKG_OK;
}

static skg_status prepare(skg_fdk *fdk) {
    skg_view view;
    skg_view_init(&view);
    SKG_TRY(skg_orbit_find(fdk->scan, &fdk->options, &fdk->orbit));
    SKG_TRY(skg_scan_view_get(fdk->scan, 0, &view));
    SKG_TRY(skg_scan_projection_count(fdk->scan, &fdk->projections));
    fdk->columns = view.columns;
    fdk->rows = view.rows;
    const int64_t *n = fdk->options.voxels;
    SKG_TRY(find_padding(fdk));
    const int64_t padded = fdk->pad[0] + view.columns + fdk->pad[1];
    SKG_TRY(skg_row_filter_create(padded, fdk->options.filter == SKG_FDK_FILTER_HANN, &fdk->filter));
    fdk->fine = skg_row_fine(&fdk->filter, padded);
    SKG_TRY(skg_alloc(fdk->fine * view.rows, sizeof(float), "projection", &fdk->image));
    return skg_alloc(n[0] * n[1] * n[2], sizeof(float), "volume", &fdk->volume);
}

skg_status skg_fdk_create(skg_scan *scan, const skg_fdk_options *options, skg_fdk **result) {
    SKG_PLAIN;
    skg_fdk *fdk = NULL;
    skg_fdk_options ours;
    SKG_NEEDS(result);
    *result = NULL;
    SKG_NEEDS(scan);
    skg_fdk_options_init(&ours);
    if (options) SKG_TRY(skg_struct_read(options, "skg_fdk_options", &ours, sizeof ours));
    SKG_TRY(check_options(&ours));
    SKG_TRY(skg_alloc(1, sizeof *fdk, "reconstruction", &fdk));
    skg_scan_retain(scan);
    fdk->scan = scan;
    fdk->options = ours;
    skg_progress_keep(ours.progress);
    const skg_status status = prepare(fdk);
    if (status != SKG_OK)
        skg_fdk_release(&fdk);
    else
        *result = fdk;
    return status;
}

void skg_fdk_release(skg_fdk **fdk) {
    if (!fdk || !*fdk) return;
    skg_scan_release(&(*fdk)->scan);
    skg_row_filter_free(&(*fdk)->filter);
    skg_free(&(*fdk)->image);
    skg_free(&(*fdk)->volume);
    skg_progress_release(&(*fdk)->options.progress);
    skg_free(fdk);
}

/* How a row goes on beyond an edge. The square of a projection of an ellipse, over that of the cosine of the ray in the fan, is a
 * parabola along the row: it is fitted to the outermost columns, and followed to where it ends. */
typedef struct {
    int is_cut, is_ellipse;
    double parabola[3]; /* of the columns beyond the edge */
} continuation;

/* Fits a parabola to `count` values at 0, -1, -2, ... by least squares: sums of powers, and Cramer's rule. */
static void fit_parabola(const double *values, int64_t count, double parabola[3]) {
    double m[5] = {0}, v[3] = {0};
    for (int64_t k = 0; k < count; k++) {
        double power = 1;
        for (int i = 0; i < 5; i++, power *= -(double)k) {
            m[i] += power;
            if (i < 3) v[i] += power * values[k];
        }
    }
    const double rows[3][3] = {{m[0], m[1], m[2]}, {m[1], m[2], m[3]}, {m[2], m[3], m[4]}};
    double cofactors[3];
    skg_cross(rows[1], rows[2], cofactors);
    const double whole = skg_dot(rows[0], cofactors);
    for (int i = 0; i < 3; i++) {
        double columns[3][3];
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) columns[r][c] = c == i ? v[r] : rows[r][c];
        skg_cross(columns[1], columns[2], cofactors);
        parabola[i] = skg_dot(columns[0], cofactors) / whole;
    }
}

/* most: columns up to which the parabola has to end. cosines: of the outermost columns */
static void find_continuation(const float *edge, int64_t next, const double *cosines, int64_t count,
                              int64_t most, continuation *on) {
    double squares[FITTED];
    for (int64_t k = 0; k < count; k++) {
        const double value = (double)edge[k * next] / cosines[k];
        squares[k] = value * value;
    }
    fit_parabola(squares, count, on->parabola);
    const double *q = on->parabola;
    const double inside = q[1] * q[1] - 4 * q[2] * q[0];
    on->is_ellipse = count > 3 && q[2] < 0 && q[0] > 0 && (q[1] + sqrt(inside)) / (-2 * q[2]) <= (double)most;
}

/* The value `steps` columns beyond an edge: of an ellipse, otherwise the mirror image about the edge, which ends at 0, under a cosine
 * that does so at the last column. next: from one column to the next, into the detector. */
static double beyond(const continuation *on, const float *edge, int64_t next, int64_t steps, int64_t columns,
                     int64_t most, double cosine) {
    const double x = (double)steps, *q = on->parabola;
    if (on->is_ellipse) {
        const double square = q[0] + x * (q[1] + x * q[2]);
        const int is_behind = 2 * q[2] * x + q[1] > 0; /* the parabola rises: its top lies beyond the edge */
        return square > 0 || is_behind ? cosine * sqrt(fmax(square, 0)) : 0;
    }
    if (most == 0 || steps >= columns) return 0;
    for (int64_t k = 1; k < steps; k++)
        if ((double)edge[k * next] >= 2 * (double)edge[0]) return 0;
    const double mirrored = 2 * (double)edge[0] - (double)edge[steps * next];
    const double share = cos(0.5 * SKG_PI * x / (double)(most + 1));
    return mirrored > 0 ? mirrored * share * share : 0;
}

/* Whether a row is cut off: the mean of the outermost columns is above a share of the largest value. */
static int is_cut(const float *edge, int64_t next, int64_t columns, double largest) {
    enum { MEAN_OF = 4 };
    static const double SHARE = 0.05;
    const int64_t count = columns < MEAN_OF ? columns : MEAN_OF;
    double sum = 0;
    for (int64_t k = 0; k < count; k++) sum += (double)edge[k * next];
    return sum > SHARE * largest * (double)count;
}

/* What holds for all rows of a projection. */
typedef struct {
    const skg_orbit_pose *pose;
    const float *image;
    double largest;
    int open[2]; /* 1: this side has to show air, and is continued if it does not */
} projection;

static double cosine_of(const skg_orbit_pose *pose, int64_t row, int64_t column, double *ray) {
    skg_orbit_ray(pose, row, column, ray);
    return skg_dot(ray, pose->forward) / skg_length(ray);
}

/* How a row goes on beyond its first (side 0) or last column. */
static continuation look_beyond(const skg_fdk *fdk, const projection *p, int64_t row, int side) {
    continuation on = {0};
    double cosines[FITTED], ray[3];
    const int64_t next = side ? -1 : 1, first = side ? fdk->columns - 1 : 0;
    const int64_t count = fdk->columns / 4 < FITTED ? fdk->columns / 4 : FITTED;
    const float *edge = p->image + row * fdk->columns + first;
    on.is_cut = p->open[side] && is_cut(edge, next, fdk->columns, p->largest);
    if (!on.is_cut || fdk->options.truncation != SKG_FDK_TRUNCATION_EXTRAPOLATE) return on;
    for (int64_t k = 0; k < count; k++) cosines[k] = cosine_of(p->pose, row, first + k * next, ray);
    find_continuation(edge, next, cosines, count, fdk->pad[side], &on);
    return on;
}

/* Weights each ray by its share and by the cosine of its angle with the plane across the axis, then filters the row. Returns whether
 * it is cut off. */
static int filter_row(skg_fdk *fdk, const projection *p, int64_t row, double *work) {
    double *weighted = work + 2 * (fdk->filter.fine + fdk->filter.length);
    const float *values = p->image + row * fdk->columns;
    const int64_t last = fdk->columns - 1, padded = fdk->pad[0] + fdk->columns + fdk->pad[1];
    const int goes_on = fdk->options.truncation == SKG_FDK_TRUNCATION_EXTRAPOLATE;
    const continuation on[2] = {look_beyond(fdk, p, row, 0), look_beyond(fdk, p, row, 1)};
    for (int64_t c = 0; c < padded; c++) {
        const int64_t column = c - fdk->pad[0];
        const int side = column > last, is_inside = column >= 0 && column <= last;
        double ray[3];
        weighted[c] = 0;
        if (!is_inside && !(goes_on && on[side].is_cut)) continue;
        const double cosine = cosine_of(p->pose, row, column, ray);
        const double place = fdk->orbit.displaced ? skg_orbit_place(p->pose, row, column) : 0;
        const double value =
            is_inside ? (double)values[column]
            : side    ? beyond(&on[1], values + last, -1, column - last, fdk->columns, fdk->pad[1], cosine)
                      : beyond(&on[0], values, 1, -column, fdk->columns, fdk->pad[0], cosine);
        weighted[c] = value * cosine * skg_orbit_weight(&fdk->orbit, p->pose, ray, place);
    }
    skg_row_filter_apply(&fdk->filter, padded, weighted, work, fdk->image + row * fdk->fine);
    return on[0].is_cut || on[1].is_cut;
}

static void look_at(const skg_fdk *fdk, const skg_orbit_pose *pose, const float *image, projection *p) {
    *p = (projection){.pose = pose, .image = image, .open = {1, 1}};
    if (fdk->orbit.displaced) p->open[near_is_first(fdk, pose) ? 0 : 1] = 0;
    for (int64_t i = 0; i < fdk->rows * fdk->columns; i++) p->largest = fmax(p->largest, (double)image[i]);
}

static skg_status filter_image(skg_fdk *fdk, const skg_orbit_pose *pose, const float *image) {
    int failed = 0;
    int64_t truncated = 0;
    projection p;
    look_at(fdk, pose, image, &p);
#pragma omp parallel reduction(| : failed) reduction(+ : truncated)
    {
        double *work = NULL;
        failed =
            skg_alloc(2 * (fdk->filter.fine + fdk->filter.length) + fdk->pad[0] + fdk->columns + fdk->pad[1],
                      sizeof *work, "filter", &work) != SKG_OK;
#pragma omp for schedule(static)
        for (int64_t row = 0; row < fdk->rows; row++)
            if (!failed) truncated += filter_row(fdk, &p, row, work);
        skg_free(&work);
    }
    if (!failed) fdk->truncated += truncated;
    return failed ? skg_fail(SKG_ERR_MEMORY, "reconstruction: no memory for the filter") : SKG_OK;
}

/* Column, row and 1 of the pixel that a point is seen in, times w, as affine functions of the point; and the point's
 * distance from the source along `forward` as well. */
typedef struct {
    double column[4], row[4], w[4], depth[4];
} pixel_map;

static void affine(const double *direction, double factor, const double *from, double add, double *function) {
    skg_scale_vector(factor, direction, function);
    function[3] = add - factor * skg_dot(direction, from);
}

static void find_map(const skg_orbit_pose *pose, pixel_map *map) {
    const skg_view *v = &pose->view;
    double normal[3], dual[2][3], across[3], from[3];
    skg_cross(v->column_step, v->row_step, normal);
    skg_cross(v->row_step, normal, across);
    skg_scale_vector(1 / skg_dot(v->column_step, across), across, dual[0]);
    skg_cross(normal, v->column_step, across);
    skg_scale_vector(1 / skg_dot(v->row_step, across), across, dual[1]);
    const double middle[2] = {0.5 * (double)(v->columns - 1), 0.5 * (double)(v->rows - 1)};
    double *pixel[2] = {map->column, map->row};
    if (pose->is_parallel) { /* the point slides along the beam to the detector's plane */
        const double along = skg_dot(normal, pose->forward);
        for (int k = 0; k < 2; k++) {
            skg_add_scaled(dual[k], -skg_dot(dual[k], pose->forward) / along, normal, across);
            affine(across, 1, v->centre, middle[k], pixel[k]);
        }
        memset(map->w, 0, sizeof map->w);
        memset(map->depth, 0, sizeof map->depth);
        map->w[3] = 1;
        map->depth[3] = 1;
        return;
    }
    skg_add_scaled(v->centre, -1, v->source, from);
    const double distance = skg_dot(normal, from);
    affine(normal, 1 / distance, v->source, 0, map->w);
    affine(pose->forward, 1 / pose->radius, v->source, 0, map->depth);
    for (int k = 0; k < 2; k++) { /* (x - source) dual / w + (source - centre) dual + middle, times w */
        const double shift = middle[k] - skg_dot(dual[k], from);
        affine(dual[k], 1, v->source, 0, pixel[k]);
        for (int i = 0; i < 4; i++) pixel[k][i] += shift * map->w[i];
    }
}

/* The filtered image between pixels; 0 beyond its edge. */
static double image_at(const skg_fdk *fdk, double column, double row) {
    const double fine = (double)fdk->filter.finer * (column + (double)fdk->pad[0]), c = floor(fine),
                 r = floor(row);
    if (!(c >= 0 && r >= 0 && c < (double)(fdk->fine - 1) && r < (double)(fdk->rows - 1))) return 0;
    const float *at = fdk->image + (int64_t)r * fdk->fine + (int64_t)c;
    const double u = fine - c, v = row - r;
    return (1 - v) * ((1 - u) * (double)at[0] + u * (double)at[1]) +
           v * ((1 - u) * (double)at[fdk->fine] + u * (double)at[fdk->fine + 1]);
}

/* Coordinate of a voxel. */
static double place_of(const skg_fdk_options *o, int k, int64_t index) {
    return o->middle[k] + ((double)index - 0.5 * (double)(o->voxels[k] - 1)) * o->voxel_mm;
}

static double at_point(const double *function, const double *point) {
    return skg_dot(function, point) + function[3];
}

static void back_project_line(skg_fdk *fdk, const pixel_map *map, double scale, int64_t y, int64_t z) {
    const skg_fdk_options *o = &fdk->options;
    const double start[3] = {place_of(o, 0, 0), place_of(o, 1, y), place_of(o, 2, z)};
    const double column = at_point(map->column, start), row = at_point(map->row, start);
    const double w = at_point(map->w, start), depth = at_point(map->depth, start);
    float *to = fdk->volume + (z * o->voxels[1] + y) * o->voxels[0];
    for (int64_t x = 0; x < o->voxels[0]; x++) {
        const double along = (double)x * o->voxel_mm, near = w + along * map->w[0],
                     far = depth + along * map->depth[0];
        if (!(near > 0)) continue;
        const double value =
            image_at(fdk, (column + along * map->column[0]) / near, (row + along * map->row[0]) / near);
        to[x] += (float)(scale * value / (far * far));
    }
}

skg_status skg_fdk_add(skg_fdk *fdk, int64_t index, const float *image) {
    SKG_PLAIN;
    enum { MM_PER_CM = 10 };
    skg_orbit_pose pose = {0};
    pixel_map map;
    SKG_NEEDS(fdk);
    SKG_NEEDS(image);
    SKG_TRY(skg_openmp_enter());
    SKG_TRY(skg_progress_step(fdk->options.progress, fdk->added, fdk->projections));
    SKG_TRY(skg_orbit_pose_get(fdk->scan, &fdk->options, &fdk->orbit, index, &pose));
    SKG_TRY(filter_image(fdk, &pose, image));
    find_map(&pose, &map);
    const double scale = MM_PER_CM * fdk->orbit.step / pose.spacing;
    const int64_t lines = fdk->options.voxels[1] * fdk->options.voxels[2];
#pragma omp parallel for schedule(static)
    for (int64_t line = 0; line < lines; line++)
        back_project_line(fdk, &map, scale, line % fdk->options.voxels[1], line / fdk->options.voxels[1]);
    if (++fdk->added == fdk->projections)
        (void)skg_progress_step(fdk->options.progress, fdk->added, fdk->projections);
    return SKG_OK;
}

void skg_fdk_report_init_sized(void *report, int32_t size) {
    const skg_fdk_report defaults = {0};
    skg_struct_init(report, size, &defaults, sizeof defaults);
}

skg_status skg_fdk_report_get(const skg_fdk *fdk, skg_fdk_report *report) {
    SKG_NEEDS(fdk);
    SKG_NEEDS(report);
    const skg_orbit *orbit = &fdk->orbit;
    skg_orbit_pose pose = {0};
    SKG_TRY(skg_orbit_pose_get(fdk->scan, &fdk->options, orbit, 0, &pose));
    const double least = fmin(-orbit->low, orbit->high), most = fmax(-orbit->low, orbit->high);
    const double rows = (double)fdk->rows * (double)fdk->added;
    const skg_fdk_report ours = {.displaced = orbit->displaced != 0,
                                 .covered_mm = skg_orbit_radius(&pose, orbit->displaced ? most : least),
                                 .overlap_mm = skg_orbit_radius(&pose, least),
                                 .truncated = rows > 0 ? (double)fdk->truncated / rows : 0};
    return skg_struct_write(&ours, sizeof ours, "skg_fdk_report", report);
}

skg_status skg_fdk_volume_get(const skg_fdk *fdk, const float **volume) {
    SKG_NEEDS(fdk);
    SKG_NEEDS(volume);
    *volume = fdk->volume;
    return SKG_OK;
}

skg_status skg_fdk_save(const skg_fdk *fdk, const char *path) {
    SKG_PLAIN;
    skg_output_file file;
    SKG_NEEDS(fdk);
    SKG_NEEDS(path);
    const skg_fdk_options *o = &fdk->options;
    const char *dot = strrchr(path, '.');
    if (!dot || !skg_same_name(dot, ".mha"))
        return skg_fail(SKG_ERR_ARGUMENT, "%s: a volume is written to a .mha", path);
    const double first[3] = {place_of(o, 0, 0), place_of(o, 1, 0), place_of(o, 2, 0)};
    const double spacing[3] = {o->voxel_mm, o->voxel_mm, o->voxel_mm};
    char offset[96], steps[96];
    skg_picture_numbers(first, 3, offset, sizeof offset);
    skg_picture_numbers(spacing, 3, steps, sizeof steps);
    SKG_TRY(skg_output_open(path, &file));
    fprintf(
        file.stream,
        "ObjectType = Image\nNDims = 3\nComment = attenuation coefficient (1/cm), skiagraph\nBinaryData = True\n"
        "BinaryDataByteOrderMSB = %s\nCompressedData = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = %s\n"
        "CenterOfRotation = 0 0 0\nElementSpacing = %s\nDimSize = %" PRId64 " %" PRId64 " %" PRId64
        "\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n",
        skg_host_is_big_endian() ? "True" : "False", offset, steps, o->voxels[0], o->voxels[1], o->voxels[2]);
    fwrite(fdk->volume, sizeof *fdk->volume, (size_t)(o->voxels[0] * o->voxels[1] * o->voxels[2]),
           file.stream);
    return skg_output_commit(&file); /* finds failures to write */
}
