/* A material at energies: what `skiagraph material` tabulates. */
#ifndef SKG_CLI_MATTER_H
#define SKG_CLI_MATTER_H

#include <skiagraph/skiagraph.h>

#include <jansson.h>

enum { CLI_PROCESSES = 4 };
extern const char *const cli_processes[CLI_PROCESSES]; /* Rayleigh, Compton, photo, pair */

/* NaN where something is not known. */
typedef struct {
    double kev, mu_rho, process[CLI_PROCESSES], per_cm, hu, naive_per_cm;
} cli_matter_row;

typedef struct {
    skg_material *material, *naive; /* naive: NULL unless asked for */
    const char *name, *note;
    double density;
    int has_parts;        /* elements are known: coefficients by mass */
    int has_per_cm;       /* density, or mu itself, is known */
    double low, high;     /* keV, of the energies asked for */
    cli_matter_row *rows; /* the table */
    int64_t count;
} cli_matter;

/* The energies of absorption edges from m->low to m->high. The caller frees them; NULL: out of memory. */
double *cli_matter_edges(const cli_matter *m, int64_t *count);

/* The table as text on standard output; as JSON, which the caller gives up; as .csv, an empty cell where a
 * number is not known, which the caller frees (NULL: out of memory). */
void cli_matter_print(const cli_matter *m);
json_t *cli_matter_json(const cli_matter *m);
char *cli_matter_csv(const cli_matter *m);

#endif
