#ifndef BENCH_PAPER_IMAGES_H
#define BENCH_PAPER_IMAGES_H

#include "paper/study.h"

/* Sections 4.3.4 to 4.3.6: the cube and cylinder of study->scene under three sources, written to files that
 * begin with study->into. */
void paper_images(const paper_study *study);

#endif
