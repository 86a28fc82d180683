/* Hash of the projections of a scan: of its set-up and the options that change them. */
#include "core/core.h"
#include "core/digest.h"
#include "core/text.h"

#include <skiagraph/scan_run.h>
#include <skiagraph/version.h>

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

skg_status skg_scan_hash_get(const skg_setup *setup, const skg_plan_options *options,
                             const skg_scan_run_options *run, char *hash, int64_t size) {
    SKG_PLAIN;
    skg_plan_options o;
    skg_scan_run_options r;
    skg_spectrum *spectrum = NULL;
    skg_digester sum;
    char text[512];
    SKG_NEEDS(options);
    SKG_NEEDS(hash);
    skg_plan_options_init(&o);
    skg_scan_run_options_init(&r);
    SKG_TRY(skg_struct_read(options, "skg_plan_options", &o, sizeof o));
    if (run) SKG_TRY(skg_struct_read(run, "skg_scan_run_options", &r, sizeof r));
    SKG_TRY(skg_setup_hash_get(setup, hash, size));
    SKG_TRY(skg_setup_spectrum_get(setup, &spectrum));
    if (o.falloff == SKG_FALLOFF_AUTO && spectrum) SKG_TRY(skg_spectrum_absolute_get(spectrum, &o.falloff));
    if (o.falloff == SKG_FALLOFF_AUTO) o.falloff = SKG_FALLOFF_OFF;
    snprintf(text, sizeof text,
             "%s %d %d %d %.17g %d %d %d %d %d %d %" PRId64 " %.17g %.17g %.17g %d %" PRId64 " %d %" PRId64,
             SKG_VERSION, (int)r.type, (int)o.precision, (int)o.quantity, o.tolerance, (int)o.falloff,
             (int)o.supersampling, (int)o.noise, (int)o.repair, (int)o.clip + 2 * (int)o.unite,
             (int)o.band_weight, o.noise_seed, o.swank, o.electronic_kev, o.quantum_step_kev,
             r.motion != NULL, r.subframes, (int)(o.bands > 0), r.noise_seed);
    skg_digest_start(&sum);
    skg_digest_add_text(&sum, hash);
    skg_digest_add_text(&sum, text);
    for (int64_t b = 0; o.bands > 0 && b <= o.bands; b++)
        skg_digest_add(&sum, &o.band_kev[b], sizeof(double));
    const skg_digest digest = skg_digest_end(&sum);
    skg_digest_text(&digest, hash);
    return SKG_OK;
}
