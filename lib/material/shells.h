/* Vacancies that photoelectric absorption leaves in the inner shells of an element. Private. */
#ifndef SKG_SHELLS_H
#define SKG_SHELLS_H

#include "core/core.h"
#include "materials/rows.h"

enum { SKG_SHELL_K = 0, SKG_SHELL_L = 1, SKG_SHELLS = 2 };

/* Lines of lighter elements than this, below 9 keV, hardly leave a part; scatter follows them on request alone. */
enum { SKG_FLUORESCENCE_LIGHTEST = 30 };

/* L1, L2 and L3. */
enum { SKG_SHELL_EDGES = 3 };

/* A shell whose lines are in the tables. */
typedef struct {
    const skg_shell_row *row;
    int32_t kind, count; /* SKG_SHELL_...; of edges */
    /* of the cross sections, rising; the tables of lines round differently */
    double edge_kev[SKG_SHELL_EDGES];
    /* ln of the share of absorption above an edge that is neither its subshell's nor a lower edge's */
    double left[SKG_SHELL_EDGES];
    /* of L: the K edge, and the share of absorption above it that is not the K shell's */
    double k_edge_kev, beside_k;
} skg_shell;

/* The lines of a shell of an element; NULL: they are not in the tables. */
const skg_shell_row *skg_shell_lines(int32_t z, int32_t kind);

/* Finds a shell of an element. Returns 0 if its lines or its edge are not in the tables. */
int skg_shell_find(int32_t z, int32_t kind, skg_shell *shell);

/* The share of an element's photoelectric absorption that leaves a vacancy in the shell, by the jumps of the cross section at the
 * edges: 1 - 1/J, of what the shells above it leave. What moves there from K is not counted. */
double skg_shell_vacancies(const skg_shell *shell, double energy_kev);

#endif
