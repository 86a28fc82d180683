/* What a call must not take from its caller: a decimal comma, another rounding mode, traps, flushing to zero. Private. */
#ifndef SKG_PLAIN_H
#define SKG_PLAIN_H

#include <fenv.h>
#include <locale.h>

typedef struct {
    fenv_t arithmetic; /* the caller's */
    locale_t numbers;  /* the caller's */
    locale_t c;
} skg_plain;

/* Default arithmetic and the C locale, for this thread only, until skg_plain_leave. */
void skg_plain_enter(skg_plain *plain);
void skg_plain_leave(skg_plain *plain);

/* At the start of a public call that computes, reads or writes numbers: plain until the function returns. */
#define SKG_PLAIN                                                                                            \
    __attribute__((cleanup(skg_plain_leave))) skg_plain skg_caller;                                          \
    skg_plain_enter(&skg_caller)

#endif
