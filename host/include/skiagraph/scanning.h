/** @file
 * Scanning: the views of a CT scan, its run, its files and its dose, the readout of the detector, and the reconstruction of a volume.
 * Includes the headers of these.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_SCANNING_H
#define SKIAGRAPH_SCANNING_H

#include <skiagraph/readout.h>
#include <skiagraph/reconstruct.h>
#include <skiagraph/scan.h>
#include <skiagraph/scan_dose.h>
#include <skiagraph/scan_file.h>
#include <skiagraph/scan_reader.h>
#include <skiagraph/scan_run.h>

#endif
