/* The tables that this folder compiles in: the types of their rows. Private. */
#ifndef SKG_MATERIAL_TABLES_H
#define SKG_MATERIAL_TABLES_H

#include <stdint.h>

enum {
    SKG_RAYLEIGH = 0,
    SKG_COMPTON = 1,
    SKG_PHOTO = 2,
    SKG_PAIR = 3,
    SKG_PROCESSES = 4,
    SKG_LAST_ELEMENT = 92,
    SKG_K_LINES = 6,
    SKG_L_LINES = 12,
    SKG_MOMENTA = 41
};

/* Twice the rest energy of the electron in keV (CODATA 2018): below it there is no pair production. */
#define SKG_PAIR_THRESHOLD_KEV 1021.9978999

/* One energy of an element: the logarithm of the cross section in cm2/g (for pairs: of the cross section divided by
 * (1 - threshold/E)^3) and its second derivative by ln E. An edge is two rows of the same energy, the first with the
 * values below it and the second with those above. */
typedef struct {
    double energy_kev, log_energy;
    double value[SKG_PROCESSES], second[SKG_PROCESSES];
} skg_knot;

typedef struct {
    const char *symbol;
    const char *names;   /* separated by ';' */
    double weight;       /* g/mol */
    double density;      /* g/cm3; 0: not known */
    int32_t first, last; /* knots */
} skg_element_row;

typedef struct {
    int32_t z;
    double fraction; /* by mass */
} skg_mass_fraction;

typedef struct {
    const char *names;    /* the first is the one to show; separated by ';' */
    double density;       /* g/cm3 */
    int32_t first, count; /* skg_mass_fractions */
    const char *source;
} skg_mixture_row;

/* Tissue by Hounsfield number: the composition from `lowest` up to that of the next row. */
typedef struct {
    double lowest;
    const char *name;
    int32_t first, count; /* skg_mass_fractions */
} skg_hounsfield_row;

/* A shell of an element, and the lines that its vacancies emit. */
typedef struct {
    int32_t z;
    double edge_kev;                                  /* of L: that of L3 */
    double yield;                                     /* photons per vacancy; of L: 1 */
    double line_kev[SKG_L_LINES], share[SKG_L_LINES]; /* of the yield; 0: no such line */
} skg_shell_row;

/* The form factor F and the incoherent scattering function S of an atom. */
enum { SKG_COHERENT = 0, SKG_INCOHERENT = 1, SKG_SCATTERINGS = 2 };

/* One momentum transfer of an element: ln F and ln S, and their second derivatives by ln x. */
typedef struct {
    float value[SKG_SCATTERINGS], second[SKG_SCATTERINGS];
} skg_scattering_row;

extern const skg_knot skg_knots[];
extern const skg_element_row skg_elements[SKG_LAST_ELEMENT + 1]; /* by atomic number */
extern const skg_mass_fraction skg_mass_fractions[];
extern const skg_mixture_row skg_mixtures[];
extern const int32_t skg_mixture_count;
extern const skg_hounsfield_row skg_hounsfield_rows[];
extern const int32_t skg_hounsfield_count;
extern const skg_shell_row skg_k_shells[];
extern const int32_t skg_k_shell_count;
extern const skg_shell_row skg_l_shells[];
extern const int32_t skg_l_shell_count;
extern const double skg_log_momenta[SKG_MOMENTA]; /* ln(x / (1/Angstrom)), rising */
extern const skg_scattering_row skg_scattering_rows[SKG_LAST_ELEMENT + 1][SKG_MOMENTA]; /* by atomic number */

#endif
