// The C API with the arguments that programs get wrong, and a picture by the reference.
#include "stromboli/stromboli.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

namespace {

using testing::HasSubstr;

TEST(CApi, SaysWhatIsNull) {
    stromboli_error error;
    stromboli_scene* scene = nullptr;
    EXPECT_EQ(stromboli_scene_load(nullptr, &scene, &error), STROMBOLI_ERROR_USAGE);
    EXPECT_THAT(error.message, HasSubstr("NULL"));
    EXPECT_EQ(stromboli_scene_load("cornell_boxes", nullptr, &error), STROMBOLI_ERROR_USAGE);
    EXPECT_EQ(stromboli_session_run(nullptr, &error), STROMBOLI_ERROR_USAGE);
    EXPECT_EQ(stromboli_maker_finish(nullptr, &scene, nullptr),
              STROMBOLI_ERROR_USAGE); // no message
    stromboli_scene_destroy(nullptr);
    stromboli_maker_destroy(nullptr);
    stromboli_session_destroy(nullptr);
    EXPECT_EQ(stromboli_scene_material_count(nullptr), 0u);
    EXPECT_EQ(stromboli_scene_report(nullptr, 0), nullptr);
}

/// Within the message's room, and without half a character at its end.
TEST(CApi, LongMessagesAreCutBetweenCharacters) {
    stromboli_error error;
    std::memset(&error, 0x7F, sizeof error);
    std::string name;
    for (size_t i = 0; i < sizeof error.message; ++i)
        name += "\u00e9";
    stromboli_scene* scene = nullptr;
    EXPECT_EQ(stromboli_scene_load((name + ".gltf").c_str(), &scene, &error),
              STROMBOLI_ERROR_SCENE);
    const size_t length = strnlen(error.message, sizeof error.message);
    ASSERT_LT(length, sizeof error.message);
    EXPECT_GT(length, sizeof error.message - 3);
    const auto last = static_cast<unsigned char>(error.message[length - 1]);
    EXPECT_NE(last & 0xC0, 0xC0) << "the first byte of two";
    EXPECT_EQ(scene, nullptr);
}

/// A white sphere in a white furnace is as bright as the furnace; a texture of floats shines.
TEST(CApi, RendersWhatItMakes) {
    stromboli_error error;
    stromboli_maker* maker = nullptr;
    ASSERT_EQ(stromboli_maker_create("furnace", &maker, &error), STROMBOLI_OK);
    uint32_t white = 7, texture = 7;
    const double all = 1, middle[] = {0, 0, 0}, from[] = {0, 0, 4};
    const float radiance[] = {1, 1, 1}, texels[] = {0.5f, 0.5f, 0.5f};
    EXPECT_EQ(stromboli_maker_add_material(maker, "diffuse", "white", &white, &error),
              STROMBOLI_OK);
    EXPECT_EQ(stromboli_maker_set_material(maker, white, "albedo", &all, 1, &error), STROMBOLI_OK);
    EXPECT_EQ(stromboli_maker_set_material(maker, white, "colour", &all, 1, &error),
              STROMBOLI_ERROR_USAGE);
    EXPECT_EQ(stromboli_maker_add_float_texture(maker, 1, 1, 3, texels, &texture, &error),
              STROMBOLI_OK);
    EXPECT_EQ(texture, 0u);
    EXPECT_EQ(stromboli_maker_add_float_texture(maker, 1, 1, 2, texels, &texture, &error),
              STROMBOLI_ERROR_USAGE);
    EXPECT_EQ(stromboli_maker_use_texture(maker, white, "emission", 3, &error),
              STROMBOLI_ERROR_USAGE);
    EXPECT_EQ(stromboli_maker_add_sphere(maker, middle, 1, white, &error), STROMBOLI_OK);
    EXPECT_EQ(stromboli_maker_set_environment(maker, 1, 1, radiance, 1, 0, &error), STROMBOLI_OK);
    EXPECT_EQ(stromboli_maker_add_camera(maker, from, middle, nullptr, 20, &error), STROMBOLI_OK);
    stromboli_scene* scene = nullptr;
    ASSERT_EQ(stromboli_maker_finish(maker, &scene, &error), STROMBOLI_OK) << error.message;
    stromboli_maker_destroy(maker);

    stromboli_session* session = nullptr;
    ASSERT_EQ(stromboli_session_create("reference", nullptr, &session, &error), STROMBOLI_OK);
    for (const char* side : {"width", "height"})
        EXPECT_EQ(stromboli_session_set(session, side, 4, &error), STROMBOLI_OK);
    EXPECT_EQ(stromboli_session_set(session, "widht", 4, &error), STROMBOLI_ERROR_USAGE);
    EXPECT_THAT(error.message, HasSubstr("width"));
    EXPECT_EQ(stromboli_session_set_word(session, "direct", "bsdf", &error), STROMBOLI_OK);
    ASSERT_EQ(stromboli_session_begin(session, scene, &error), STROMBOLI_OK) << error.message;
    ASSERT_EQ(stromboli_session_run(session, &error), STROMBOLI_OK) << error.message;
    std::vector<float> color(4 * 4 * 3);
    EXPECT_EQ(stromboli_session_read_color(session, color.data(), color.size() - 1, &error),
              STROMBOLI_ERROR_USAGE);
    ASSERT_EQ(stromboli_session_read_color(session, color.data(), color.size(), &error),
              STROMBOLI_OK);
    for (const float value : color)
        EXPECT_NEAR(value, 1, 1e-5);
    stromboli_session_destroy(session);
    stromboli_scene_destroy(scene);
}

/// A lamp that leaves the view, and comes back; a light that becomes twice as bright, and moves.
TEST(CApi, MovesObjectsAndLights) {
    stromboli_error error;
    stromboli_maker* maker = nullptr;
    ASSERT_EQ(stromboli_maker_create("moves", &maker, &error), STROMBOLI_OK);
    uint32_t lamp = 0, floor = 0;
    const double glow = 3, gray = 0.5, middle[] = {0, 0, 0}, from[] = {0, 0, 4};
    ASSERT_EQ(stromboli_maker_add_material(maker, "diffuse", "lamp", &lamp, &error), STROMBOLI_OK);
    ASSERT_EQ(stromboli_maker_set_material(maker, lamp, "emission", &glow, 1, &error),
              STROMBOLI_OK);
    const double black = 0;
    ASSERT_EQ(stromboli_maker_set_material(maker, lamp, "albedo", &black, 1, &error), STROMBOLI_OK);
    ASSERT_EQ(stromboli_maker_add_material(maker, "diffuse", "wall", &floor, &error), STROMBOLI_OK);
    ASSERT_EQ(stromboli_maker_set_material(maker, floor, "albedo", &gray, 1, &error), STROMBOLI_OK);
    ASSERT_EQ(stromboli_maker_add_sphere(maker, middle, 1, lamp, &error), STROMBOLI_OK);
    const double corners[] = {-9, -9, -2, 9, -9, -2, 0, 9, -2};
    const uint32_t triangle[] = {0, 1, 2};
    stromboli_mesh wall{"wall", corners, 3, triangle, 1, nullptr, nullptr, nullptr, floor};
    ASSERT_EQ(stromboli_maker_add_mesh(maker, &wall, &error), STROMBOLI_OK);
    stromboli_light light = STROMBOLI_LIGHT;
    light.position[2] = 3;
    ASSERT_EQ(stromboli_maker_add_light(maker, &light, &error), STROMBOLI_OK);
    ASSERT_EQ(stromboli_maker_add_camera(maker, from, middle, nullptr, 1, &error), STROMBOLI_OK);
    stromboli_scene* scene = nullptr;
    ASSERT_EQ(stromboli_maker_finish(maker, &scene, &error), STROMBOLI_OK) << error.message;
    stromboli_maker_destroy(maker);

    uint32_t found = 9;
    EXPECT_EQ(stromboli_scene_light_count(scene), 1u);
    EXPECT_EQ(stromboli_scene_find_light(scene, "sun", &found, &error), STROMBOLI_ERROR_USAGE);
    EXPECT_EQ(stromboli_scene_object_count(scene), 2u);
    EXPECT_EQ(stromboli_scene_object_name(scene, 2), nullptr);
    uint32_t sphere = 9;
    ASSERT_EQ(stromboli_scene_find_object(scene, "wall", &found, &error), STROMBOLI_OK);
    ASSERT_EQ(stromboli_scene_find_object(scene, stromboli_scene_object_name(scene, 1 - found),
                                          &sphere, &error),
              STROMBOLI_OK);
    EXPECT_EQ(sphere, 1 - found);

    stromboli_session* session = nullptr;
    ASSERT_EQ(stromboli_session_create("reference", nullptr, &session, &error), STROMBOLI_OK);
    double motion[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 50, 0, 0, 1};
    EXPECT_EQ(stromboli_session_move_object(session, sphere, motion, &error),
              STROMBOLI_ERROR_USAGE); // nothing has been begun
    for (const char* side : {"width", "height"})
        EXPECT_EQ(stromboli_session_set(session, side, 1, &error), STROMBOLI_OK);
    EXPECT_EQ(stromboli_session_set(session, "max_bounces", 1, &error), STROMBOLI_OK);
    ASSERT_EQ(stromboli_session_begin(session, scene, &error), STROMBOLI_OK) << error.message;
    const auto green = [&] {
        EXPECT_EQ(stromboli_session_run(session, &error), STROMBOLI_OK) << error.message;
        float color[3] = {};
        EXPECT_EQ(stromboli_session_read_color(session, color, 3, &error), STROMBOLI_OK);
        return color[1];
    };
    EXPECT_NEAR(green(), 3, 1e-5);
    ASSERT_EQ(stromboli_session_move_object(session, sphere, motion, &error), STROMBOLI_OK);
    const float lit = green(); // by the light alone, but for the lamp from far away
    EXPECT_NEAR(lit, 0.5 / 3.14159265 / 25, 1e-4);
    const double twice = 2, nearer[] = {0, 0, 0.5};
    ASSERT_EQ(stromboli_session_set_light(session, 0, "color", &twice, 1, &error), STROMBOLI_OK);
    EXPECT_NEAR(green(), 2 * 0.5 / 3.14159265 / 25, 1e-4);
    ASSERT_EQ(stromboli_session_set_light(session, 0, "position", nearer, 3, &error), STROMBOLI_OK);
    EXPECT_NEAR(green(), 2 * 0.5 / 3.14159265 / 6.25, 1e-3);
    EXPECT_EQ(stromboli_session_set_light(session, 0, "angle", &twice, 1, &error),
              STROMBOLI_ERROR_USAGE);
    EXPECT_THAT(error.message, HasSubstr("position"));
    EXPECT_EQ(stromboli_session_set_light(session, 7, "color", &twice, 1, &error),
              STROMBOLI_ERROR_USAGE);
    motion[0] = 2; // a sphere stays one
    EXPECT_EQ(stromboli_session_move_object(session, sphere, motion, &error),
              STROMBOLI_ERROR_USAGE);
    ASSERT_EQ(stromboli_session_move_object(session, sphere, nullptr, &error), STROMBOLI_OK);
    EXPECT_NEAR(green(), 3, 1e-5);
    stromboli_session_destroy(session);
    stromboli_scene_destroy(scene);
}

} // namespace
