/* Dense doubles in host memory as an output, for derivatives along directions. */
#ifndef SKG_TESTS_DOUBLES_H
#define SKG_TESTS_DOUBLES_H

#include <skiagraph/frame.h>

#define DOUBLES(memory)                                                                                      \
    (&(skg_output){.size = sizeof(skg_output), .type = SKG_TYPE_FLOAT64, .data = (memory)})

#endif
