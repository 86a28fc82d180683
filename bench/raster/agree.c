/* Whether two images of path lengths differ by rounding only. */
#include "agree.h"

#include <math.h>

void agree(const float *image, const float *reference, int64_t pixels, agreement *out) {
    double squares = 0, worst = 0, longest = 0;
    int64_t met = 0, gross = 0;
    for (int64_t k = 0; k < pixels; k++) longest = fmax(longest, (double)reference[k]);
    for (int64_t k = 0; k < pixels; k++) {
        if (image[k] == 0 && reference[k] == 0) continue;
        const double difference = fabs((double)image[k] - (double)reference[k]);
        met++;
        worst = fmax(worst, difference);
        if (difference > 1e-3 * longest)
            gross++;
        else
            squares += difference * difference;
    }
    *out = (agreement){.longest = longest,
                       .rms = met > gross ? sqrt(squares / (double)(met - gross)) : 0,
                       .worst = worst,
                       .pixels = met,
                       .gross = gross};
}

int agree_within(const agreement *found, double rms_bar, int64_t gross_bar) {
    return found->pixels > 0 && found->rms <= rms_bar * found->longest && found->gross <= gross_bar;
}
