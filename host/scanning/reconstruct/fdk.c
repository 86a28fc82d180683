/* Filtered backprojection of cone beams. */
#include "core/core.h"
#include "core/files.h"
#include "core/log.h"
#include "core/maths.h"
#include "core/text.h"
#include "image/image.h"
#include "reconstruct/reconstruction.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { VOXELS_MAX = 4096 };

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
    const int first = skg_fdk_near_is_first(fdk, &pose), step = first ? -1 : 1;
    int64_t column = first ? 0 : fdk->columns - 1, *pad = &fdk->pad[first ? 0 : 1];
    for (*pad = 0; *pad < 4 * fdk->columns && fabs(skg_orbit_place(&pose, fdk->rows / 2, column)) < wide;
         ++*pad)
        column += step;
    *pad += more;
    return SKG_OK;
}

static skg_status prepare(skg_fdk *fdk) {
    skg_view view;
    skg_orbit_pose pose = {0};
    skg_view_init(&view);
    SKG_TRY(skg_orbit_find(fdk->scan, &fdk->options, &fdk->orbit));
    SKG_TRY(skg_scan_view_get(fdk->scan, 0, &view));
    SKG_TRY(skg_scan_projection_count(fdk->scan, &fdk->projections));
    fdk->columns = view.columns;
    fdk->rows = view.rows;
    const int64_t *n = fdk->options.voxels;
    SKG_TRY(find_padding(fdk));
    const int64_t padded = fdk->pad[0] + view.columns + fdk->pad[1];
    SKG_TRY(skg_orbit_pose_get(fdk->scan, &fdk->options, &fdk->orbit, 0, &pose));
    if (pose.fan_step > 0 && fdk->options.truncation != SKG_FDK_TRUNCATION_NONE)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "reconstruction: rows of a curved detector are not continued; leave the truncation out");
    SKG_TRY(skg_row_filter_create(padded, fdk->options.filter == SKG_FDK_FILTER_HANN, pose.fan_step,
                                  &fdk->filter));
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

/* One pixel that is no number would be spread over its row and the volume. */
static skg_status check_pixels(const skg_fdk *fdk, int64_t index, const float *image) {
    for (int64_t i = 0; i < fdk->rows * fdk->columns; i++)
        if (!isfinite(image[i]))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "projection %" PRId64 ": the value of row %" PRId64 ", column %" PRId64
                            " is %g; give finite values of -ln(I/I0)",
                            index, i / fdk->columns, i % fdk->columns, (double)image[i]);
    return SKG_OK;
}

/* Threads that would wait for the next projection in a loop of their own take the time of others on a busy machine: those of
 * skg_parallel end with each loop. */
skg_status skg_fdk_add(skg_fdk *fdk, int64_t index, const float *image) {
    SKG_PLAIN;
    skg_orbit_pose pose = {0};
    SKG_NEEDS(fdk);
    SKG_NEEDS(image);
    SKG_TRY(check_pixels(fdk, index, image));
    SKG_TRY(skg_progress_step(fdk->options.progress, fdk->added, fdk->projections));
    SKG_TRY(skg_orbit_pose_get(fdk->scan, &fdk->options, &fdk->orbit, index, &pose));
    SKG_TRY(skg_fdk_filter(fdk, &pose, image));
    SKG_TRY(skg_fdk_back_project(fdk, &pose));
    if (++fdk->added == fdk->projections)
        (void)skg_progress_step(fdk->options.progress, fdk->added, fdk->projections);
    return SKG_OK;
}

void skg_fdk_report_init_sized(void *report, int32_t size) {
    const skg_fdk_report defaults = {0};
    skg_struct_init(report, size, &defaults, sizeof defaults);
}

/* The range of the axis within the rows of all projections. Rows are taken to be linear along the axis, as they are where it runs along the
 * detector. */
static skg_status find_along(const skg_fdk *fdk, double along[2]) {
    along[0] = -HUGE_VAL, along[1] = HUGE_VAL;
    for (int64_t k = 0; k < fdk->projections; k++) {
        skg_orbit_pose pose = {0};
        double next[3];
        SKG_TRY(skg_orbit_pose_get(fdk->scan, &fdk->options, &fdk->orbit, k, &pose));
        skg_add_scaled(fdk->options.centre, 1 / skg_length(fdk->options.axis), fdk->options.axis, next);
        const double row = skg_fdk_row_of(&pose, fdk->options.centre),
                     step = skg_fdk_row_of(&pose, next) - row;
        const double first = -row / step, last = ((double)(fdk->rows - 1) - row) / step;
        along[0] = fmax(along[0], fmin(first, last));
        along[1] = fmin(along[1], fmax(first, last));
    }
    return SKG_OK;
}

skg_status skg_fdk_report_get(const skg_fdk *fdk, skg_fdk_report *report) {
    SKG_NEEDS(fdk);
    SKG_NEEDS(report);
    const skg_orbit *orbit = &fdk->orbit;
    skg_orbit_pose pose = {0};
    SKG_TRY(skg_orbit_pose_get(fdk->scan, &fdk->options, orbit, 0, &pose));
    const double least = fmin(-orbit->low, orbit->high), most = fmax(-orbit->low, orbit->high);
    const double rows = (double)fdk->rows * (double)fdk->added;
    skg_fdk_report ours = {.displaced = orbit->displaced != 0,
                           .covered_mm = skg_orbit_radius(&pose, orbit->displaced ? most : least),
                           .overlap_mm = skg_orbit_radius(&pose, least),
                           .truncated = rows > 0 ? (double)fdk->truncated / rows : 0};
    SKG_TRY(find_along(fdk, ours.along_mm));
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
    const double first[3] = {skg_fdk_place(o, 0, 0), skg_fdk_place(o, 1, 0), skg_fdk_place(o, 2, 0)};
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
