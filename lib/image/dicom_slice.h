/* One file of DICOM: what it says of a slice, and its pixels. Private. */
#ifndef SKG_DICOM_SLICE_H
#define SKG_DICOM_SLICE_H

#include "core/core.h"

#include <stdio.h>

/* DICOM's texts and identifiers have at most 64 characters. */
enum { SKG_DICOM_TEXT = 65 };

/* Attributes of one or several numbers, in the order of their tags; of each the numbers that a slice has. */
enum skg_dicom_numbers {
    SKG_DICOM_PLACE, /* ImagePositionPatient: of the first pixel's centre, mm to the left, back and head */
    SKG_DICOM_ORIENTATION, /* ImageOrientationPatient: along columns and along rows, unit vectors */
    SKG_DICOM_SAMPLES,     /* SamplesPerPixel */
    SKG_DICOM_FRAMES,      /* NumberOfFrames */
    SKG_DICOM_ROWS,
    SKG_DICOM_COLUMNS,
    SKG_DICOM_SPACING,   /* PixelSpacing: from row to row, from column to column, mm */
    SKG_DICOM_ALLOCATED, /* BitsAllocated */
    SKG_DICOM_STORED,    /* BitsStored */
    SKG_DICOM_HIGH,      /* HighBit */
    SKG_DICOM_SIGNED,    /* PixelRepresentation */
    SKG_DICOM_INTERCEPT, /* RescaleIntercept */
    SKG_DICOM_SLOPE,     /* RescaleSlope */
    SKG_DICOM_NUMBERS
};

typedef struct {
    const char *path; /* set by the caller */
    char syntax[SKG_DICOM_TEXT], series[SKG_DICOM_TEXT], description[SKG_DICOM_TEXT],
        modality[SKG_DICOM_TEXT],
        scale[SKG_DICOM_TEXT];        /* scale: RescaleType, what its values are; empty: it does not say */
    int has_table;                    /* 1: its values stand in a table (ModalityLUTSequence) */
    int is_directory;                 /* 1: it lists other files (DICOMDIR), and is of no series */
    int32_t count[SKG_DICOM_NUMBERS]; /* numbers that it has; 0: the file does not have the attribute */
    double numbers[SKG_DICOM_NUMBERS][6];
    /* where they stand in the file, and their bytes, -1: in parts; pixels 0: there are none */
    int64_t pixels, pixel_bytes;
} skg_dicom_slice;

/* The first number of an attribute, or what stands for it. */
double skg_dicom_number(const skg_dicom_slice *slice, enum skg_dicom_numbers which, double otherwise);

/* Reads what a file says.
 *
 * is_dicom   result: 0: the file does not begin as one of DICOM
 * errors     SKG_ERR_FORMAT: it ends within what it says; SKG_ERR_UNSUPPORTED: its numbers are not the least significant byte first */
skg_status skg_dicom_slice_read(const char *path, int *is_dicom, skg_dicom_slice *slice);

/* Fails unless its pixels can be read: SKG_ERR_UNSUPPORTED: they are compressed, or of a kind that no slice has; SKG_ERR_FORMAT: there are
 * too few or too many. */
skg_status skg_dicom_slice_check(const skg_dicom_slice *slice);

/* Reads the values of its pixels, rescaled: [rows][columns]. Errors as above. */
skg_status skg_dicom_slice_values(const skg_dicom_slice *slice, double *values);

#endif
