/* Pictures as DICOM files (Computed Radiography Image Storage) by the programs of DCMTK. Functions that return int return an
 * exit status and print the error. */
#ifndef SKG_CLI_DICOM_H
#define SKG_CLI_DICOM_H

#include <skiagraph/skiagraph.h>

/* Attributes of a DICOM file that a picture does not have. */
typedef struct {
    const char *study;  /* the same text for pictures that belong to one study and series */
    int64_t number;     /* of the picture in its series, from 1 */
    double kvp;         /* the highest energy of the beam; 0: not known */
    double patient_mm;  /* from the source to the middle of the parts; 0: not known */
    const char *beside; /* what else the comment says; NULL: nothing */
} cli_dicom_facts;

/* Whether a path ends in .dcm. */
int cli_dicom_is(const char *path);

/* Refuses, before anything is computed, a .dcm that could not be written. */
int cli_dicom_check(const char *path);

/* Writes a picture of one channel as stored values of 16 bits, value = stored * slope + intercept. The file appears whole or not at all, and
 * its bytes, identifiers included, depend on nothing but picture and facts.
 *
 * step   result: the slope, which is at most the picture's range / 65535; may be NULL */
int cli_dicom_save(const skg_picture *picture, const cli_dicom_facts *facts, const char *path, double *step);

/* Reads a frame of a grey DICOM file as numbers (stored * slope + intercept), compressed by JPEG, JPEG-LS or run lengths, or not.
 *
 * page       0 <= page < contents->pages
 * contents   prepared with skg_picture_contents_init; its quantity is -1 where the file does not say it
 * values     [rows][columns]; NULL: only the contents */
int cli_dicom_read(const char *path, int64_t page, skg_picture_contents *contents, double *values);

/* Of a scene: kvp and patient_mm. */
skg_status cli_dicom_facts_of(const skg_scene *scene, const skg_spectrum *spectrum, const skg_view *view,
                              cli_dicom_facts *facts);

#endif
