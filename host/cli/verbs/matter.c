/* The table that `skiagraph material` prints: a material at several energies. */
#include "verbs/matter.h"

#include "common/encode.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

const char *const cli_processes[CLI_PROCESSES] = {"Rayleigh", "Compton", "photo", "pair"};

static void print_parts(const cli_matter *m) {
    int64_t count = 0;
    skg_material_element_count(m->material, &count);
    for (int64_t i = 0; i < count; i++) {
        int32_t z = 0;
        double fraction = 0;
        const char *symbol = "";
        if (skg_material_element_get(m->material, i, &z, &fraction) != SKG_OK ||
            skg_element_symbol_get(z, &symbol) != SKG_OK)
            break;
        printf("%s%s %.6g %%", i == 0 ? "  by mass: " : ", ", symbol, 100 * fraction);
    }
    if (count > 0) putchar('\n');
}

double *cli_matter_edges(const cli_matter *m, int64_t *count) {
    int64_t all = 0;
    *count = 0;
    if (skg_material_edges_get(m->material, 0, NULL, &all) != SKG_OK) return NULL;
    double *edges = calloc((size_t)all + 1, sizeof *edges);
    if (!edges || skg_material_edges_get(m->material, all, edges, &all) != SKG_OK) return edges;
    for (int64_t i = 0; i < all; i++)
        if (edges[i] >= m->low && edges[i] <= m->high) edges[(*count)++] = edges[i];
    return edges;
}

static void print_edges(const cli_matter *m) {
    int64_t count = 0;
    double *edges = cli_matter_edges(m, &count);
    for (int64_t i = 0; i < count; i++) printf("%s%.6g", i == 0 ? "  edges: " : ", ", edges[i]);
    if (count > 0) printf(" keV\n");
    free(edges);
}

/* One cell; a dash if the value is not known. */
static void print_number(double value) {
    if (isfinite(value))
        printf(" %11.5g", value);
    else
        printf(" %11s", "-");
}

void cli_matter_print(const cli_matter *m) {
    printf("%s: ", m->name);
    if (m->density > 0)
        printf("%g g/cm3\n", m->density);
    else
        printf("%s\n", m->has_parts ? "density not known; --density gives one" : "given by its mu");
    if (*m->note) printf("  %s\n", m->note);
    print_parts(m);
    print_edges(m);
    printf("\n%9s %11s", "keV", "mu/rho");
    for (int p = 0; p < CLI_PROCESSES; p++) printf(" %11s", cli_processes[p]);
    printf(" %11s %11s%s\n", "mu", "HU", m->naive ? "    naive mu" : "");
    printf("%9s %11s %11s %11s %11s %11s %11s%s\n", "", "cm2/g", "", "", "", "", "1/cm",
           m->naive ? "                    1/cm" : "");
    for (int64_t i = 0; i < m->count; i++) {
        const cli_matter_row *r = &m->rows[i];
        printf("%9.6g", r->kev);
        print_number(r->mu_rho);
        for (int p = 0; p < CLI_PROCESSES; p++) print_number(r->process[p]);
        print_number(r->per_cm);
        if (isfinite(r->hu))
            printf(" %11.1f", r->hu);
        else
            print_number(r->hu);
        if (m->naive) print_number(r->naive_per_cm);
        putchar('\n');
    }
}

json_t *cli_matter_json(const cli_matter *m) {
    json_t *object = json_object(), *rows = json_array();
    json_object_set_new(object, "name", cli_json_text(m->name));
    json_object_set_new(object, "density_g_cm3", cli_json_number(m->density > 0 ? m->density : (double)NAN));
    json_object_set_new(object, "note", cli_json_text(m->note));
    for (int64_t i = 0; i < m->count; i++) {
        const cli_matter_row *r = &m->rows[i];
        json_t *one = json_object();
        json_object_set_new(one, "energy_keV", cli_json_number(r->kev));
        json_object_set_new(one, "mu_rho_cm2_g", cli_json_number(r->mu_rho));
        json_object_set_new(one, "mu_per_cm", cli_json_number(r->per_cm));
        json_object_set_new(one, "hu", cli_json_number(r->hu));
        for (int p = 0; p < CLI_PROCESSES; p++) {
            char key[32];
            snprintf(key, sizeof key, "%s_cm2_g", cli_processes[p]);
            if (key[0] == 'R' || key[0] == 'C') key[0] = (char)(key[0] - 'A' + 'a');
            json_object_set_new(one, key, cli_json_number(r->process[p]));
        }
        if (m->naive) json_object_set_new(one, "naive_mu_per_cm", cli_json_number(r->naive_per_cm));
        json_array_append_new(rows, one);
    }
    json_object_set_new(object, "rows", rows);
    return object;
}

char *cli_matter_csv(const cli_matter *m) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return NULL;
    fprintf(stream,
            "energy (keV),mu/rho (cm2/g),Rayleigh (cm2/g),Compton (cm2/g),photo (cm2/g),pair (cm2/g),"
            "mu (1/cm),HU%s\n",
            m->naive ? ",naive mu (1/cm)" : "");
    for (int64_t i = 0; i < m->count; i++) {
        const cli_matter_row *r = &m->rows[i];
        const double cells[] = {r->mu_rho,     r->process[0], r->process[1], r->process[2],
                                r->process[3], r->per_cm,     r->hu,         r->naive_per_cm};
        fprintf(stream, "%.10g", r->kev);
        for (int c = 0; c < (m->naive ? 8 : 7); c++)
            fprintf(stream, isfinite(cells[c]) ? ",%.10g" : ",", cells[c]);
        fputc('\n', stream);
    }
    if (fclose(stream) == 0) return text;
    free(text);
    return NULL;
}
