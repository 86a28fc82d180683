/* Derivatives that are known: tests of gradient_edges_test in a file of their own. */
#ifndef SKG_TESTS_GRADIENT_CLOSED_H
#define SKG_TESTS_GRADIENT_CLOSED_H

#include "suite.h"

void add_closed_tests(TCase *tests);

#endif
