/* Mixes planes, so that fewer sums are drawn. */
#include "spectral/model.h"

#include <math.h>
#include <string.h>

/* Lists whose weights differ by less, relative to the largest, are proportional: tables and sums are rounded. */
static const double PROPORTIONAL = 1e-13;

void skg_mix_release(skg_mix *mix) {
    skg_free(&mix->lists);
    skg_free(&mix->contributions);
    skg_free(&mix->first_contribution);
    mix->sums = 0;
}

/* Writes the contributions as a list over all planes, divided by the first weight of largest size, which is
 * returned. */
static double normalise(int32_t planes, const skg_contribution *contributions, int64_t count, double *list) {
    double largest = 0;
    memset(list, 0, (size_t)planes * sizeof *list);
    for (int64_t w = 0; w < count; w++) list[contributions[w].plane] += contributions[w].weight;
    for (int32_t k = 0; k < planes; k++)
        if (fabs(list[k]) > fabs(largest)) largest = list[k];
    for (int32_t k = 0; k < planes && largest != 0; k++) list[k] /= largest;
    return largest;
}

static int same_list(const double *a, const double *b, int32_t planes) {
    for (int32_t k = 0; k < planes; k++)
        if (fabs(a[k] - b[k]) > PROPORTIONAL) return 0;
    return 1;
}

/* The accumulator of a normalised list; a new one if there is none. Returns -1 if there are `most` already. */
static int32_t accumulator_of(const double *list, int32_t planes, int32_t most, skg_mix *mix) {
    for (int32_t s = 0; s < mix->sums; s++)
        if (same_list(mix->lists + (int64_t)s * planes, list, planes)) return s;
    if (mix->sums == most) return -1;
    memcpy(mix->lists + (int64_t)mix->sums * planes, list, (size_t)planes * sizeof *list);
    return mix->sums++;
}

skg_status skg_mix_find(int64_t parts, int32_t planes, const skg_contribution *contributions,
                        const int64_t *first_contribution, int32_t most, skg_mix *mix) {
    double *list = NULL;
    skg_status status = SKG_OK;
    int64_t count = 0;
    int fits = 1;
    *mix = (skg_mix){0};
    SKG_TRY_CLEANUP(skg_alloc(planes, sizeof *list, "planes of the parts", &list));
    SKG_TRY_CLEANUP(
        skg_alloc((int64_t)most * planes, sizeof *mix->lists, "planes of the parts", &mix->lists));
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *mix->contributions, "planes of the parts", &mix->contributions));
    SKG_TRY_CLEANUP(skg_alloc(parts + 1, sizeof *mix->first_contribution, "planes of the parts",
                              &mix->first_contribution));
    for (int64_t p = 0; p < parts && fits; p++) {
        const int64_t first = first_contribution[p];
        const double factor =
            normalise(planes, contributions + first, first_contribution[p + 1] - first, list);
        mix->first_contribution[p] = count;
        if (factor == 0) continue;
        const int32_t sum = accumulator_of(list, planes, most, mix);
        mix->contributions[count++] = (skg_contribution){.plane = sum, .weight = factor};
        fits = sum >= 0;
    }
    mix->first_contribution[parts] = count;
cleanup:
    skg_free(&list);
    if (status != SKG_OK || !fits) skg_mix_release(mix);
    return status;
}

skg_status skg_mix_choose(int64_t parts, int32_t planes, const skg_contribution *contributions,
                          const int64_t *first_contribution, int32_t most, int32_t *sums) {
    skg_mix mix;
    int nested = 0;
    for (int64_t p = 0; p < parts && !nested; p++)
        nested = first_contribution[p + 1] - first_contribution[p] > 1;
    *sums = 0;
    if (!nested) return SKG_OK;
    SKG_TRY(skg_mix_find(parts, planes, contributions, first_contribution, most, &mix));
    *sums = mix.sums;
    skg_mix_release(&mix);
    return SKG_OK;
}
