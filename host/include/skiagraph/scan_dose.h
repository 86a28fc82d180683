/** @file
 * The dose of a scan: of all its projections together.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_SCAN_DOSE_H
#define SKIAGRAPH_SCAN_DOSE_H

#include <skiagraph/dose.h>
#include <skiagraph/scan.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Finds what all projections of a scan give together (skg_dose_sum).
 *
 *     plan      of the scene, whose view is then that of the first projection
 *     scan      where source and detector are
 *     options   NULL: the defaults. Histories are those of the whole scan. Without places there is one, where the middle ray of the
 *               first projection enters the first part; air kerma there is that of all projections
 *     dose      result; the caller releases it
 *     errors    those of skg_dose_create; SKG_ERR_UNSUPPORTED if the plan cannot have the view of a projection
 *
 * method   Of more than 64 projections, 64 at equal distances are followed, and each stands for its share of all. All have the intensity
 *          of the first one, and parts stand where they are in the scene. */
SKG_API skg_status skg_scan_dose_create(skg_plan *plan, const skg_scan *scan, const skg_dose_options *options,
                                        skg_dose **dose);

#ifdef __cplusplus
}
#endif
#endif
