// Makes a scene in memory, a white sphere in a white furnace, and renders it twice: what a furnace
// lights is as bright as the furnace, and half as bright where half of the light is reflected.
#include <stromboli/stromboli.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <vector>

namespace {
stromboli_error error;
void check(stromboli_code code) {
    if (code == STROMBOLI_OK) return;
    std::fprintf(stderr, "error %d: %s\n", int(code), error.message);
    std::exit(1);
}
double mean(stromboli_session* session) {
    check(stromboli_session_run(session, &error));
    std::vector<float> color(8 * 8 * 3);
    check(stromboli_session_read_color(session, color.data(), color.size(), &error));
    return std::accumulate(color.begin(), color.end(), 0.0) / double(color.size());
}
} // namespace

int main(int count, char** words) {
    stromboli_maker* maker;
    check(stromboli_maker_create("furnace", &maker, &error));
    uint32_t white;
    const double all = 1, half = 0.5, middle[] = {0, 0, 0}, from[] = {0, 0, 4};
    const float radiance[] = {1, 1, 1};
    check(stromboli_maker_add_material(maker, "diffuse", "white", &white, &error));
    check(stromboli_maker_set_material(maker, white, "albedo", &all, 1, &error));
    check(stromboli_maker_add_sphere(maker, middle, 1, white, &error));
    check(stromboli_maker_set_environment(maker, 1, 1, radiance, 1, 0, &error));
    check(stromboli_maker_add_camera(maker, from, middle, nullptr, 20, &error));
    stromboli_scene* made;
    check(stromboli_maker_finish(maker, &made, &error));
    stromboli_maker_destroy(maker);
    const std::unique_ptr<stromboli_scene, decltype(&stromboli_scene_destroy)> scene(
        made, &stromboli_scene_destroy);
    stromboli_session* begun;
    check(stromboli_session_create(count > 1 ? words[1] : nullptr, nullptr, &begun, &error));
    const std::unique_ptr<stromboli_session, decltype(&stromboli_session_destroy)> session(
        begun, &stromboli_session_destroy);
    check(stromboli_session_set(begun, "width", 8, &error));
    check(stromboli_session_set(begun, "height", 8, &error));
    check(stromboli_session_set_word(begun, "direct", "bsdf", &error)); // which is exact here
    check(stromboli_session_begin(begun, scene.get(), &error));
    std::printf("white %.3f\n", mean(begun));
    check(stromboli_session_set_material(begun, white, "albedo", &half, 1, &error));
    std::printf("grey %.3f\n", mean(begun));
    return 0;
}
