/* Trachea and main bronchi. Private. */
#ifndef SKG_AIRWAYS_H
#define SKG_AIRWAYS_H

/* Distance in mm to the airways' walls; < 0 inside. simple: as in the plan. */
double skg_airway_distance(int simple, const double point[3]);

#endif
