/* Reads spectra from text files. */
#include "beam/spectrum.h"
#include "core/files.h"
#include "core/text.h"

#include <stdio.h>
#include <string.h>

/* The word that precedes the numbers in a GATE macro; NULL for a file of two columns. */
static skg_status find_word(const char *path, const char **word) {
    char text[512];
    *word = NULL;
    FILE *file = NULL;
    SKG_TRY(skg_text_open(path, &file));
    while (!*word && fgets(text, sizeof text, file)) {
        if (text[strspn(text, " \t")] != '/') continue; /* commands of a macro begin with a slash */
        if (strstr(text, "histpoint")) *word = "histpoint";
        if (strstr(text, "hist/point")) *word = "hist/point";
    }
    fclose(file);
    return SKG_OK;
}

skg_status skg_spectrum_load(const char *path, const char *unit, skg_spectrum **spectrum) {
    SKG_PLAIN;
    SKG_NEEDS(path);
    SKG_NEEDS(unit);
    SKG_NEEDS(spectrum);
    const char *word = NULL;
    double kev = 1, *energies = NULL, *photons = NULL;
    int64_t count = 0;
    *spectrum = NULL;
    SKG_TRY(skg_unit_of_energy(unit, &kev));
    SKG_TRY(find_word(path, &word));
    SKG_TRY(skg_read_columns(path, word, &count, &energies, &photons));
    for (int64_t i = 0; i < count; i++) energies[i] *= kev;
    skg_status status = skg_spectrum_create_bins(count, energies, photons, spectrum);
    skg_free(&energies);
    skg_free(&photons);
    if (status == SKG_ERR_BEAM) return skg_fail(status, "%s: %s", path, skg_last_error());
    return status;
}
