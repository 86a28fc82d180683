/* Keeps the folder of compiled kernels small: the files that were not used for the longest time are removed. Private to
 * lib/device. */
#ifndef SKG_STORE_BOUND_H
#define SKG_STORE_BOUND_H

/* The ending of a file that is being written. */
#define SKG_TEMPORARY ".part"

/* Notes that this open file was used now. Files of the last hour are left alone, so that it costs nothing. */
void skg_store_used(int file);

/* Removes files of the open folder until it holds at most 256 MiB, and what a process that died left half written. Files
 * that are not ours by their name are left alone. */
void skg_store_bound(int folder);

#endif
