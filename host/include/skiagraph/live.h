/** @file
 * A scene under one's hands: what the page of the command's `live` and that of scene.live() in a notebook have in common. It reads
 * what a page asks for, decides which plan makes the next image, and writes what pages are told; docs/live.md has the protocol.
 *
 * It opens no sockets and starts no threads. A transport has these: it gives the messages of pages to skg_live_message_create, keeps
 * the scene as the newest wish has it, and sends letters. Included by name. It serves the two transports of this project, and a
 * program that shows the same page.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_LIVE_H
#define SKIAGRAPH_LIVE_H

#include <skiagraph/motion.h>
#include <skiagraph/plan.h>
#include <skiagraph/setup.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A message of a page. It never changes, and its owners are counted atomically. */
typedef struct skg_live_message skg_live_message;

/** Kinds of messages, by their request. */
enum skg_live_asked_kind {
    /** The whole state that is wanted. */
    SKG_LIVE_ASKED_WISH = 0,
    /** A frame has arrived. */
    SKG_LIVE_ASKED_ACK = 1,
    /** The path lengths on the ray of a pixel. */
    SKG_LIVE_ASKED_PROBE = 2,
    /** A file of the image. */
    SKG_LIVE_ASKED_TAKE = 3,
    /** The costs of the dials. */
    SKG_LIVE_ASKED_MEASURE = 4,
    /** A picture of the 3D view. */
    SKG_LIVE_ASKED_LOOK = 5,
    /** A registration. */
    SKG_LIVE_ASKED_REGISTER = 6,
    /** A slice. */
    SKG_LIVE_ASKED_RECONSTRUCT = 7
};

/** Content of a message. The library fills it; prepare with skg_live_asked_init. Its pointers are valid as long as the message. */
typedef struct {
    /** Set by skg_live_asked_init. */
    int32_t size;
    /** enum skg_live_asked_kind */
    int32_t kind;
    /** Number of the wish, of the frame that has arrived, of the look, or of the part to register. */
    int64_t number;
    /** Of a registration or slice: 1: what is under way ends. */
    int32_t stop;
    /** Of a wish: 1: something is being dragged. */
    int32_t drag;
    /** Of a wish: 1: the phase goes on by itself. */
    int32_t play;
    /** Of a wish: enum skg_quantity */
    int32_t quantity;
    /** Of a wish: phase of the breath, 0 to below 1; NaN: as the scene has it. */
    double phase;
    /** Of a wish: the projection of the scan; -1: the scene's own view. */
    int64_t projection;
    /** Of a wish: number of photon-counting bands; 0: one channel of all energies. */
    int64_t bands;
    /** [bands + 1] their edges in keV */
    const double *band_kev;
    /** Of a wish: the band that is shown. */
    int64_t channel;
    /** Of a wish: number of its settings. */
    int64_t setting_count;
    /** [setting_count] "KEY=VALUE", as skg_setup_source.settings */
    const char *const *settings;
    /** Of a wish: number of the parts that it moves. */
    int64_t pose_count;
    /** [pose_count] numbers of these parts */
    const int64_t *parts;
    /** [pose_count][16] what moves them in the world, over their poses, row by row, mm */
    const double *poses;
    /** Of a probe: column and row. */
    double at[2];
    /** Of a file: "png", "tif" or "mha". */
    char take[8];
    /** Of a slice: mm from the centre of rotation, along the axis across it. */
    double at_mm;
    /** Of a slice: 1: all energies; 0: their mean. */
    int32_t spectrum;
    /** Of a slice: 1: with noise. */
    int32_t noise;
    /** Of a slice: 1: with scattered photons. */
    int32_t scatter;
    /** Of a slice: 1: what moves does so during the scan. */
    int32_t motion;
} skg_live_asked;

SKG_INIT(skg_live_asked)

/** Reads a message. All that it may hold is checked, but for what depends on the scene.
 *
 *     text      one JSON object
 *     length    its bytes
 *     message   result; the caller releases it
 *     errors    SKG_ERR_ARGUMENT: the sentence says what is wrong with it, which the page is told as {"refused": sentence} */
SKG_API skg_status skg_live_message_create(const char *text, int64_t length, skg_live_message **message);

/** Makes another wish of one.
 *
 *     changes   a JSON object with the keys of the wish that are others
 *     changed   result; the caller releases it
 *     errors    as skg_live_message_create, or SKG_ERR_ARGUMENT if the message is no wish */
SKG_API skg_status skg_live_message_change(const skg_live_message *wish, const char *changes,
                                           skg_live_message **changed);

/** Adds an owner to a message. */
SKG_API skg_status skg_live_message_retain(skg_live_message *message);

/** Removes an owner; with the last one it is freed. */
SKG_API void skg_live_message_release(skg_live_message **message);

/** Gets what a message says. */
SKG_API skg_status skg_live_message_get(const skg_live_message *message, skg_live_asked *asked);

/** Gets a wish as a page sends it, with all of its keys but "drag".
 *
 *     text     result: JSON, valid as long as the message
 *     errors   SKG_ERR_ARGUMENT if the message is no wish */
SKG_API skg_status skg_live_message_text_get(const skg_live_message *wish, const char **text);

/** Compares two wishes by what plans need.
 *
 *     moved    result: 1: settings differ that move source and detector, which frames of the same plan follow
 *     other    result: 1: other settings differ, or quantity or bands, so that the scene is read again */
SKG_API skg_status skg_live_wish_compare(const skg_live_message *a, const skg_live_message *b, int32_t *moved,
                                         int32_t *other);

/** A message to pages: a text, or bytes. It never changes, and its owners are counted atomically. */
typedef struct skg_live_letter skg_live_letter;

/** Makes a letter of bytes, which are copied.
 *
 *     is_text   1: a text; 0: bytes
 *     letter    result; the caller releases it */
SKG_API skg_status skg_live_letter_create(int32_t is_text, const void *bytes, int64_t count,
                                          skg_live_letter **letter);

/** Adds an owner to a letter. */
SKG_API skg_status skg_live_letter_retain(skg_live_letter *letter);

/** Removes an owner; with the last one it is freed. */
SKG_API void skg_live_letter_release(skg_live_letter **letter);

/** Gets what a letter holds. Each result may be NULL.
 *
 *     is_text   result: 1: a text; 0: bytes
 *     bytes     result: valid as long as the letter; behind a text there is a 0
 *     count     result: number of the bytes, without that 0 */
SKG_API skg_status skg_live_letter_get(const skg_live_letter *letter, int32_t *is_text, const uint8_t **bytes,
                                       int64_t *count);

/** The scene of a page as it stands. Its handles and pointers are the caller's, for the duration of a call. Prepare with
 * skg_live_subject_init; context, scene, spectrum, options and view are needed, unless a call says otherwise. */
typedef struct {
    /** Set by skg_live_subject_init. */
    int32_t size;
    /** 1: the breath stands where the wish has it. 0: a frame poses it. */
    int32_t posed;
    /** The context of the scene's plans. */
    skg_context *context;
    /** The parts. */
    skg_scene *scene;
    /** The beam. */
    skg_spectrum *spectrum;
    /** Options of the scene. Quantity and bands are those of the wish, and the stages are timed. */
    const skg_plan_options *options;
    /** Source and detector without the projection of the wish. */
    const skg_view *view;
    /** Source and detector as the wish has them; NULL: `view`. */
    const skg_view *shown;
    /** The set-up whose parts move from one projection to the next; NULL: none does. */
    const skg_setup *setup;
    /** The scan; NULL: there is none. */
    const skg_scan *scan;
    /** [parts][16] poses before a page moves anything; NULL: those of the scene. */
    const double *poses;
    /** The breath; NULL: the scene does not breathe. */
    skg_motion *motion;
} skg_live_subject;

SKG_INIT(skg_live_subject)

/** Gets where the parts of a scene stand as a wish has them.
 *
 *     poses    result: [parts][16]
 *     errors   SKG_ERR_SCENE (a part that the scene does not have) */
SKG_API skg_status skg_live_poses_get(const skg_live_subject *subject, const skg_live_message *wish,
                                      double *poses);

/** Puts parts and breath of the scene itself where a wish has them, for what has no frames.
 *
 *     errors   as skg_live_poses_get, or SKG_ERR_SCENE if the scene does not breathe */
SKG_API skg_status skg_live_place(const skg_live_subject *subject, const skg_live_message *wish);

/** Gets the box of the parts before a page moves them.
 *
 *     box   result: [2][3] its least and greatest corner, mm */
SKG_API skg_status skg_live_box_get(const skg_live_subject *subject, double *box);

/** Makes the pixels of a view larger: about `factor` of them along a side become one, of the same detector.
 *
 *     factor   1 or more
 *     view     changed */
SKG_API skg_status skg_live_view_coarsen(int64_t factor, skg_view *view);

/** The plans of a scene: one for whole images; one with fewer pixels for images while something is dragged; and some with fewer
 * photons of scatter, whose images come first. They hold the last image. */
typedef struct skg_live_plans skg_live_plans;

/** Makes the plan for whole images of a scene as a wish has it.
 *
 *     plans    result; the caller releases it
 *     errors   as skg_plan_create, SKG_ERR_MEMORY */
SKG_API skg_status skg_live_plans_create(const skg_live_subject *subject, const skg_live_message *wish,
                                         skg_live_plans **plans);

/** Frees the plans. */
SKG_API void skg_live_plans_release(skg_live_plans **plans);

/** Gets the plan for whole images, which lives as long as the plans.
 *
 *     plan   result */
SKG_API skg_status skg_live_plans_whole_get(const skg_live_plans *plans, skg_plan **plan);

/** Asks whether plans can show a wish; otherwise the scene is read again, and its plans are made anew.
 *
 *     fits   result: 1 or 0 */
SKG_API skg_status skg_live_plans_fit(const skg_live_plans *plans, const skg_live_subject *subject,
                                      const skg_live_message *wish, int32_t *fits);

/** Makes the plan for images while something is dragged, if whole images take more than 40 ms or have scatter and there is none yet:
 * with fewer pixels, so that an image takes about as long, and without scatter. Errors: as skg_plan_create. */
SKG_API skg_status skg_live_plans_draft(skg_live_plans *plans, const skg_live_subject *subject);

/** The next images have scatter of few photons, then of more and more, if it takes longer than 0.25 s.
 *
 *     seconds   that the scatter of a whole image took last; 0: unknown */
SKG_API skg_status skg_live_plans_refine(skg_live_plans *plans, double seconds);

/** An image. The library fills it; prepare with skg_live_frame_init. */
typedef struct {
    /** Set by skg_live_frame_init. */
    int32_t size;
    /** 1: there is no image, because progress has cancelled it. */
    int32_t dropped;
    /** 1: made while something is dragged. */
    int32_t draft;
    /** 1: another image of the same wish is wanted when nothing else is: with more photons of scatter, or once more, for its time. */
    int32_t again;
    /** Number of channels. */
    int64_t channels;
    /** Number of columns. */
    int64_t columns;
    /** Number of rows. */
    int64_t rows;
    /** [channel][row][column], valid until the next image; skg_live_frame_write writes what it then holds. */
    float *values;
    /** Time from the pose to the image, ms. */
    double ms;
    /** Time of its scatter, s, if that is as the scene asks for it; otherwise NaN. */
    double scatter_s;
} skg_live_frame;

SKG_INIT(skg_live_frame)

/** Makes the image of a wish. A plan that the scene has outgrown is made anew.
 *
 *     progress   asked again and again whether the image is still wanted: with a total of 0 while the device is waited for, with the
 *                histories of its scatter while that is computed. One that cancels drops the image. An image that takes
 *                less than 60 ms is waited for without it. NULL: none
 *     frame      result
 *     errors     SKG_ERR_SCENE (no breath, no such band, no such part), as skg_plan_submit and skg_job_wait */
SKG_API skg_status skg_live_frame_make(skg_live_plans *plans, const skg_live_subject *subject,
                                       const skg_live_message *wish, skg_progress *progress,
                                       skg_live_frame *frame);

/** Writes the last image as a frame for pages, of the channel of its wish.
 *
 *     number   of the frame
 *     letter   result; the caller releases it
 *     errors   SKG_ERR_ARGUMENT if there is no image */
SKG_API skg_status skg_live_frame_write(const skg_live_plans *plans, int64_t number,
                                        skg_live_letter **letter);

/** Writes an image in the form of a frame.
 *
 *     mark         4 characters with which it begins, such as "SKLR"
 *     quantity     enum skg_quantity
 *     flat_field   in the unit of the values; 0: they are -ln(I/I0)
 *     values       [rows][columns]
 *     letter       result; the caller releases it */
SKG_API skg_status skg_live_image_write(const char *mark, int64_t columns, int64_t rows, int32_t quantity,
                                        double flat_field, const float *values, skg_live_letter **letter);

/** Writes {"shot": number, ...}, the text about the last image.
 *
 *     brief    1: number, wish, ms and phase alone, of an image that differs from the one before by its phase
 *     letter   result; the caller releases it
 *     errors   SKG_ERR_ARGUMENT if there is no image */
SKG_API skg_status skg_live_shot_write(skg_live_plans *plans, const skg_live_subject *subject,
                                       const skg_live_message *wish, int64_t number, int32_t brief,
                                       skg_live_letter **letter);

/** Facts of a scene that a transport knows besides. Prepare with skg_live_facts_init; texts that are NULL are told as null. */
typedef struct {
    /** Set by skg_live_facts_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Differs where the surfaces of two scenes do; the page is of one of them. */
    int64_t geometry;
    /** Of the scene file. */
    const char *path;
    /** The scene file as it is now, JSON. */
    const char *document;
    /** Warnings of the library so far. */
    const char *const *warnings;
    /** Number of these sentences. */
    int64_t warning_count;
    /** Time of reading, ms. */
    double load_ms;
    /** Dose of a frame, JSON. */
    const char *dose;
    /** The radiograph over the image, JSON. */
    const char *fixed;
    /** Why switches of slices change nothing, JSON. */
    const char *without;
} skg_live_facts;

SKG_INIT(skg_live_facts)

/** Writes {"scene": ...}, the text about the scene: its file, what the plan has decided, device, and limits of the controls.
 *
 *     letter   result; the caller releases it */
SKG_API skg_status skg_live_scene_write(skg_live_plans *plans, const skg_live_subject *subject,
                                        const skg_live_message *wish, const skg_live_facts *facts,
                                        skg_live_letter **letter);

/** Writes source, beam and detector as the page draws them, a JSON object.
 *
 *     collimation   jaws; NULL: open
 *     box           [2][3] of the parts, mm, in front of which a source at infinity is drawn
 *     letter        result; the caller releases it
 *     errors        as skg_collimation_corners_get */
SKG_API skg_status skg_live_view_write(const skg_view *view, const skg_collimation *collimation,
                                       const double *box, skg_live_letter **letter);

/** Answers a probe: {"probed": [column, row], "parts": [[label, mm], ...]}, the lengths of the ray to a pixel within each part that it
 * meets.
 *
 *     probe    the message; the pixels are those of the whole detector
 *     letter   result; the caller releases it
 *     errors   SKG_ERR_ARGUMENT (no such pixel), as skg_live_frame_make */
SKG_API skg_status skg_live_probe_write(const skg_live_subject *subject, const skg_live_message *wish,
                                        const skg_live_message *probe, skg_live_letter **letter);

/** Writes the file of a take: the image in keV per pixel, of a plan that is made for it.
 *
 *     take     the message
 *     letter   result; the caller releases it
 *     errors   as skg_live_frame_make and skg_picture_encode */
SKG_API skg_status skg_live_file_write(const skg_live_subject *subject, const skg_live_message *wish,
                                       const skg_live_message *take, skg_live_letter **letter);

/** Writes the picture of a look, with the last image on the detector.
 *
 *     plans    NULL: there is no image yet
 *     look     the message
 *     letter   result; the caller releases it
 *     errors   as skg_scene_picture and skg_live_poses_get */
SKG_API skg_status skg_live_picture_write(skg_live_plans *plans, const skg_live_subject *subject,
                                          const skg_live_message *wish, const skg_live_message *look,
                                          skg_live_letter **letter);

/** Writes the answer to a look that cannot be drawn: a picture without pixels.
 *
 *     letter   result; the caller releases it */
SKG_API skg_status skg_live_picture_miss(const skg_live_message *look, skg_live_letter **letter);

#ifdef __cplusplus
}
#endif
#endif
