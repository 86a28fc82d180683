/* The settings that the parts of the paper's study share, and their CSV file. */
#include "paper/study.h"

#include <inttypes.h>

void paper_row(const paper_study *study, const char *part, const char *what, int64_t at, long series,
               double value, const char *unit) {
    if (study->csv)
        fprintf(study->csv, "%s,%s,%" PRId64 ",%ld,%.9g,%s\n", part, what, at, series, value, unit);
}
