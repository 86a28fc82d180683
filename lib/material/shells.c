/* Vacancies that photoelectric absorption leaves in the inner shells of an element. */
#include "material/shells.h"

#include <math.h>

/* The tables of cross sections and of lines differ by a thousandth in their edges. */
static const double SAME_EDGE = 0.01;

const skg_shell_row *skg_shell_lines(int32_t z, int32_t kind) {
    const skg_shell_row *rows = kind == SKG_SHELL_K ? skg_k_shells : skg_l_shells;
    const int32_t count = kind == SKG_SHELL_K ? skg_k_shell_count : skg_l_shell_count;
    for (int32_t i = 0; i < count; i++)
        if (rows[i].z == z) return &rows[i];
    return NULL;
}

/* ln of what is left of the absorption without the shell of an edge, 1/J. */
static double left_at(int32_t knot) {
    return skg_knots[knot - 1].value[SKG_PHOTO] - skg_knots[knot].value[SKG_PHOTO];
}

/* The knot above the edge that is nearest to an energy; 0: none is near. */
static int32_t find_edge(const skg_element_row *row, double edge_kev) {
    double nearest = SAME_EDGE * edge_kev;
    int32_t found = 0;
    for (int32_t k = row->first + 1; k < row->last; k++) {
        const double kev = skg_knots[k].energy_kev;
        if (kev > skg_knots[k - 1].energy_kev || !(fabs(kev - edge_kev) < nearest)) continue;
        nearest = fabs(kev - edge_kev);
        found = k;
    }
    return found;
}

int skg_shell_find(int32_t z, int32_t kind, skg_shell *shell) {
    const skg_element_row *element = &skg_elements[z];
    const skg_shell_row *row = skg_shell_lines(z, kind),
                        *deeper = kind == SKG_SHELL_L ? skg_shell_lines(z, SKG_SHELL_K) : NULL;
    const int32_t first = row ? find_edge(element, row->edge_kev) : 0,
                  above = deeper ? find_edge(element, deeper->edge_kev) : 0,
                  most = kind == SKG_SHELL_L ? SKG_SHELL_EDGES : 1;
    *shell = (skg_shell){.row = row, .kind = kind, .k_edge_kev = HUGE_VAL, .beside_k = 1};
    if (!first) return 0;
    for (int32_t k = first; k < (above ? above : element->last) && shell->count < most; k++) {
        if (skg_knots[k].energy_kev > skg_knots[k - 1].energy_kev) continue;
        const double before = shell->count ? shell->left[shell->count - 1] : 0;
        shell->edge_kev[shell->count] = skg_knots[k].energy_kev;
        shell->left[shell->count++] = before + left_at(k);
    }
    if (above) shell->k_edge_kev = skg_knots[above].energy_kev, shell->beside_k = exp(left_at(above));
    return 1;
}

double skg_shell_vacancies(const skg_shell *shell, double energy_kev) {
    double left = 0;
    for (int32_t e = 0; e < shell->count && energy_kev >= shell->edge_kev[e]; e++) left = shell->left[e];
    return (energy_kev >= shell->k_edge_kev ? shell->beside_k : 1) * -expm1(left);
}
