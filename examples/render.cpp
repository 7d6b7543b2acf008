// Makes a scene in memory, a white sphere in a white furnace, and renders it twice: what a furnace
// lights is as bright as the furnace, and half as bright where half of the light is reflected.
#include <cstdio>
#include <stdexcept>
#include <stromboli/stromboli.h>
stromboli_error error;
void check(stromboli_code code) {
    if (code != STROMBOLI_OK) throw std::runtime_error(error.message);
}
int main(int count, char** words) {
    stromboli_maker* maker;
    stromboli_scene* scene;
    stromboli_session* session;
    uint32_t white;
    const double middle[] = {0, 0, 0}, from[] = {0, 0, 4};
    float radiance[] = {1, 1, 1}, color[3];
    check(stromboli_maker_create("furnace", &maker, &error));
    check(stromboli_maker_add_material(maker, "diffuse", "white", &white, &error));
    check(stromboli_maker_add_sphere(maker, middle, 1, white, &error));
    check(stromboli_maker_set_environment(maker, 1, 1, radiance, 1, 0, &error));
    check(stromboli_maker_add_camera(maker, from, middle, nullptr, 20, &error));
    check(stromboli_maker_finish(maker, &scene, &error));
    stromboli_maker_destroy(maker);
    check(stromboli_session_create(count > 1 ? words[1] : nullptr, nullptr, &session, &error));
    for (const char* side : {"width", "height"})
        check(stromboli_session_set(session, side, 1, &error));
    check(stromboli_session_set_word(session, "direct", "bsdf", &error)); // which is exact here
    check(stromboli_session_begin(session, scene, &error));
    for (const double albedo : {1.0, 0.5}) {
        check(stromboli_session_set_material(session, white, "albedo", &albedo, 1, &error));
        check(stromboli_session_run(session, &error));
        check(stromboli_session_read_color(session, color, 3, &error));
        std::printf("%s %.3f\n", albedo == 1 ? "white" : "grey", double(color[0]));
    }
    stromboli_session_destroy(session);
    stromboli_scene_destroy(scene);
}
