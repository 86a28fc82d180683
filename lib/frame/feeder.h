/* Goes on with a job while its program neither asks for it nor waits. Private. */
#ifndef SKG_FEEDER_H
#define SKG_FEEDER_H

#include "frame/jobs.h"

/* The last thing that a public call does which submits a job and does not wait for it. Starts a thread if some steps of the job are
 * not enqueued yet. The thread takes turns with the calls of the program, and ends when all steps are enqueued, or the job failed or was
 * cancelled. If there is no thread to be had, the device may be idle until the job is asked for. Returns status, that of the submission;
 * after a failure there is no job. */
skg_status skg_feeder_start(skg_status status, skg_job *const *job);

#endif
