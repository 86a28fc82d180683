/* Calls that fail on demand: host allocations of the library (also those it makes through Jansson) and OpenCL
 * calls, by wrapping them at link time (failing_wrap.cmake lists them). Also counts what is alive. */
#ifndef SKG_TESTS_FAILING_CALLS_H
#define SKG_TESTS_FAILING_CALLS_H

#include <stdint.h>

enum { FAIL_ALLOCATION, FAIL_OPENCL };

/* From now on calls of this kind are counted from 0, and number `at` fails (-1: none); only that one. */
void failing_start(int kind, int64_t at);

/* Counts no more; returns how many calls there were. */
int64_t failing_stop(void);

/* Name of the call that failed since failing_start; NULL: none did. */
const char *failing_hit(void);

/* Of the calls of the last run in which none was to fail: 1 where nobody has asked yet about a call from the
 * place in the program that call `at` came from. */
int failing_is_new(int64_t at);

/* Appends to a file the addresses, hexadecimal and relative to the program's start, to which the counted calls
 * return: one a line. */
void failing_write_sites(const char *path);

/* Blocks and OpenCL objects that the library holds. */
int64_t failing_live_blocks(void);
int64_t failing_live_objects(void);

#endif
