// The C API: puts host/api into C. No exception leaves it.
#include "stromboli/stromboli.h"

#include "host/api/named_materials.hpp"
#include "host/api/named_settings.hpp"
#include "host/api/picture_session.hpp"
#include "host/api/scene_maker.hpp"
#include "host/core/error.hpp"
#include "host/engine/load_scene.hpp"
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"
#include "host/version/version.hpp"

#include <algorithm>
#include <cstring>
#include <deque>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <vector>

using namespace stromboli;

// --- Handles -------------------------------------------------------------------------------------

struct stromboli_scene {
    std::shared_ptr<const Scene> scene;
    std::vector<std::string> report;
};

struct stromboli_maker {
    api::SceneMaker maker;
};

struct stromboli_session {
    api::PictureSession session;
    api::PictureSettings settings;
    stromboli_progress progress = nullptr;
    void* user = nullptr;
    std::deque<api::Message> messages;
};

namespace {

// --- Errors --------------------------------------------------------------------------------------

stromboli_code codeOf(ErrorKind kind) {
    switch (kind) {
    case ErrorKind::Usage:
        return STROMBOLI_ERROR_USAGE;
    case ErrorKind::Scene:
        return STROMBOLI_ERROR_SCENE;
    case ErrorKind::Device:
        return STROMBOLI_ERROR_DEVICE;
    case ErrorKind::DeviceLost:
        return STROMBOLI_ERROR_DEVICE_LOST;
    case ErrorKind::Output:
        return STROMBOLI_ERROR_OUTPUT;
    }
    return STROMBOLI_ERROR_INTERNAL;
}

/// Copies what there is room for, without cutting a UTF-8 character in two, and ends it with 0.
void copyText(std::string_view text, char* to, size_t bytes) {
    if (bytes == 0) return;
    size_t length = std::min(text.size(), bytes - 1);
    if (length < text.size())
        while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80)
            --length;
    std::memcpy(to, text.data(), length);
    to[length] = 0;
}

stromboli_code fail(stromboli_error* error, stromboli_code code, const char* message) {
    if (error) {
        error->code = code;
        copyText(message, error->message, sizeof error->message);
    }
    return code;
}

/// Runs what a function of the API does.
template <class Work>
stromboli_code guarded(stromboli_error* error, const Work& work) noexcept {
    try {
        work();
        return STROMBOLI_OK;
    } catch (const Error& e) {
        return fail(error, codeOf(e.kind()), e.what());
    } catch (const std::bad_alloc&) {
        return fail(error, STROMBOLI_ERROR_MEMORY, "there is not enough memory");
    } catch (const std::exception& e) {
        return fail(error, STROMBOLI_ERROR_INTERNAL, e.what());
    } catch (...) {
        return fail(error, STROMBOLI_ERROR_INTERNAL, "an unknown error");
    }
}

/// Throws UsageError if a pointer that has to lead somewhere does not.
template <class T>
T& there(T* pointer, const char* what) {
    if (!pointer) throw UsageError(std::string(what) + " is NULL");
    return *pointer;
}

std::string textOf(const char* text, const char* what) {
    return &there(text, what);
}

std::vector<double> numbersOf(const double* values, size_t count) {
    if (count > 0) there(values, "values");
    return {values, values + count};
}

glm::dvec3 vectorOf(const double* values, const char* what) {
    there(values, what);
    return {values[0], values[1], values[2]};
}

template <class T>
std::span<const T> spanOf(const T* values, size_t count) {
    return values ? std::span(values, count) : std::span<const T>();
}

std::vector<std::string> linesOf(const LoadReport& report) {
    std::vector<std::string> lines;
    for (const auto* part : {&report.warnings, &report.forgiven, &report.ignored, &report.assumed})
        lines.insert(lines.end(), part->begin(), part->end());
    return lines;
}

/// Hands a scene over.
void give(std::shared_ptr<const Scene> scene, stromboli_scene** to) {
    auto made = std::make_unique<stromboli_scene>();
    made->report = linesOf(scene->report);
    made->scene = std::move(scene);
    *to = made.release();
}

Next progressOf(const stromboli_session& session, const RenderProgress& state) {
    if (!session.progress) return Next::GoOn;
    return session.progress(state.share, session.user) == 0 ? Next::GoOn : Next::Cancel;
}

bool pass(stromboli_session& session) {
    return session.session.pass(
        [&](const RenderProgress& state) { return progressOf(session, state); });
}

/// A device that is lost for good is an error in a program, which has no samples to save.
void throwIfLost(const RenderResult& result) {
    if (result.lost) throw DeviceLostError(*result.lost);
}

} // namespace

// --- Versions ------------------------------------------------------------------------------------

int32_t stromboli_version(void) {
    return STROMBOLI_VERSION;
}

const char* stromboli_version_text(void) {
    return stromboli::version();
}

// --- Scenes --------------------------------------------------------------------------------------

stromboli_code stromboli_scene_load(const char* source, stromboli_scene** scene,
                                    stromboli_error* error) {
    return stromboli_scene_load_with(source, nullptr, 0, scene, error);
}

stromboli_code stromboli_scene_load_with(const char* source, const stromboli_option* options,
                                         size_t option_count, stromboli_scene** scene,
                                         stromboli_error* error) {
    return guarded(error, [&] {
        there(scene, "scene");
        SceneRequest request;
        request.source = textOf(source, "source");
        if (option_count > 0) there(options, "options");
        for (const stromboli_option& option : spanOf(options, option_count)) {
            const std::string name = textOf(option.name, "name");
            if (option.word)
                api::setReading(request, name, std::string(option.word));
            else if (option.count > 3)
                throw UsageError(name + ": an option has 3 numbers at most");
            else
                api::setReading(request, name, numbersOf(option.numbers, option.count));
        }
        give(loadScene(request).scene, scene);
    });
}

void stromboli_scene_destroy(stromboli_scene* scene) {
    delete scene;
}

size_t stromboli_scene_material_count(const stromboli_scene* scene) {
    return scene ? scene->scene->materials.size() : 0;
}

stromboli_code stromboli_scene_find_material(const stromboli_scene* scene, const char* name,
                                             uint32_t* number, stromboli_error* error) {
    return guarded(error, [&] {
        const std::vector<Material>& materials = there(scene, "scene").scene->materials;
        const std::string wanted = textOf(name, "name");
        const auto found = std::ranges::find(materials, wanted, &Material::name);
        if (found == materials.end())
            throw UsageError("the scene has no material '" + wanted + "'");
        there(number, "number") = uint32_t(found - materials.begin());
    });
}

const char* stromboli_scene_report(const stromboli_scene* scene, size_t line) {
    return scene && line < scene->report.size() ? scene->report[line].c_str() : nullptr;
}

// --- Scenes made in memory -----------------------------------------------------------------------

stromboli_code stromboli_maker_create(const char* name, stromboli_maker** maker,
                                      stromboli_error* error) {
    return guarded(error, [&] {
        there(maker, "maker");
        *maker = new stromboli_maker{api::SceneMaker(name ? name : "scene")};
    });
}

void stromboli_maker_destroy(stromboli_maker* maker) {
    delete maker;
}

stromboli_code stromboli_maker_add_material(stromboli_maker* maker, const char* kind,
                                            const char* name, uint32_t* number,
                                            stromboli_error* error) {
    return guarded(error, [&] {
        there(number, "number");
        *number = there(maker, "maker")
                      .maker.addMaterial(api::makeMaterial(textOf(kind, "kind"), name ? name : ""));
    });
}

stromboli_code stromboli_maker_set_material(stromboli_maker* maker, uint32_t number,
                                            const char* parameter, const double* values,
                                            size_t count, stromboli_error* error) {
    return guarded(error, [&] {
        api::setMaterial(there(maker, "maker").maker.material(number),
                         textOf(parameter, "parameter"), numbersOf(values, count));
    });
}

stromboli_code stromboli_maker_add_texture(stromboli_maker* maker, uint32_t width, uint32_t height,
                                           uint32_t channels, const uint8_t* bytes, int is_srgb,
                                           uint32_t* number, stromboli_error* error) {
    return guarded(error, [&] {
        there(number, "number");
        there(bytes, "bytes");
        if (channels != 3 && channels != 4) throw UsageError("a texture has 3 or 4 channels");
        *number = there(maker, "maker")
                      .maker.addTexture(width, height,
                                        std::span(bytes, size_t(width) * height * channels),
                                        is_srgb != 0);
    });
}

stromboli_code stromboli_maker_use_texture(stromboli_maker* maker, uint32_t material,
                                           const char* slot, uint32_t texture,
                                           stromboli_error* error) {
    return guarded(error, [&] {
        there(maker, "maker").maker.useTexture(material, textOf(slot, "slot"), texture);
    });
}

stromboli_code stromboli_maker_add_mesh(stromboli_maker* maker, const stromboli_mesh* mesh,
                                        stromboli_error* error) {
    return guarded(error, [&] {
        const stromboli_mesh& given = there(mesh, "mesh");
        api::MeshArrays arrays;
        arrays.name = given.name ? given.name : "mesh";
        if (given.vertex_count > 0) there(given.positions, "positions");
        if (given.triangle_count > 0) there(given.triangles, "triangles");
        arrays.positions = spanOf(given.positions, 3 * given.vertex_count);
        arrays.triangles = spanOf(given.triangles, 3 * given.triangle_count);
        arrays.normals = spanOf(given.normals, 3 * given.vertex_count);
        arrays.uvs = spanOf(given.uvs, 2 * given.vertex_count);
        arrays.material = given.material;
        if (given.to_world)
            for (int i = 0; i < 16; ++i)
                arrays.toWorld[i / 4][i % 4] = given.to_world[i];
        there(maker, "maker").maker.addMesh(arrays);
    });
}

stromboli_code stromboli_maker_add_sphere(stromboli_maker* maker, const double center[3],
                                          double radius, uint32_t material,
                                          stromboli_error* error) {
    return guarded(error, [&] {
        there(maker, "maker")
            .maker.addSphere("sphere", vectorOf(center, "center"), radius, material);
    });
}

stromboli_code stromboli_maker_add_light(stromboli_maker* maker, const stromboli_light* light,
                                         stromboli_error* error) {
    return guarded(error, [&] {
        const stromboli_light& given = there(light, "light");
        api::LightAsked asked;
        asked.kind = textOf(given.kind, "kind");
        asked.color = vectorOf(given.color, "color");
        asked.position = vectorOf(given.position, "position");
        asked.direction = vectorOf(given.direction, "direction");
        asked.size = {given.size[0], given.size[1]};
        asked.angle = given.angle;
        if (given.inner_angle >= 0) asked.innerAngle = given.inner_angle;
        there(maker, "maker").maker.addLight(asked);
    });
}

stromboli_code stromboli_maker_add_camera(stromboli_maker* maker, const double from[3],
                                          const double at[3], const double up[3], double fov,
                                          stromboli_error* error) {
    return guarded(error, [&] {
        api::CameraAsked camera;
        camera.from = vectorOf(from, "from");
        camera.at = vectorOf(at, "at");
        if (up) camera.up = vectorOf(up, "up");
        camera.fov = fov;
        there(maker, "maker").maker.addCamera(camera);
    });
}

stromboli_code stromboli_maker_set_environment(stromboli_maker* maker, uint32_t width,
                                               uint32_t height, const float* radiance,
                                               double strength, double rotation,
                                               stromboli_error* error) {
    return guarded(error, [&] {
        there(radiance, "radiance");
        there(maker, "maker")
            .maker.setEnvironment(width, height, std::span(radiance, 3 * size_t(width) * height),
                                  strength, rotation);
    });
}

stromboli_code stromboli_maker_finish(stromboli_maker* maker, stromboli_scene** scene,
                                      stromboli_error* error) {
    return guarded(error, [&] {
        there(scene, "scene");
        give(there(maker, "maker").maker.finish(), scene);
    });
}

// --- Sessions ------------------------------------------------------------------------------------

stromboli_code stromboli_session_create(const char* backend, const char* device,
                                        stromboli_session** session, stromboli_error* error) {
    return guarded(error, [&] {
        there(session, "session");
        DeviceRequest request;
        if (backend) api::setDevice(request, "backend", std::string(backend));
        if (device) api::setDevice(request, "device", std::string(device));
        *session = new stromboli_session{api::PictureSession(request), {}};
    });
}

void stromboli_session_destroy(stromboli_session* session) {
    delete session;
}

stromboli_code stromboli_session_set(stromboli_session* session, const char* name, double value,
                                     stromboli_error* error) {
    return stromboli_session_set_numbers(session, name, &value, 1, error);
}

stromboli_code stromboli_session_set_numbers(stromboli_session* session, const char* name,
                                             const double* values, size_t count,
                                             stromboli_error* error) {
    return guarded(error, [&] {
        there(session, "session").settings.set(textOf(name, "name"), numbersOf(values, count));
    });
}

stromboli_code stromboli_session_set_word(stromboli_session* session, const char* name,
                                          const char* value, stromboli_error* error) {
    return guarded(error, [&] {
        there(session, "session").settings.set(textOf(name, "name"), textOf(value, "value"));
    });
}

void stromboli_session_reset(stromboli_session* session) {
    if (session) session->settings = {};
}

void stromboli_session_on_progress(stromboli_session* session, stromboli_progress progress,
                                   void* user) {
    if (!session) return;
    session->progress = progress;
    session->user = user;
}

stromboli_code stromboli_session_begin(stromboli_session* session, const stromboli_scene* scene,
                                       stromboli_error* error) {
    return guarded(error, [&] {
        stromboli_session& s = there(session, "session");
        s.session.begin(there(scene, "scene").scene, s.settings.request());
    });
}

stromboli_code stromboli_session_move_camera(stromboli_session* session, const double from[3],
                                             const double at[3], double fov,
                                             stromboli_error* error) {
    return guarded(error, [&] {
        stromboli_session& s = there(session, "session");
        CameraRequest camera = s.session.request().camera;
        const glm::dvec3 f = vectorOf(from, "from"), a = vectorOf(at, "at");
        api::setCamera(camera, "look_from", std::vector<double>{f.x, f.y, f.z});
        api::setCamera(camera, "look_at", std::vector<double>{a.x, a.y, a.z});
        if (fov != 0) api::setCamera(camera, "fov", std::vector<double>{fov});
        s.session.moveCamera(camera);
    });
}

stromboli_code stromboli_session_set_material(stromboli_session* session, uint32_t number,
                                              const char* parameter, const double* values,
                                              size_t count, stromboli_error* error) {
    return guarded(error, [&] {
        there(session, "session")
            .session.changeMaterials(
                {{number, {{textOf(parameter, "parameter"), numbersOf(values, count)}}}});
    });
}

stromboli_code stromboli_session_pass(stromboli_session* session, int* has_more,
                                      stromboli_error* error) {
    return guarded(error, [&] {
        stromboli_session& s = there(session, "session");
        there(has_more, "has_more");
        const bool hasMore = pass(s);
        throwIfLost(s.session.result());
        *has_more = hasMore ? 1 : 0;
    });
}

stromboli_code stromboli_session_run(stromboli_session* session, stromboli_error* error) {
    return guarded(error, [&] {
        stromboli_session& s = there(session, "session");
        while (pass(s)) {
        }
        throwIfLost(s.session.result());
    });
}

void stromboli_session_cancel(stromboli_session* session) {
    if (session) session->session.cancel();
}

// --- What a picture holds ------------------------------------------------------------------------

stromboli_code stromboli_session_info(stromboli_session* session, stromboli_info* info,
                                      stromboli_error* error) {
    return guarded(error, [&] {
        stromboli_session& s = there(session, "session");
        const FloatImage& image = s.session.image();
        const RenderResult result = s.session.result();
        const PictureNoise& noise = result.denoised ? result.denoised->noise : result.noise;
        stromboli_info found{};
        found.width = image.width, found.height = image.height;
        found.is_over = s.session.isOver() ? 1 : 0;
        found.is_cancelled = result.cancelled ? 1 : 0;
        double samples = 0;
        for (const float count : image.channels.at("samples"))
            samples += double(count);
        found.samples_per_pixel = samples / (double(image.width) * image.height);
        found.render_seconds = result.renderSeconds;
        found.noise = noise.known() ? noise.estimate : -1;
        found.noise_least = noise.known() ? noise.least : -1;
        found.noise_most = noise.known() ? noise.most : -1;
        there(info, "info") = found;
    });
}

stromboli_code stromboli_session_read(stromboli_session* session, const char* channel,
                                      float* values, size_t count, stromboli_error* error) {
    return guarded(error, [&] {
        const FloatImage& image = there(session, "session").session.image();
        const std::string name = textOf(channel, "channel");
        const auto found = image.channels.find(name);
        if (found == image.channels.end()) {
            std::string names;
            for (const auto& [one, ignored] : image.channels)
                names += (names.empty() ? "" : ", ") + one;
            throw UsageError("the picture has no channel '" + name + "': it has " + names);
        }
        if (count < found->second.size())
            throw UsageError("the channel has " + std::to_string(found->second.size()) +
                             " numbers, and there is room for " + std::to_string(count));
        std::ranges::copy(found->second, &there(values, "values"));
    });
}

stromboli_code stromboli_session_read_color(stromboli_session* session, float* values, size_t count,
                                            stromboli_error* error) {
    return guarded(error, [&] {
        const FloatImage& image = there(session, "session").session.image();
        const size_t pixels = size_t(image.width) * image.height;
        if (count < 3 * pixels)
            throw UsageError("the colours are " + std::to_string(3 * pixels) +
                             " numbers, and there is room for " + std::to_string(count));
        there(values, "values");
        for (size_t c = 0; c < 3; ++c) {
            const std::vector<float>& channel = image.channels.at(kColorChannels[c]);
            for (size_t i = 0; i < pixels; ++i)
                values[3 * i + c] = channel[i];
        }
    });
}

stromboli_code stromboli_session_write(stromboli_session* session, const char* file,
                                       stromboli_error* error) {
    return guarded(error, [&] {
        const FloatImage& image = there(session, "session").session.image();
        const std::string name = textOf(file, "file");
        if (formatOf(name) == PictureFormat::Exr) return writeExr(name, image);
        PictureOptions options;
        if (image.channels.contains(kAlphaChannel)) options.channels.emplace_back(kAlphaChannel);
        writeToneMapped(name, image, options);
    });
}

int stromboli_session_message(stromboli_session* session, int* severity, char* text, size_t bytes) {
    if (!session) return 0;
    try {
        for (api::Message& message : session->session.takeMessages())
            session->messages.push_back(std::move(message));
    } catch (...) {
        return 0;
    }
    if (session->messages.empty()) return 0;
    const api::Message& message = session->messages.front();
    if (severity) *severity = int(message.severity);
    if (text) copyText(message.text, text, bytes);
    session->messages.pop_front();
    return 1;
}
