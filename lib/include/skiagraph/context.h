/** @file
 * A context: one OpenCL device with its queue and its compiled programs, and where warnings go.
 *
 * Making a context takes about 200 ms, and the first plan on it compiles kernels. Make one and keep it.
 *
 * Compiled kernels are cached for later processes in the folder that the environment variable SKG_CACHE_DIR names, by
 * default skiagraph in $XDG_CACHE_HOME or .cache/skiagraph in $HOME; SKG_CACHE_DIR=none keeps nothing. The folder has to
 * belong to the user, and nobody else may write to it. It is made if need be, and holds at most 256 MiB. A folder that
 * cannot be used is no failure: kernels are compiled then. Kernels are cached when the first job that used them is done.
 * PoCL keeps kernels itself, in the folder that POCL_CACHE_DIR names, and would have to compile them a second time for ours;
 * there, the 20th process that uses a kernel keeps it, or the first if POCL_KERNEL_CACHE=0 turns PoCL's folder off. When
 * compiling takes longer than a second, the log gets a line of level SKG_LOG_PROGRESS.
 *
 * Threads: a context, and the plans and jobs made on it, are used by one thread at a time. Different contexts
 * may be used by different threads at the same time. Materials, spectra and responses never change and may be
 * shared by threads; so may meshes and scenes while nobody changes them. Reference counts are atomic.
 *
 * fork: OpenCL does not survive it. In a child of a process in which the library has used OpenCL, every call that
 * would use it (skg_context_create, skg_device_count, and calls on a context made before) returns SKG_ERR_FORK;
 * releasing such a context frees host memory only. Start the child by exec or spawn, or fork before the first
 * call. The library cannot know whether another library has started OpenCL before the fork; then its calls hang.
 * Neither does OpenMP survive it, which the library uses for the thorax, bodies, fits, distances and reconstruction: in a child
 * of a process that has made such a call with more than one thread, they return SKG_ERR_FORK too.
 *
 * Start: the first call that uses OpenCL starts the drivers of all platforms, in a thread made for this. The
 * threads that drivers make then have the default floating-point environment, and no signals sent to the process
 * are delivered to them. They may run on the CPUs of the thread that calls; where OpenMP has bound that thread
 * (OMP_PROC_BIND, OMP_PLACES, GOMP_CPU_AFFINITY), on all CPUs of OpenMP's places. The caller's thread keeps its
 * own CPUs, signal mask and floating-point environment.
 *
 * Signals: drivers install signal handlers of their own. The library restores the caller's handlers when a driver
 * was started, when a program was compiled and when it first ran. A handler that another thread installs during
 * such a call may be lost, and a signal that arrives during it may meet the driver's handler.
 *
 * dlclose: the library stays in memory, because threads of OpenMP and of drivers still need it.
 *
 * The library never changes the environment of the process and never binds the caller's threads to cores. PoCL
 * sets HWLOC_PLUGINS_PATH when it is started.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_CONTEXT_H
#define SKIAGRAPH_CONTEXT_H

#include <skiagraph/error.h>

#ifdef __cplusplus
extern "C" {
#endif

/** One device, its queue and its compiled programs. */
typedef struct skg_context skg_context;

/** Opens a device.
 *
 *     config    words separated by blanks, or NULL:
 *                 device=cpu | gpu | PLATFORM:DEVICE | part of a device's name
 *                              (numbers as in skg_device_info)
 *                 driver=PATH  choose among the devices of this OpenCL driver, which the OpenCL loader need
 *                              not know: its library, such as /opt/pocl/lib/libpocl.so.2, or a name that the
 *                              dynamic linker finds
 *                 threads=N    use N compute units, through a sub-device where the platform offers them;
 *                              without it work is divided for the CPUs that the process may run on (see
 *                              Start); if the driver has made 8 or more threads for each of these, the log
 *                              has a warning that names the driver's environment variable
 *                 kernels=DIR  read the kernels from DIR, or its folders as in kernels/, instead of those
 *                              built in, for development
 *               A value that holds blanks stands in double quotes: driver="/opt/my drivers/libpocl.so"
 *     context   result; the caller releases it
 *     errors    SKG_ERR_ARGUMENT (a word), SKG_ERR_NO_DEVICE (also: PATH is no driver), SKG_ERR_DEVICE,
 *               SKG_ERR_FORK
 *
 * The environment variable SKG_DEVICE holds such words, or the value of device= alone. It gives what config does
 * not; but its driver= is ignored if config has device= and no driver=. Without device= the best device is taken:
 * GPUs before CPUs, then the faster one if both were measured, otherwise the one with more compute units. The
 * environment variable SKG_KERNEL_DIR stands for kernels=.
 *
 * A driver that driver= opens stays loaded until the process ends, because its threads run. From then on
 * skg_device_count and skg_device_get list its devices behind the others, and device=PLATFORM:DEVICE may name them;
 * other words choose them only with driver=. A driver that the loader knows as well is not listed twice. Drivers that
 * need a loader of cl_khr_icd version 2 are refused.
 *
 * Some drivers end, crash or block the process that calls them. Therefore a device of a platform that this version of the
 * library does not know (skg_device_info.known) is chosen without being named, or for device=cpu or device=gpu, only if
 * it has passed its test on this machine and the verdict is cached in SKG_CACHE_DIR; until then the library reads no
 * more of such a platform than its name. `skiagraph devices` tests such devices in processes of their own, each for 30 s at
 * most. Naming one by number or name is the caller's decision: if it was not tested (skg_device_untested), its driver is tested in
 * the caller's process, and may end or block it. The same holds for skg_device_count, skg_device_get and
 * skg_device_test_run, which ask every platform. The OpenCL loader itself loads every driver that is installed, and asks it
 * for its platforms and devices; the environment variable OCL_ICD_VENDORS restricts it to one driver.
 *
 * Some drivers compute wrongly and report no error. The first time that a device with its driver is used, a small
 * scene whose path lengths are known is rendered, its speed is measured, and the verdict is cached in SKG_CACHE_DIR.
 * A device that fails is refused with a sentence, and the next one that the words allow is taken, with a warning.
 * Kernels that not every plan needs are tested when skg_plan_create needs them first; if they fail, it returns
 * SKG_ERR_DEVICE. Where nothing can be cached, every context tests its device. Not tested are a device that is given
 * to skg_context_create_cl, as far as every plan's kernels are concerned, simulators, and kernels from kernels=. */
SKG_API skg_status skg_context_create(const char *config, skg_context **context);

/** Adds an owner to a context. */
SKG_API skg_status skg_context_retain(skg_context *context);

/** Removes an owner; the last one frees the context. Like every release it takes the handle's address, sets
 * the handle to NULL, accepts NULL and cannot fail. */
SKG_API void skg_context_release(skg_context **context);

/** Levels of the lines of the log. */
enum skg_log_level {
    /** Something about the result that the caller should know. */
    SKG_LOG_WARNING = 1,
    /** Something that was decided or assumed. */
    SKG_LOG_NOTE = 2,
    /** How far a long computation is. */
    SKG_LOG_PROGRESS = 3
};

/** Receives one line of the log. The library calls it during a call that uses the context, in the thread of that call. It must
 * not call the library with the same context.
 *
 *     level      enum skg_log_level
 *     sentence   one sentence without a newline, valid during the call only
 *     user       as given to skg_context_log_set */
typedef void (*skg_log_function)(int32_t level, const char *sentence, void *user);

/** Sets where the lines of a context's log go. NULL, the default, drops them. */
SKG_API skg_status skg_context_log_set(skg_context *context, skg_log_function log, void *user);

/** Ends what skg_plan_create, skg_plan_update and calls that make a plan anew compute with this context while they find the number of
 * samples of an extended source: such a call returns SKG_ERR_CANCELLED within half a second. For any other thread and for a signal
 * handler; jobs have skg_job_cancel. Where nothing is looked for it does nothing, and what begins later is not ended: call it
 * until the other call is back. Errors: SKG_ERR_ARGUMENT for NULL. */
SKG_API skg_status skg_context_interrupt(skg_context *context);

/** Receives a failure. The library calls it once for each call that fails, just before that call returns, in the thread of that
 * call. It must not call the library with the same context.
 *
 *     status     the negative status that the call returns; SKG_STALE and SKG_RANGE are no failures
 *     sentence   what skg_last_error gives; valid during the call only
 *     user       as given to skg_context_error_set */
typedef void (*skg_error_function)(skg_status status, const char *sentence, void *user);

/** Sets the function that receives the failures of calls that take this context, or a plan or a job of it. Exceptions: calls
 * that only take or read a handle (_retain, _get, _count), the setters of a context, skg_job_cancel, and skg_scan_run_each, whose
 * function may call the library: the calls that it makes report. NULL, the default: none. */
SKG_API skg_status skg_context_error_set(skg_context *context, skg_error_function error, void *user);

/** A device of OpenCL. The library fills it; prepare with skg_device_info_init. */
typedef struct {
    /** Set by skg_device_info_init. */
    int32_t size;
    /** Number of the platform for device=PLATFORM:DEVICE; -1: the caller's own device. */
    int32_t platform;
    /** Number of the device on its platform; -1: the caller's own device. */
    int32_t device;
    /** 1: a GPU. */
    int32_t gpu;
    /** 1: a CPU. */
    int32_t cpu;
    /** Number of compute units; of a context, those for which work is divided. */
    int32_t compute_units;
    /** 1: has fp64, which SKG_PRECISION_DOUBLE and SKG_TYPE_FLOAT64 need. */
    int32_t double_precision;
    /** 1: the driver promises that float division is correctly rounded, so images have the same bits as on other such devices.
     * Without the promise they may have the same bits, too. */
    int32_t correct_division;
    /** Native vector width of float. */
    int32_t float_width;
    /** 1: of a platform that this version of the library knows: PoCL, or the vendor's own for Intel, NVIDIA or AMD. */
    int32_t known;
    /** Bytes, as the driver reports them now. */
    int64_t memory;
    /** Largest buffer in bytes, as the driver reports it now. */
    int64_t max_allocation;
    /** Local memory of a work-group, bytes. */
    int64_t local_memory;
    /** Name of the device. */
    char name[128];
    /** Name of its platform. */
    char platform_name[128];
    /** Version of OpenCL that it has. */
    char version[128];
    /** Version of its driver. */
    char driver[128];
} skg_device_info;

SKG_INIT(skg_device_info)

/** The device that skg_context_create would open first for these words. It is neither opened nor tested.
 * Errors: those of skg_context_create. */
SKG_API skg_status skg_device_find(const char *config, skg_device_info *info);

/** Whether skg_context_create would run the first test of an unknown driver in this process.
 *
 *     config     as for skg_context_create
 *     untested   result; 1: the words name a device of a platform that this version does not know, and no verdict on it is
 *                kept. Run the test in a child process first (skg_device_test_run), as the command does
 *     errors     SKG_ERR_ARGUMENT, SKG_ERR_FORK
 *
 * Platforms that skg_context_create would not choose by itself are not asked for their devices. A driver that driver= names is
 * opened. */
SKG_API skg_status skg_device_untested(const char *config, int32_t *untested);

/** Number of devices over all platforms, those that are not known and those of drivers that driver= has opened included.
 * None is no failure. Errors: SKG_ERR_FORK. */
SKG_API skg_status skg_device_count(int64_t *count);

/** The device with number 0 <= index < count. Errors: SKG_ERR_ARGUMENT, SKG_ERR_FORK. */
SKG_API skg_status skg_device_get(int64_t index, skg_device_info *info);

/** Verdict of a self-test of a device. */
enum skg_test_verdict {
    /** The kernels compute wrongly. */
    SKG_TEST_WRONG = 0,
    /** Every pixel is what it has to be. */
    SKG_TEST_RIGHT = 1,
    /** The device lacks what the kernels need: fp64. */
    SKG_TEST_UNSUPPORTED = 2,
    /** The driver returned an error, or could not compile the kernels. */
    SKG_TEST_FAILED = 3
};

/** The result of a test. The library fills it; prepare with skg_device_test_init. */
typedef struct {
    /** Set by skg_device_test_init. */
    int32_t size;
    /** enum skg_test_verdict */
    int32_t verdict;
    /** Time that the test took, with compiling, in seconds. */
    double seconds;
    /** Score of the first test: images of 512 x 512 pixels and 300 triangles per second. Otherwise 0. */
    double score;
    /** Name of the test, such as "strategy tiles". */
    char name[32];
    /** Reason of the verdict if the device is wrong, unsupported or failed; "" if it is right. */
    char reason[256];
} skg_device_test;

SKG_INIT(skg_device_test)

/** Number of tests that a device can be put to. */
SKG_API skg_status skg_device_test_count(int64_t *count);

/** The name of a test, such as "strategy tiles": static storage. Errors: SKG_ERR_ARGUMENT. */
SKG_API skg_status skg_device_test_name_get(int64_t test, const char **name);

/** Tests a device now, whatever was found before, and keeps the verdict.
 *
 *     device   number of the device, as for skg_device_get
 *     test     0 <= test < count. The first one covers what every plan needs
 *     result   also filled if the device computes wrongly or the driver fails, which is no error of this call
 *     method   a scene of boxes whose path lengths are known from a formula, on a detector of 96 rows and 93 or 96
 *              columns; of the 3D view, a picture of two boxes
 *     errors   SKG_ERR_ARGUMENT, SKG_ERR_MEMORY */
SKG_API skg_status skg_device_test_run(int64_t device, int64_t test, skg_device_test *result);

/** Keeps what a test in another process found out, for instance that the driver ended it. A passing verdict is cached by the
 * process that tests.
 *
 *     config   the words of skg_context_create that name the device
 *     test     0 <= test < count
 *     result   verdict SKG_TEST_WRONG or SKG_TEST_FAILED, and the reason
 *     errors   SKG_ERR_ARGUMENT, SKG_ERR_NO_DEVICE, SKG_ERR_FORK. A folder that cannot be written is no error */
SKG_API skg_status skg_device_test_keep(const char *config, int64_t test, const skg_device_test *result);

/** The device of a context. */
SKG_API skg_status skg_context_device_get(skg_context *context, skg_device_info *info);

#ifdef __cplusplus
}
#endif
#endif
