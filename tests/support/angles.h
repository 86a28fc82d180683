/* pi, and a degree in radians. */
#ifndef SKG_TESTS_ANGLES_H
#define SKG_TESTS_ANGLES_H

static const double pi = 3.14159265358979323846, degree = 3.14159265358979323846 / 180;

#endif
