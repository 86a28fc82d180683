/** @file
 * Skiagraph from C++20: handles that release themselves, failures as exceptions, arrays as spans. A thin layer: every
 * function of the C headers is called as it is, by skiagraph::make, skiagraph::check or the handle's get().
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_HPP
#define SKIAGRAPH_HPP

#if __cplusplus < 202002L
#error "skiagraph.hpp needs C++20: give -std=c++20 to gcc or clang; skiagraph.h works with every C++"
#endif

#include <skiagraph/breathing.h>
#include <skiagraph/registration.h>
#include <skiagraph/scanning.h>
#include <skiagraph/skiagraph.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace skiagraph {

/** A call failed. what() is the library's sentence. */
class error : public std::runtime_error {
  public:
    explicit error(skg_status status) : std::runtime_error(skg_last_error()), status_(status) {
    }
    skg_status status() const noexcept {
        return status_;
    }

  private:
    skg_status status_;
};

/** Throws if a status is a failure. Returns SKG_OK, SKG_STALE or SKG_RANGE. */
inline skg_status check(skg_status status) {
    if (SKG_FAILED(status)) throw error(status);
    return status;
}

/** An owner of a handle. It moves, and does not copy; retain functions of C make further owners. */
template <class T, void (*Release)(T **)> class handle {
  public:
    using type = T;
    handle() noexcept = default;
    explicit handle(T *owned) noexcept : it_(owned) {
    }
    handle(handle &&other) noexcept : it_(std::exchange(other.it_, nullptr)) {
    }
    handle &operator=(handle &&other) noexcept {
        if (this != &other) {
            Release(&it_);
            it_ = std::exchange(other.it_, nullptr);
        }
        return *this;
    }
    handle(const handle &) = delete;
    handle &operator=(const handle &) = delete;
    ~handle() {
        Release(&it_);
    }
    T *get() const noexcept {
        return it_;
    }
    /** For C functions that take the handle. */
    operator T *() const noexcept {
        return it_;
    }
    /** Gives the handle away. */
    T *release() noexcept {
        return std::exchange(it_, nullptr);
    }

  private:
    T *it_ = nullptr;
};

using context = handle<skg_context, skg_context_release>;
using mesh = handle<skg_mesh, skg_mesh_release>;
using material = handle<skg_material, skg_material_release>;
using spectrum = handle<skg_spectrum, skg_spectrum_release>;
using response = handle<skg_response, skg_response_release>;
using volume = handle<skg_volume, skg_volume_release>;
using scene = handle<skg_scene, skg_scene_release>;
using setup = handle<skg_setup, skg_setup_release>;
using plan = handle<skg_plan, skg_plan_release>;
using motion = handle<skg_motion, skg_motion_release>;
using body = handle<skg_body, skg_body_release>;
using thorax = handle<skg_thorax, skg_thorax_release>;
using dose = handle<skg_dose, skg_dose_release>;
using part_table = handle<skg_part_table, skg_part_table_release>;
using lag = handle<skg_lag, skg_lag_release>;

/** Calls a function whose last argument is the address of a new handle:
 *
 *     auto beam = skiagraph::make<skiagraph::spectrum>(skg_spectrum_create_mono, 80.0, 1000.0); */
template <class Handle, class Function, class... Arguments>
Handle make(Function function, Arguments &&...arguments) {
    typename Handle::type *made = nullptr;
    check(function(std::forward<Arguments>(arguments)..., &made));
    return Handle(made);
}

/** A struct with the library's defaults: auto view = skiagraph::init(skg_view_init); */
template <class Struct> Struct init(void (*initialise)(Struct *)) {
    Struct made;
    initialise(&made);
    return made;
}

/** Asks for the one number that a function gives through its last argument. */
template <class Number, class Function, class... Arguments>
Number number(Function function, Arguments &&...arguments) {
    Number result{};
    check(function(std::forward<Arguments>(arguments)..., &result));
    return result;
}

/** A mesh of a source whose positions are set, and their rows of three vertex numbers. */
inline mesh make_mesh(skg_mesh_source source, std::size_t numbers, std::span<const std::int32_t> corners,
                      double unit_mm, const char *name) {
    if (numbers % 3 || corners.size() % 3)
        throw std::invalid_argument("skiagraph::make_mesh: rows have three numbers");
    source.vertices = static_cast<std::int64_t>(numbers / 3);
    source.triangles = static_cast<std::int64_t>(corners.size() / 3);
    source.corners = corners.data();
    source.unit_mm = unit_mm;
    return make<mesh>(skg_mesh_create, nullptr, name, &source);
}

/** A mesh from rows of x, y, z in units of unit_mm, and rows of three vertex numbers. The arrays are copied. */
inline mesh make_mesh(std::span<const double> positions, std::span<const std::int32_t> corners,
                      double unit_mm = 1, const char *name = nullptr) {
    skg_mesh_source source;
    skg_mesh_source_init(&source);
    source.positions = positions.data();
    return make_mesh(source, positions.size(), corners, unit_mm, name);
}

/** Makes a mesh of positions in single precision. */
inline mesh make_mesh(std::span<const float> positions, std::span<const std::int32_t> corners,
                      double unit_mm = 1, const char *name = nullptr) {
    skg_mesh_source source;
    skg_mesh_source_init(&source);
    source.floats = positions.data();
    return make_mesh(source, positions.size(), corners, unit_mm, name);
}

/** Adds a part to a scene and returns its number. */
inline std::int64_t add(const scene &to, const skg_part &part) {
    return number<std::int64_t>(skg_scene_part_add, to.get(), &part);
}

/** Work that was submitted. Its destructor waits, because the output's memory is in use until then. */
class job {
  public:
    explicit job(skg_job *submitted) noexcept : it_(submitted) {
    }
    job(job &&other) noexcept : it_(std::exchange(other.it_, nullptr)) {
    }
    job(const job &) = delete;
    job &operator=(const job &) = delete;
    job &operator=(job &&) = delete;
    ~job() {
        if (it_) skg_job_wait(&it_);
    }
    /** Waits until the images are in place. Returns SKG_OK or SKG_RANGE. */
    skg_status wait() {
        return check(skg_job_wait(&it_));
    }
    /** Whether wait() would return at once. */
    bool done() const {
        return number<std::int32_t>(skg_job_test, it_) != 0;
    }
    /** The number of frames that are in place. */
    std::int64_t progress() const {
        std::int64_t in_place = 0;
        check(skg_job_progress(it_, &in_place, nullptr));
        return in_place;
    }
    /** Frames that the device was not given yet are not made: wait() then throws SKG_ERR_CANCELLED. */
    void cancel() const {
        check(skg_job_cancel(it_));
    }

  private:
    skg_job *it_;
};

/** A plan cannot absorb what changed: make another one. */
class stale : public std::runtime_error {
  public:
    stale() : std::runtime_error(skg_last_error()) {
    }
};

namespace detail {
inline job started(skg_status status, skg_job *submitted) {
    if (check(status) == SKG_STALE) throw stale();
    return job(submitted);
}
inline skg_output dense(void *data, std::int32_t type) {
    skg_output output = init(skg_output_init);
    output.data = data;
    output.type = type;
    return output;
}
inline std::int32_t type_of(const float *) {
    return SKG_TYPE_FLOAT32;
}
inline std::int32_t type_of(const double *) {
    return SKG_TYPE_FLOAT64;
}
} // namespace detail

/** Starts frames whose images are stored densely, [frame][channel][row][column], in float or double. `images` has to
 * stay, and to be large enough, until the job was waited for. */
template <class Pixel>
job submit(const plan &by, std::span<const skg_frame> frames, std::span<Pixel> images) {
    skg_job *submitted = nullptr;
    const skg_output output = detail::dense(images.data(), detail::type_of(images.data()));
    const skg_status status =
        skg_plan_submit(by, static_cast<std::int64_t>(frames.size()), frames.data(), 1, &output, &submitted);
    return detail::started(status, submitted);
}

/** Starts frames with several outputs, such as an image and the lengths through parts. */
inline job submit(const plan &by, std::span<const skg_frame> frames, std::span<const skg_output> outputs) {
    skg_job *submitted = nullptr;
    const skg_status status =
        skg_plan_submit(by, static_cast<std::int64_t>(frames.size()), frames.data(),
                        static_cast<std::int64_t>(outputs.size()), outputs.data(), &submitted);
    return detail::started(status, submitted);
}

/** Makes one image, [channel][row][column]. Returns SKG_OK or SKG_RANGE. */
template <class Pixel> skg_status image(const plan &by, std::span<Pixel> to) {
    const skg_output output = detail::dense(to.data(), detail::type_of(to.data()));
    const skg_status status = check(skg_plan_image(by, &output));
    if (status == SKG_STALE) throw stale();
    return status;
}

/** Computes path lengths through a part in mm, [row][column]; kind is enum skg_lengths. */
template <class Pixel>
skg_status lengths(const plan &by, std::int64_t part, std::span<Pixel> to,
                   std::int32_t kind = SKG_LENGTHS_NET) {
    skg_job *submitted = nullptr;
    skg_output output = detail::dense(to.data(), detail::type_of(to.data()));
    output.kind = SKG_OUTPUT_LENGTHS;
    output.part = part;
    output.lengths = kind;
    const skg_status status = skg_plan_submit(by, 1, nullptr, 1, &output, &submitted);
    return detail::started(status, submitted).wait();
}

/** Computes the scattered part of an image, [row][column], and its standard error if `sigma` is not empty. The plan needs
 * skg_plan_options.scatter. */
template <class Pixel> skg_status scatter(const plan &by, std::span<Pixel> to, std::span<Pixel> sigma = {}) {
    skg_job *submitted = nullptr;
    skg_output outputs[] = {detail::dense(to.data(), detail::type_of(to.data())),
                            detail::dense(sigma.data(), detail::type_of(sigma.data()))};
    outputs[0].kind = SKG_OUTPUT_SCATTER;
    outputs[1].kind = SKG_OUTPUT_SCATTER_SIGMA;
    const skg_status status = skg_plan_submit(by, 1, nullptr, sigma.empty() ? 1 : 2, outputs, &submitted);
    return detail::started(status, submitted).wait();
}

/** Computes the image that is expected, without noise, [channel][row][column], and the variance that noise gives to each of its values
 * if `variance` is not empty. */
template <class Pixel>
skg_status noise(const plan &by, std::span<Pixel> mean, std::span<Pixel> variance = {}) {
    skg_job *submitted = nullptr;
    skg_output outputs[] = {detail::dense(mean.data(), detail::type_of(mean.data())),
                            detail::dense(variance.data(), detail::type_of(variance.data()))};
    outputs[0].kind = SKG_OUTPUT_MEAN;
    outputs[1].kind = SKG_OUTPUT_VARIANCE;
    const skg_status status = skg_plan_submit(by, 1, nullptr, variance.empty() ? 1 : 2, outputs, &submitted);
    return detail::started(status, submitted).wait();
}

} // namespace skiagraph
#endif
