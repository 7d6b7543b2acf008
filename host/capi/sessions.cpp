// The C API of sessions, and of what their pictures hold.
#include "host/capi/calls.hpp"
#include "host/capi/handles.hpp"

#include "host/api/named_settings.hpp"
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

using namespace stromboli;
using namespace stromboli::capi;

namespace {

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

stromboli_code stromboli_session_set_light(stromboli_session* session, uint32_t number,
                                           const char* parameter, const double* values,
                                           size_t count, stromboli_error* error) {
    return guarded(error, [&] {
        there(session, "session")
            .session.changeLights(
                {{number, {{textOf(parameter, "parameter"), numbersOf(values, count)}}}});
    });
}

stromboli_code stromboli_session_move_object(stromboli_session* session, uint32_t number,
                                             const double motion[16], stromboli_error* error) {
    return guarded(error, [&] {
        glm::dmat4 matrix(1);
        if (motion) matrix = glm::make_mat4(motion);
        there(session, "session").session.moveObjects({{number, matrix}});
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
