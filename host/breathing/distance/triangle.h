/* The point of a triangle that is nearest to another point. Private. */
#ifndef SKG_DISTANCE_TRIANGLE_H
#define SKG_DISTANCE_TRIANGLE_H

/* Weights of the corners a, b and c at the point of their triangle that is nearest to p. */
void skg_triangle_nearest(const double *a, const double *b, const double *c, const double *p,
                          double weights[3]);

#endif
