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

} // namespace
