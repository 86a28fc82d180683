/* Photons that are followed one by one through the pixels of a sensor: all scattering, and fluorescence until it ends. */
#ifndef COUNTER_PHOTONS_H
#define COUNTER_PHOTONS_H

#include "material/material.h"

#include <stdint.h>

enum { REACH = 20, SIDE = 2 * REACH + 1, PIXELS = SIDE * SIDE, MIDDLE = PIXELS / 2 };
enum { WINDOWS = 3 };

/* A sensor and its beam. */
typedef struct {
    const char *name;
    double mm, pixel_mm, bias_v, cloud_mm, noise_kev, kev, thresholds[WINDOWS];
    int anti_coincidence;
} sensor;

/* A photon on its way, and the charge of its history by pixel. */
typedef struct {
    const sensor *s;
    const skg_material *material;
    double at[3], way[3], kev;
    double charge[PIXELS];
    uint64_t seed;
} history;

/* A number from 0 to 1; a normal deviate. */
double number(history *h);
double normal(history *h);

/* Follows a photon of the beam that enters the middle pixel somewhere; its charge is that of all pixels. */
void follow_photon(history *h);

/* The window of a pulse, or -1. */
int window_of(const sensor *s, double kev);

#endif
