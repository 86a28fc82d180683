/* The table that `skiagraph material` prints: a material at several energies. */
#ifndef SKG_CLI_MATTER_H
#define SKG_CLI_MATTER_H

#include <skiagraph/skiagraph.h>

#include <jansson.h>

enum { CLI_PROCESSES = 4 };
extern const char *const cli_processes[CLI_PROCESSES]; /* Rayleigh, Compton, photo, pair */

/* A value that is not known is NaN. */
typedef struct {
    double kev, mu_rho, process[CLI_PROCESSES], per_cm, hu, naive_per_cm;
} cli_matter_row;

typedef struct {
    skg_material *material, *naive; /* naive: of --naive, or NULL */
    const char *name, *note;
    double density;
    int has_parts;        /* its elements are known, and so the coefficients by mass */
    int has_per_cm;       /* its density, or mu itself, is known */
    double low, high;     /* keV, the range of the rows */
    cli_matter_row *rows; /* the table */
    int64_t count;
} cli_matter;

/* The energies of absorption edges from m->low to m->high, which the caller frees; NULL if memory is
 * exhausted. */
double *cli_matter_edges(const cli_matter *m, int64_t *count);

void cli_matter_print(const cli_matter *m);
json_t *cli_matter_json(const cli_matter *m);

/* The caller frees the text; NULL if memory is exhausted. The cell of a value that is not known is empty. */
char *cli_matter_csv(const cli_matter *m);

#endif
