/* Text files of two columns: spectra, GATE macros, responses, tables of attenuation. The first byte chooses
 * what, the second the unit; the rest is the file. What loads is used. */
#include "fuzz/fuzz.h"

#include <skiagraph/beam.h>
#include <skiagraph/material.h>

static void use_spectrum(const char *path, const char *unit) {
    skg_spectrum *spectrum = NULL;
    skg_quality quality;
    skg_quality_init(&quality);
    fuzz_expect_sentence(skg_spectrum_load(path, unit, &spectrum));
    if (spectrum) fuzz_expect_sentence(skg_spectrum_quality_get(spectrum, &quality));
    skg_spectrum_release(&spectrum);
}

static void use_response(const char *path, const char *unit) {
    skg_response *response = NULL;
    double recorded, efficiency;
    fuzz_expect_sentence(skg_response_load(path, unit, SKG_RESPONSE_MEANING_SIGNAL, &response));
    if (response) fuzz_expect_sentence(skg_response_get(response, 60, 1.1, &recorded, &efficiency));
    skg_response_release(&response);
}

static void use_material(const char *path, const char *unit) {
    skg_material *material = NULL;
    double per_cm, edges[8];
    int64_t count;
    fuzz_expect_sentence(skg_material_load_table(path, unit, &material));
    if (material) {
        fuzz_expect_sentence(skg_material_attenuation_get(material, 60, &per_cm));
        fuzz_expect_sentence(skg_material_edges_get(material, 8, edges, &count));
    }
    skg_material_release(&material);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char *const units[4] = {"eV", "keV", "MeV", "keV"};
    if (size < 2) return 0;
    const char *path = fuzz_write(data[0] % 4 == 1 ? "m.mac" : "m.txt", data + 2, size - 2);
    const char *unit = units[data[1] % 4];
    if (data[0] % 4 < 2)
        use_spectrum(path, unit);
    else if (data[0] % 4 == 2)
        use_response(path, unit);
    else
        use_material(path, unit);
    return 0;
}
