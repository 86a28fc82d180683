/* Drivers that would end the process. Private. */
#ifndef SKG_FAULTS_H
#define SKG_FAULTS_H

#include <skiagraph/context.h>

/* 0, or the PoCL whose compiler fails on this processor.
 *
 * PoCL before 3.1, if it is built for many processors, takes its library of built-in functions by what the processor can do, and
 * the machine to compile for by LLVM's name of the processor. An LLVM that is older than the processor takes it for an older one,
 * without AVX-512 (Zen 4 for "znver3"), or for "generic". Functions with and without AVX-512 then meet in one kernel, and LLVM
 * ends the process: "Cannot emit physreg copy instruction".
 * has_avx512: whether the processor has AVX-512. */
int skg_pocl_fails(const skg_device_info *info, int has_avx512);

/* SKG_ERR_DEVICE if the device's driver is known to end the process on this processor. */
skg_status skg_faults_check(const skg_device_info *info);

#endif
