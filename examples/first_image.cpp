// A ball of soft tissue, its image and its path lengths, from C++20.
//
//     g++ -std=c++20 first_image.cpp $(pkg-config --cflags --libs skiagraph) -o first_image_cpp && ./first_image_cpp
#include <skiagraph/skiagraph.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

namespace sk = skiagraph;

int main() try {
    constexpr std::int64_t side = 128;
    const auto context = sk::make<sk::context>(skg_context_create, nullptr);
    const auto ball = sk::make<sk::mesh>(skg_mesh_create_sphere, 40.0, 128);
    const auto tissue = sk::make<sk::material>(skg_material_create_named, "soft tissue icru44");
    const auto beam = sk::make<sk::spectrum>(skg_spectrum_create_mono, 80.0, 1000.0);
    const auto scene = sk::make<sk::scene>(skg_scene_create, context.get());
    auto part = sk::init(skg_part_init);
    part.mesh = ball;
    part.material = tissue;
    part.label = "ball";
    const auto id = sk::add(scene, part);
    auto view = sk::init(skg_view_init);
    view.columns = view.rows = side;
    view.source[2] = -1000;
    view.centre[2] = 200;
    view.column_step[0] = view.row_step[1] = 1;
    const auto plan =
        sk::make<sk::plan>(skg_plan_create, context.get(), scene.get(), &view, beam.get(), nullptr);

    std::vector<float> image(side * side), mean(side * side), lengths(side * side);
    sk::image(plan, std::span(image));
    sk::noise(plan, std::span(mean)); // the image without noise
    sk::lengths(plan, id, std::span(lengths));
    const auto middle = side / 2 * side + side / 2;
    const auto expected =
        80000 * std::exp(-sk::number<double>(skg_material_attenuation_get, tissue.get(), 80.0) *
                         lengths[middle] / 10);
    std::printf("energy %.1f keV of %.1f keV, path length %.3f mm\n", image[middle], image[0],
                lengths[middle]);

    std::vector<skg_frame> frames(3, sk::init(skg_frame_init));
    std::vector<float> images(3 * side * side);
    auto job = sk::submit(plan, std::span<const skg_frame>(frames), std::span(images));
    job.wait();

    try {
        sk::make<sk::material>(skg_material_create_named, "unobtainium");
        return 1;
    } catch (const sk::error &error) {
        if (error.status() != SKG_ERR_MATERIAL) return 1;
    }
    const bool right = std::abs(image[middle] - expected) < 1e-4 * expected && mean == image &&
                       images.back() == image.back();
    if (!right) std::fprintf(stderr, "that is not the ball\n");
    return right ? 0 : 1;
} catch (const sk::error &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
