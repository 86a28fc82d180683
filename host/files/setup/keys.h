/* The keys of scene files: one row for each, from which a file is read, an unknown key is refused and the JSON Schema is made. Private.
 *
 * A row has the key's name, the form of its value, and a sentence. A form is one of these, or several with " | " between them:
 *
 *   flag, text, null, any             true or false (also 1 and 0), a string, null, whatever it is
 *   number 0<..1, integer 1..16       within limits, of which either may be absent; < : without the limit itself
 *   words a, b, c                     one of these, compared as keys are
 *   numbers 3, numbers                so many numbers in an array; any number of them
 *   lengths 3                         so many numbers and a unit of length
 *   rows 2, rows                      arrays of so many numbers; of any
 *   pair FORM, list FORM              an array of two, of any number of them; a list takes all that follows it
 *   object NAME, map FORM             an object with the keys of that table; one with any keys
 *   length, unit, energy_unit, material, transformation, spot, filter, rectangle, ...: forms with a name of their own (schema.c) */
#ifndef SKG_SETUP_KEYS_H
#define SKG_SETUP_KEYS_H

#include "json/json.h"

#define SKG_KEY(name, form, says)                                                                            \
    { name, NULL, SKG_KEY_READ, form, says }
/* Another spelling of a key. */
#define SKG_ALSO(name, key)                                                                                  \
    { name, key, SKG_KEY_READ, NULL, NULL }
/* Concerns the display only. */
#define SKG_ASIDE(name)                                                                                      \
    { name, NULL, SKG_KEY_IGNORED, "any", NULL }
#define SKG_TABLE(its, called, rows) const skg_json_table its = {called, rows, sizeof(rows) / sizeof *(rows)}

extern const skg_json_table skg_keys_scene, skg_keys_world, skg_keys_noise, skg_keys_collimation,
    skg_keys_scatter;
extern const skg_json_table skg_keys_source, skg_keys_off_focal, skg_keys_heel, skg_keys_bowtie,
    skg_keys_channel, skg_keys_beam;
extern const skg_json_table skg_keys_detector, skg_keys_counting, skg_keys_curved, skg_keys_grid,
    skg_keys_response, skg_keys_pulses, skg_keys_scintillator, skg_keys_depth, skg_keys_grey_values,
    skg_keys_pixel_map;
extern const skg_json_table skg_keys_sample, skg_keys_step_wedge;
extern const skg_json_table skg_keys_scan, skg_keys_drift, skg_keys_jitter, skg_keys_fields;
extern const skg_json_table skg_keys_breathing, skg_keys_organ, skg_keys_link, skg_keys_event,
    skg_keys_body_fit;

#endif
