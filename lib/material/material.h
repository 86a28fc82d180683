/* The inside of a material. Private. */
#ifndef SKG_MATERIAL_PRIVATE_H
#define SKG_MATERIAL_PRIVATE_H

#include "core/core.h"
#include "materials/rows.h"

#include <skiagraph/material.h>

enum {
    SKG_MATTER_CONSTANT = 0,    /* mu_per_cm at every energy */
    SKG_MATTER_COMPOSITION = 1, /* fractions and density */
    SKG_MATTER_TABLE = 2        /* mu by energy */
};

struct skg_material {
    skg_refs refs;
    int32_t kind;
    char *name, *note; /* never NULL */
    double mu_per_cm;
    double density; /* g/cm3; 0: not known */
    int64_t count;  /* of elements, or of rows of the table */
    skg_mass_fraction *parts;
    double *energy_kev, *per_cm;
    int32_t linear; /* the table is interpolated linearly, not log-log */
};

/* Where cross sections stand. */
#define SKG_LOWEST_KEV 1.0
#define SKG_HIGHEST_KEV 20000.0

/* A material with its name and note copied; the rest is zero. */
skg_status skg_material_make(const char *name, const char *note, int32_t kind, skg_material **material);

/* A material of a composition that is known to be sound. */
skg_status skg_material_compose(const char *name, const char *note, int64_t count,
                                const skg_mass_fraction *parts, double density, skg_material **material);

/* SKG_ERR_MATERIAL outside 1 keV to 20 MeV; name for the message. */
skg_status skg_check_energy(const char *name, double energy_kev);

/* Cross sections of an element in cm2/g, energy in the range. */
void skg_element_sections(int32_t z, double energy_kev, double sections[SKG_PROCESSES]);

/* Sum over a composition; energy in the range. */
void skg_mixed_sections(int64_t count, const skg_mass_fraction *parts, double energy_kev,
                        double sections[SKG_PROCESSES]);

/* Reads atoms ("Ca5(PO4)3OH") or, by_mass, parts by mass ("Ti90Al6V4") into fractions by mass, each element
 * once; sum: of the numbers. parts: [SKG_LAST_ELEMENT]. */
skg_status skg_read_formula(const char *formula, int by_mass, int64_t *count, skg_mass_fraction *parts,
                            double *sum);

/* The tabled mixture whose name, any of them, is this but for case, blanks and punctuation; NULL. */
const skg_mixture_row *skg_find_mixture(const char *name);

/* The element of this symbol (its case counts) or name (it does not); 0. */
int32_t skg_find_element(const char *text);

#endif
