/* Keeps what the caller has the process do on each signal. Private.
 *
 * Drivers install handlers of their own: LLVM inside PoCL and inside Intel's runtime replaces 15 dispositions, among them
 * those of SIGUSR1 and SIGXCPU, by which batch systems ask for a checkpoint. */
#ifndef SKG_SIGNALS_H
#define SKG_SIGNALS_H

/* Notes the dispositions of all signals, if no other thread is between these two calls; and restores those that have
 * changed since they were noted. Each keep needs its restore. A change that another thread of the program makes in between
 * is lost. */
void skg_signals_keep(void);
void skg_signals_restore(void);

#endif
