/* Frames to be made with a recipe and a machine: checked, enqueued and read back. Private. */
#ifndef SKG_SUBMISSION_H
#define SKG_SUBMISSION_H

#include "frame/job.h"

typedef struct {
    const skg_recipe *recipe;
    skg_machine *machine;
    skg_outcome *outcome;
    int64_t count;
    const skg_frame *frames; /* as the caller gave them; NULL: as the scene stands */
    skg_output output;       /* checked; strides filled in */
    int64_t channels;
    int64_t lengths_of; /* a part; -1: images */
    int32_t kind;       /* of lengths */
    int32_t reserved;
    cl_mem buffer; /* NULL: host memory */
    int64_t first; /* element of the buffer where the first frame begins */
} skg_submission;

/* Checks count and output, and fills in output and channels. */
skg_status skg_submission_check(skg_submission *submission, const skg_output *output);

/* Bytes of an element of the output. */
int64_t skg_submission_element(const skg_submission *submission);

/* Enqueues everything. After a failure nothing is under way, and *job is not set. */
skg_status skg_submission_enqueue(const skg_submission *submission, skg_job **job);

#endif
