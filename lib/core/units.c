/* Units of length and what they are in mm. */
#include "core/text.h"

#include <math.h>
#include <stdio.h>

typedef struct {
    const char *name;
    double value;
} unit;

static const unit lengths[] = {
    {"mm", 1},           {"millimetre", 1},    {"millimeter", 1},    {"um", 1e-3},
    {"nm", 1e-6},        {"nanometre", 1e-6},  {"nanometer", 1e-6},  {"micron", 1e-3},
    {"inch", 25.4},      {"in", 25.4},         {"inches", 25.4},     {"ft", 304.8},
    {"foot", 304.8},     {"feet", 304.8},      {"µm", 1e-3}, /* the sign for micro, and the Greek letter */
    {"μm", 1e-3},        {"micrometre", 1e-3}, {"micrometer", 1e-3}, {"cm", 10},
    {"centimetre", 10},  {"centimeter", 10},   {"dm", 100},          {"decimetre", 100},
    {"decimeter", 100},  {"m", 1000},          {"metre", 1000},      {"meter", 1000},
    {"dam", 1e4},        {"decametre", 1e4},   {"decameter", 1e4},   {"hm", 1e5},
    {"hectometre", 1e5}, {"hectometer", 1e5},  {"km", 1e6},          {"kilometre", 1e6},
    {"kilometer", 1e6},
};

static const unit energies[] = {
    {"keV", 1},   {"kiloelectronvolt", 1}, {"MeV", 1000}, {"megaelectronvolt", 1000},
    {"eV", 1e-3}, {"electronvolt", 1e-3},
};

enum {
    LENGTHS = sizeof lengths / sizeof *lengths,
    ENERGIES = sizeof energies / sizeof *energies,
    LIMIT = LENGTHS
};

static skg_status find(const char *name, const char *of_what, const char *known, const unit *units,
                       int64_t count, double *value) {
    const char *names[LIMIT];
    for (int64_t i = 0; i < count; i++) {
        names[i] = units[i].name;
        if (skg_same_name(units[i].name, name)) {
            *value = units[i].value;
            return SKG_OK;
        }
    }
    const char *near = skg_nearest_name(name, names, count);
    return skg_fail(SKG_ERR_FORMAT, "\"%s\" is no unit of %s%s%s; known: %s", name, of_what,
                    near ? "; did you mean " : "", near ? near : "", known);
}

skg_status skg_unit_of_length(const char *name, double *mm) {
    return find(name, "length", "nm, um, mm, cm, dm, m, in, ft, dam, hm, km", lengths, LENGTHS, mm);
}

/* The first name of a value is its short one. */
void skg_unit_describe(double mm, char *text, size_t size) {
    for (int64_t i = 0; i < LENGTHS; i++)
        if (fabs(lengths[i].value - mm) <= 1e-6 * mm) { /* files have floats */
            snprintf(text, size, "%s", lengths[i].name);
            return;
        }
    snprintf(text, size, "%.6g mm", mm);
}

void skg_unit_contradict(double mm, const char *of_file, char *text, size_t size) {
    char used[32];
    skg_unit_describe(mm, used, sizeof used);
    snprintf(text, size, "read in %s, as was asked; the file itself is in %s", used, of_file);
}

skg_status skg_unit_of_energy(const char *name, double *kev) {
    return find(name, "energy", "eV, keV, MeV", energies, ENERGIES, kev);
}
