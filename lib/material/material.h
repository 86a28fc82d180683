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
    int64_t momentum_count;
    double *momenta, *coherent; /* [momentum_count] of molecules: 1/Angstrom, F^2 of 1 g; 0: atoms are free */
};

/* The range in keV over which cross sections are given: XCOM's table begins at 1 keV, and above 20 MeV photons of
 * medical and industrial beams are rare. */
#define SKG_LOWEST_KEV 1.0
#define SKG_HIGHEST_KEV 20000.0

/* Whether it stops and scatters nothing: a hole in what is around it. */
static inline int skg_material_is_void(const skg_material *material) {
    return material->kind == SKG_MATTER_CONSTANT && material->mu_per_cm == 0;
}

/* Makes a material with a copy of its name and note. The rest is zero. */
skg_status skg_material_make(const char *name, const char *note, int32_t kind, skg_material **material);

/* The Hounsfield number at which Schneider's table ends. */
#define SKG_HOUNSFIELD_TABLED 1600

/* g/cm3 at a Hounsfield number: below -1000 that of air, above 3000 on the line of bone. */
double skg_hounsfield_density(double hu);

/* The row of the table for a Hounsfield number, and a material of its composition and 1 g/cm3. */
int32_t skg_hounsfield_row_of(double hu);
skg_status skg_hounsfield_row_create(int64_t row, skg_material **material);

/* Makes a material of a composition that has been checked. */
skg_status skg_material_compose(const char *name, const char *note, int64_t count,
                                const skg_mass_fraction *parts, double density, skg_material **material);

/* Gives a material that has none a copy of a table of form factors. x: [count] 1/Angstrom; squares: [count], times `scale` of 1 g */
skg_status skg_material_bind(int64_t count, const double *x, const double *squares, double scale,
                             skg_material *to);

/* A solution of a material of known density in water (skg_material_create_solution). name: of the solute; g_ml: its mass in 1 ml */
skg_status skg_material_dissolve(const char *name, const skg_material *solute, double g_ml,
                                 skg_material **material);

/* Fails with SKG_ERR_MATERIAL outside that range. name: for the message. */
skg_status skg_check_energy(const char *name, double energy_kev);

/* Cross sections of an element in cm2/g at an energy in that range. */
void skg_element_sections(int32_t z, double energy_kev, double sections[SKG_PROCESSES]);

/* Cross sections of a composition in cm2/g: the sum weighted with its fractions by mass. */
void skg_mixed_sections(int64_t count, const skg_mass_fraction *parts, double energy_kev,
                        double sections[SKG_PROCESSES]);

/* Adds the sections of an element, weighted with its fraction. */
void skg_add_sections(const skg_mass_fraction *part, const double own[SKG_PROCESSES],
                      double sections[SKG_PROCESSES]);

/* Cross sections of elements at some energies, each worked out once: scenes have many materials of few elements. Set
 * count and energies, the rest to 0. */
typedef struct {
    int64_t count;
    const double *energy_kev;                                  /* [count] borrowed */
    double (*of_element[SKG_LAST_ELEMENT + 1])[SKG_PROCESSES]; /* [count] each; NULL: not needed yet */
} skg_section_table;

/* Computes skg_material_attenuation_get for each of the energies, with its bits and its errors. per_cm: [count] */
skg_status skg_attenuation_tabulate(const skg_material *material, skg_section_table *table, double *per_cm);
void skg_section_table_release(skg_section_table *table);

/* The sum over the processes. */
double skg_total_section(const double sections[SKG_PROCESSES]);

/* Reads a formula into fractions by mass, in which each element occurs once.
 *
 * by_mass   0: the numbers count atoms ("Ca5(PO4)3OH"); 1: they are parts by mass ("Ti90Al6V4")
 * parts     [SKG_LAST_ELEMENT], of which *count are filled
 * sum       the sum of the numbers */
skg_status skg_read_formula(const char *formula, int by_mass, int64_t *count, skg_mass_fraction *parts,
                            double *sum);

/* The atomic number of an element by its symbol, whose case counts, or by its name, whose case does not; 0 if
 * there is none. */
int32_t skg_find_element(const char *text);

#endif
