/* Trachea and main bronchi. Private. */
#ifndef SKG_AIRWAYS_H
#define SKG_AIRWAYS_H

/* Distance in mm to the airways' walls; < 0 inside. */
double skg_airway_distance(const double point[3]);

#endif
