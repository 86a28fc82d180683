/* Grey values of a detector. */
#include "core/core.h"
#include "core/maths.h"
#include "core/text.h"

#include <skiagraph/readout.h>

#include <inttypes.h>
#include <math.h>

/* CODATA 2018, exact. */
static const double joules_per_kev = 1.602176634e-16;

void skg_readout_init_sized(void *readout, int32_t size) {
    const skg_readout defaults = {.bits = 16, .full = 60000, .frames = 1};
    skg_struct_init(readout, size, &defaults, sizeof defaults);
}

static skg_status check_table(const char *name, int64_t count, const double *table) {
    if (count == 0) return SKG_OK;
    if (count < 2 || !table)
        return skg_fail(SKG_ERR_ARGUMENT, "readout: %s has %" PRId64 " points; give 2 or more", name, count);
    for (int64_t i = 0; i < count; i++)
        if (!isfinite(table[2 * i]) || !isfinite(table[2 * i + 1]) ||
            (i > 0 && table[2 * i] <= table[2 * i - 2]))
            return skg_fail(SKG_ERR_ARGUMENT, "readout: point %" PRId64 " of %s does not rise", i, name);
    return SKG_OK;
}

static skg_status check(const skg_readout *r) {
    SKG_TRY(check_table("the curve", r->curve_count, r->curve));
    SKG_TRY(check_table("the noise", r->noise_count, r->noise));
    if (r->bits != 0 && (r->bits < 8 || r->bits > 16))
        return skg_fail(SKG_ERR_ARGUMENT, "readout: %" PRId32 " bits; give 8 to 16, or 0", r->bits);
    if (!(r->full_kev > 0) || isinf(r->full_kev))
        return skg_fail(SKG_ERR_ARGUMENT, "readout: full_kev is %g; it has to be above 0", r->full_kev);
    if (!(r->snr >= 0) || !(r->per_joule >= 0) || !isfinite(r->dark + r->full))
        return skg_fail(SKG_ERR_ARGUMENT, "readout: snr, per_joule, dark or full is no number, or negative");
    if (!(r->saturation >= 0))
        return skg_fail(SKG_ERR_ARGUMENT, "readout: saturation at %g; give a grey value above 0, or 0",
                        r->saturation);
    if (r->frames < 1)
        return skg_fail(SKG_ERR_ARGUMENT, "readout: an average of %" PRId64 " frames", r->frames);
    return SKG_OK;
}

/* Linear between the points of a table, and beyond them as between the nearest two. */
static double interpolate(int64_t count, const double *table, double x) {
    int64_t low = 0, high = count - 1;
    while (high - low > 1) {
        const int64_t middle = (low + high) / 2;
        if (table[2 * middle] <= x)
            low = middle;
        else
            high = middle;
    }
    const double *a = table + 2 * low, *b = table + 2 * high;
    return a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]);
}

static double grey_of(const skg_readout *r, double kev) {
    if (r->curve_count > 0) return interpolate(r->curve_count, r->curve, kev * joules_per_kev);
    if (r->per_joule > 0) return r->dark + r->per_joule * kev * joules_per_kev;
    return r->dark + (r->full - r->dark) * kev / r->full_kev;
}

/* Standard deviation of one frame at a grey value without noise. full_sigma: at full_kev */
static double sigma_of(const skg_readout *r, double full_sigma, double kev, double grey) {
    if (r->noise_count > 0) {
        const double ratio = interpolate(r->noise_count, r->noise, grey);
        return ratio > 0 ? fabs(grey) / ratio : 0;
    }
    return kev > 0 ? full_sigma * sqrt(kev / r->full_kev) : 0;
}

static double energy_at(int32_t type, const void *energies, int64_t i) {
    if (!energies) return 0;
    return type == SKG_TYPE_FLOAT64 ? ((const double *)energies)[i] : (double)((const float *)energies)[i];
}

/* A map that every pixel reads. lowest: of its values */
static skg_status check_map(const char *name, int64_t pixels, const float *map, double lowest) {
    for (int64_t i = 0; map && i < pixels; i++)
        if (!(isfinite(map[i]) && (double)map[i] >= lowest))
            return skg_fail(SKG_ERR_ARGUMENT, "readout: the %s of pixel %" PRId64 " is %g", name, i,
                            (double)map[i]);
    return SKG_OK;
}

/* The grey value of a pixel before bits. full_sigma, averaged: of the noise; index: of the image */
static double read_pixel(const skg_readout *r, int64_t i, double kev, double full_sigma, double averaged,
                         int64_t index) {
    const double plain = grey_of(r, kev), gain = r->gain ? (double)r->gain[i] : 1;
    const int is_noisy = full_sigma > 0 || r->noise_count > 0;
    const double sigma = is_noisy ? gain * averaged * sigma_of(r, full_sigma, kev, plain) : 0;
    double value = plain;
    if (r->gain) {
        const double dark = grey_of(r, 0);
        value = dark + gain * (plain - dark);
    }
    if (r->offset) value += (double)r->offset[i];
    if (sigma > 0) value += sigma * skg_deviate(r->seed, index, i);
    if (r->saturation > 0) value = fmin(value, r->saturation);
    /* -1 marks a good pixel, exactly. */
    return r->bad_pixels && !(r->bad_pixels[i] >= -1 && r->bad_pixels[i] <= -1) ? (double)r->bad_pixels[i]
                                                                                : value;
}

skg_status skg_readout_image(const skg_readout *readout, int64_t pixels, int32_t type, const void *energies,
                             double share, int64_t index, void *grey) {
    SKG_PLAIN;
    skg_readout r;
    skg_readout_init(&r);
    SKG_NEEDS(grey);
    SKG_TRY(skg_struct_read(readout, "skg_readout", &r, sizeof r));
    SKG_TRY(check(&r));
    const double most = r.bits ? (double)((1 << r.bits) - 1) : 0, averaged = 1 / sqrt((double)r.frames);
    const double full_sigma = r.snr > 0 ? fabs(grey_of(&r, r.full_kev)) / r.snr : 0;
    SKG_TRY(check_map("gain", pixels, r.gain, 0));
    SKG_TRY(check_map("offset", pixels, r.offset, -HUGE_VAL));
    for (int64_t i = 0; i < pixels; i++) {
        const double kev = share * energy_at(type, energies, i);
        const double value = read_pixel(&r, i, kev, full_sigma, averaged, index);
        if (r.bits)
            ((uint16_t *)grey)[i] = (uint16_t)fmin(fmax(floor(value + 0.5), 0), most);
        else
            ((float *)grey)[i] = (float)value;
    }
    return SKG_OK;
}
