/* The samples of an extended source and of pixels. */
#include "geometry/optics.h"

#include "core/maths.h"

#include <inttypes.h>
#include <math.h>

enum { SAMPLES_MAX = 65536, SHIFTS_MAX = 16 };

void skg_spot_init_sized(void *spot, int32_t size) {
    const skg_spot defaults = {.tolerance = 5e-3, .samples_max = 1024};
    skg_struct_init(spot, size, &defaults, sizeof defaults);
}

/* The number of extents of a shape. */
static int extents_of(int32_t shape) {
    static const int extents[] = {0, 1, 2, 3, 1, 1, 2};
    return extents[shape];
}

static int64_t grid_size(const skg_spot *spot) {
    int64_t size = 1;
    for (int k = 0; k < extents_of(spot->shape); k++) size *= spot->grid;
    return size;
}

static skg_status check_spot(const skg_spot *spot) {
    if (spot->shape < SKG_SPOT_POINT || spot->shape > SKG_SPOT_GAUSSIAN)
        return skg_fail(SKG_ERR_ARGUMENT, "shape %" PRId32 " of a focal spot is unknown; SKG_SPOT_...",
                        spot->shape);
    for (int k = 0; k < extents_of(spot->shape); k++)
        if (!(spot->extent[k] >= 0 && spot->extent[k] <= 1000))
            return skg_fail(SKG_ERR_SCENE, "the focal spot is %g mm wide along axis %d; 0 to 1000 mm",
                            spot->extent[k], k);
    if (!skg_all_finite(spot->axis, 3))
        return skg_fail(SKG_ERR_SCENE, "the axis of the focal spot is not finite");
    if (spot->samples < 0 || spot->samples > SAMPLES_MAX || spot->samples_max < 1 ||
        spot->samples_max > SAMPLES_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "%" PRId64 " samples of the source, at most %" PRId64 "; 0 to %d",
                        spot->samples, spot->samples_max, SAMPLES_MAX);
    if (!(spot->off_focal >= 0 && spot->off_focal < 1))
        return skg_fail(SKG_ERR_ARGUMENT, "off-focal radiation: a share of %g; 0 to below 1",
                        spot->off_focal);
    if (spot->off_focal > 0 && !(spot->off_focal_mm > 0 && spot->off_focal_mm <= 1000))
        return skg_fail(SKG_ERR_SCENE, "off-focal radiation: a disc of %g mm; above 0 to 1000 mm",
                        spot->off_focal_mm);
    if (spot->off_focal > 0 && (spot->shape == SKG_SPOT_POINT || spot->grid > 0))
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "off-focal radiation beside %s; give the focal spot a shape of some size without a grid, such as "
            "a disc of 0.1 mm",
            spot->grid > 0 ? "a grid of samples" : "a point");
    if (!(spot->tolerance > 0 && spot->tolerance < 1))
        return skg_fail(
            SKG_ERR_ARGUMENT,
            "a tolerance of %g of the flat field for the source is not usable; give one above 0 and below 1",
            spot->tolerance);
    if (spot->grid < 0 || spot->grid > 256 || (spot->grid > 0 && spot->shape > SKG_SPOT_CUBE))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "a grid of %" PRId64 " pieces a side; 0 to 256, of a line, a rectangle or a cube",
                        spot->grid);
    if (spot->grid > 0 && grid_size(spot) > SAMPLES_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "a grid of %" PRId64 " samples; at most %d", grid_size(spot),
                        SAMPLES_MAX);
    return SKG_OK;
}

skg_status skg_samples_make(const skg_spot *spot, int32_t supersampling, skg_samples *samples) {
    *samples = (skg_samples){.spot_count = 1, .shifts = supersampling, .fine = 1};
    skg_spot_init(&samples->spot);
    if (spot) SKG_TRY(skg_struct_read(spot, "skg_spot", &samples->spot, sizeof samples->spot));
    SKG_TRY(check_spot(&samples->spot));
    if (supersampling < 1 || supersampling > SHIFTS_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "%" PRId32 " rays a side of a pixel; 1 to %d", supersampling,
                        SHIFTS_MAX);
    if (samples->spot.shape == SKG_SPOT_POINT) return SKG_OK;
    samples->spot_count = samples->spot.grid > 0      ? grid_size(&samples->spot)
                          : samples->spot.samples > 0 ? samples->spot.samples
                                                      : 1;
    return SKG_OK;
}

int64_t skg_samples_count(const skg_samples *samples) {
    return samples->spot_count * samples->shifts * samples->shifts;
}

int64_t skg_samples_passes(const skg_samples *samples) {
    return skg_samples_count(samples) / (samples->fine * samples->fine);
}

/* --- Sobol's sequence in three dimensions --- */

/* I. M. Sobol', USSR Comput. Math. Math. Phys. 7 (1967) 86, with the polynomials 1, x + 1, x^2 + x + 1 and the
 * initial numbers of S. Joe and F. Y. Kuo, SIAM J. Sci. Comput. 30 (2008) 2635. DIGITS: 2^17 points exceed
 * SAMPLES_MAX. */
enum { DIGITS = 17 };

static void sobol(int64_t index, double x[3]) {
    uint32_t direction[3][DIGITS], sum[3] = {0, 0, 0};
    for (int k = 0; k < DIGITS; k++) direction[0][k] = UINT32_C(1) << (31 - k);
    direction[1][0] = UINT32_C(1) << 31;
    for (int k = 1; k < DIGITS; k++) direction[1][k] = direction[1][k - 1] ^ (direction[1][k - 1] >> 1);
    direction[2][0] = UINT32_C(1) << 31;
    direction[2][1] = UINT32_C(3) << 30;
    for (int k = 2; k < DIGITS; k++)
        direction[2][k] = direction[2][k - 1] ^ direction[2][k - 2] ^ (direction[2][k - 2] >> 2);
    for (int k = 0; k < DIGITS; k++)
        if (index >> k & 1)
            for (int d = 0; d < 3; d++) sum[d] ^= direction[d][k];
    /* The digits are shifted by 0.1010... At every length of the sequence the samples of the pieces are then a
     * third of a piece from its middle, to one side or the other, and not all in its corner. The half step 2^14
     * centres them. */
    for (int d = 0; d < 3; d++) x[d] = ((sum[d] ^ UINT32_C(0xaaaa8000)) + 0x1p14) * 0x1p-32;
}

static void grid_point(const skg_spot *spot, int64_t index, double x[3]) {
    for (int k = 0; k < 3; k++) {
        x[k] = ((double)(index % spot->grid) + 0.5) / (double)spot->grid;
        index /= spot->grid;
    }
}

/* --- shapes --- */

static const double TURN = 2 * SKG_PI;

/* A point of the spot in the axes of the spot, mm: across, down, along. */
static void place_in_spot(const skg_spot *spot, const double x[3], double local[3]) {
    const double *extent = spot->extent;
    for (int k = 0; k < 3; k++) local[k] = k < extents_of(spot->shape) ? (x[k] - 0.5) * extent[k] : 0;
    if (spot->shape == SKG_SPOT_DISC) {
        const double radius = 0.5 * extent[0] * sqrt(x[0]);
        local[0] = radius * cos(TURN * x[1]);
        local[1] = radius * sin(TURN * x[1]);
    } else if (spot->shape == SKG_SPOT_SPHERE) {
        const double radius = 0.5 * extent[0] * cbrt(x[0]), z = 2 * x[1] - 1,
                     across = sqrt(fmax(0, 1 - z * z));
        local[0] = radius * across * cos(TURN * x[2]);
        local[1] = radius * across * sin(TURN * x[2]);
        local[2] = radius * z;
    } else if (spot->shape == SKG_SPOT_GAUSSIAN) {
        /* The transform of Box and Muller. A full width at half maximum is 2 sqrt(2 ln 2) standard deviations. */
        const double radius = sqrt(-2 * log(1 - x[0])) / 2.3548200450309493;
        local[0] = extent[0] * radius * cos(TURN * x[1]);
        local[1] = extent[1] * radius * sin(TURN * x[1]);
    }
}

/* The spot that a sample belongs to: the focal spot, or a disc around it. The share of the samples that the disc has is that of the first
 * coordinate, which is then even again in either. */
static skg_spot spot_of(const skg_spot *spot, double x[3]) {
    const int is_off = x[0] < spot->off_focal;
    skg_spot own = *spot;
    if (!(spot->off_focal > 0)) return own;
    x[0] = is_off ? x[0] / spot->off_focal : (x[0] - spot->off_focal) / (1 - spot->off_focal);
    if (is_off) own.shape = SKG_SPOT_DISC, own.extent[0] = spot->off_focal_mm;
    return own;
}

/* The axes of the spot in the world: across (along the projected column step), down, and towards the detector. */
static void find_axes(const skg_spot *spot, const skg_view *view, double axes[3][3]) {
    double *along = axes[2];
    for (int k = 0; k < 3; k++) along[k] = spot->axis[k];
    if (!(skg_length(along) > 0)) skg_add_scaled(view->centre, -1, view->source, along);
    skg_scale_vector(1 / skg_length(along), along, along);
    const double *step = view->column_step;
    skg_add_scaled(step, -skg_dot(step, along), along, axes[0]);
    /* If the columns run along the axis, up to rounding, the rows do not. */
    if (!(skg_length(axes[0]) > 1e-9 * skg_length(step))) {
        step = view->row_step;
        skg_add_scaled(step, -skg_dot(step, along), along, axes[0]);
    }
    skg_scale_vector(1 / skg_length(axes[0]), axes[0], axes[0]);
    skg_cross(along, axes[0], axes[1]);
}

void skg_samples_at(const skg_samples *samples, const skg_view *view, int64_t index, double source[3],
                    double shift[2]) {
    SKG_ASSERT(index >= 0);
    const int64_t side = samples->shifts, in_pixel = index % (side * side), of_source = index / (side * side);
    shift[0] = ((double)(in_pixel % side) + 0.5) / (double)side - 0.5;
    shift[1] = ((double)(in_pixel / side) + 0.5) / (double)side - 0.5;
    for (int k = 0; k < 3; k++) source[k] = view->source[k];
    if (samples->spot.shape == SKG_SPOT_POINT) return;
    double x[3], local[3], axes[3][3];
    if (samples->spot.grid > 0)
        grid_point(&samples->spot, of_source, x);
    else
        sobol(of_source, x);
    const skg_spot own = spot_of(&samples->spot, x);
    place_in_spot(&own, x, local);
    find_axes(&samples->spot, view, axes);
    for (int k = 0; k < 3; k++) skg_add_scaled(source, local[k], axes[k], source);
}

void skg_samples_view(const skg_samples *samples, const skg_view *view, skg_view *fine) {
    *fine = *view;
    fine->columns *= samples->fine;
    fine->rows *= samples->fine;
    for (int k = 0; k < 3; k++) {
        fine->column_step[k] /= (double)samples->fine;
        fine->row_step[k] /= (double)samples->fine;
    }
}

skg_status skg_samples_camera(const skg_samples *samples, const skg_view *view, int64_t pass,
                              skg_camera *camera) {
    double source[3], shift[2];
    skg_view fine;
    skg_samples_at(samples, view, pass * samples->fine * samples->fine, source, shift);
    if (samples->fine == 1) return skg_camera_make(view, source, shift[0], shift[1], camera);
    skg_samples_view(samples, view, &fine); /* the centres of its pixels are the samples of the pixel */
    return skg_camera_make(&fine, source, 0, 0, camera);
}
