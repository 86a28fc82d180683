/* The plans of a page's scene, and its last image. Private. */
#ifndef SKG_LIVE_PLANS_H
#define SKG_LIVE_PLANS_H

#include "live/inside.h"

/* Plans with fewer histories of scatter than the scene asks for, whose images come first. */
enum { SKG_LIVE_STEPS = 5 };

enum {
    SKG_LIVE_DRAFT = 1,    /* made while something is dragged */
    SKG_LIVE_INFINITE = 2, /* some values are not finite */
    SKG_LIVE_RANGE = 4,    /* path lengths outside the verified range */
    SKG_LIVE_REFINES = 8   /* an image with more photons of scatter follows */
};

/* The head of a frame, in the order of the processor; [rows][columns] numbers of 16 bits follow. A value is
 * low + step * number. */
typedef struct {
    char mark[4];    /* "SKLF" */
    uint32_t number; /* of the frame */
    uint32_t wish;   /* of the wish that it shows */
    uint16_t columns, rows;
    double low, step;
    double flat_field; /* of the values' unit; 0: the values are -ln(I/I0) */
    float ms;          /* from the pose to the image */
    uint16_t factor;   /* pixels of the detector for each of the frame, along a side */
    uint8_t quantity;  /* enum skg_quantity */
    uint8_t notes;     /* SKG_LIVE_DRAFT, ... */
} skg_live_header;

struct skg_live_plans {
    skg_live_message *wish;  /* with which they were made */
    skg_view view;           /* likewise */
    int is_posed;            /* 1: a frame has moved the meshes */
    skg_plan *whole, *draft; /* draft: NULL: the whole one serves */
    int is_drafted;          /* 1: a draft was made, or could not be */
    int64_t factor;          /* pixels of the detector for each of the draft, along a side */
    /* step: of the next image; SKG_LIVE_STEPS: it is made by `whole`. steps: NULL: not made yet */
    skg_plan *steps[SKG_LIVE_STEPS];
    int step;
    skg_channel channel; /* the first one */
    int64_t channels;
    double plan_ms;
    /* of the last whole image but the first, for which kernels are made; 0: there is none yet */
    double frame_ms;
    int64_t images; /* whole ones so far */
    float *values;  /* [channels][rows][columns] */
    int is_shown;   /* 1: `values` is an image, by these: */
    const skg_plan *shown_plan;
    skg_view shown;
    skg_live_header header;
    int64_t shown_channel;
    double ms;
    double box[6]; /* of the parts, if has_box */
    int has_box;
    skg_view beam_view; /* of `beam`; all 0: not computed yet */
    skg_quality beam;   /* the open beam, cached because it takes 0.1 ms */
    int has_beam;
};

/* Reads a caller's subject and checks that it has a scene, with a context, spectrum, options and view to plan with. */
skg_status skg_live_subject_read(const skg_live_subject *theirs, skg_live_subject *subject);

/* The options of a plan for a wish. */
skg_status skg_live_options(const skg_live_subject *subject, const skg_live_message *wish,
                            skg_plan_options *options);

/* The plan of the next whole image: that of a step of scatter, if there are steps. */
skg_status skg_live_step(skg_live_plans *plans, const skg_live_subject *subject, skg_plan **plan);

/* Plans anew by another view, after the scene has outgrown the plans. */
skg_status skg_live_anew(skg_live_plans *plans, const skg_live_subject *subject, const skg_live_message *wish,
                         const skg_view *view);

/* The parts that a frame moves. */
typedef struct {
    int64_t *parts, count;
    double *poses; /* [count][16] */
} skg_live_moves;

/* Lists them; skg_live_moves_free also after a failure. */
skg_status skg_live_moves_list(const skg_live_subject *subject, const skg_live_message *wish,
                               skg_live_moves *moves);
void skg_live_moves_free(skg_live_moves *moves);

/* Poses the breath of a wish, unless it stands there. */
skg_status skg_live_breathe(const skg_live_subject *subject, const skg_live_message *wish);

/* Renders a wish with a plan and waits. progress: as of skg_live_frame_make; NULL: none. frame_ms: what it takes; 0: unknown. Returns SKG_RANGE and SKG_STALE as skg_plan_submit and skg_job_wait do. */
typedef struct {
    skg_plan *plan;
    const skg_view *view;
    const skg_output *outputs;
    int64_t output_count;
    skg_progress *progress;
    double frame_ms;
} skg_live_rendering;
skg_status skg_live_render(const skg_live_subject *subject, const skg_live_message *wish,
                           const skg_live_rendering *how, int *is_dropped);

/* Header and 16-bit numbers of values. low, step and SKG_LIVE_INFINITE are written into the header. */
skg_status skg_live_pack(const float *values, skg_live_header *header, skg_live_letter **letter);

/* The box of the parts, found once. */
skg_status skg_live_box_find(skg_live_plans *plans, const skg_live_subject *subject);

#endif
