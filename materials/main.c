/* skg_tables FOLDER OUT.c: writes the tables of FOLDER as one C file. */
#include "tables.h"

#include <stdlib.h>

int main(int count, char **words) {
    if (count != 3) {
        fprintf(stderr, "skg_tables FOLDER OUT.c\n");
        return EXIT_FAILURE;
    }
    FILE *out = fopen(words[2], "w");
    if (!out) {
        perror(words[2]);
        return EXIT_FAILURE;
    }
    fprintf(out, "#include \"materials/rows.h\"\n\n");
    write_cross_sections(words[1], out);
    write_elements(words[1], out);
    write_mixtures(words[1], out);
    write_all_shells(words[1], out);
    write_scattering(words[1], out);
    if (fclose(out) != 0) {
        perror(words[2]);
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}
