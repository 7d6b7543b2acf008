// The C API of scenes: read from files, and made in memory.
#include "host/capi/calls.hpp"
#include "host/capi/handles.hpp"

#include "host/api/named_materials.hpp"
#include "host/engine/load_scene.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

using namespace stromboli;
using namespace stromboli::capi;

namespace {

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

/// The number of the first of that name.
template <class Things, class Name>
uint32_t numberOf(const Things& things, const char* name, Name nameOf, const char* what) {
    const std::string wanted = textOf(name, "name");
    const auto found = std::ranges::find(things, wanted, nameOf);
    if (found == things.end())
        throw UsageError(std::string("the scene has no ") + what + " '" + wanted + "'");
    return uint32_t(found - things.begin());
}

} // namespace

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
        const Scene& s = *there(scene, "scene").scene;
        there(number, "number") = numberOf(s.materials, name, &Material::name, "material");
    });
}

size_t stromboli_scene_light_count(const stromboli_scene* scene) {
    return scene ? scene->scene->lights.size() : 0;
}

stromboli_code stromboli_scene_find_light(const stromboli_scene* scene, const char* name,
                                          uint32_t* number, stromboli_error* error) {
    return guarded(error, [&] {
        const Scene& s = *there(scene, "scene").scene;
        there(number, "number") = numberOf(s.lights, name, &Light::name, "light");
    });
}

size_t stromboli_scene_object_count(const stromboli_scene* scene) {
    return scene ? scene->scene->instances.size() : 0;
}

const char* stromboli_scene_object_name(const stromboli_scene* scene, uint32_t number) {
    return number < stromboli_scene_object_count(scene) ? scene->scene->instances[number].c_str()
                                                        : nullptr;
}

stromboli_code stromboli_scene_find_object(const stromboli_scene* scene, const char* name,
                                           uint32_t* number, stromboli_error* error) {
    return guarded(error, [&] {
        const Scene& s = *there(scene, "scene").scene;
        there(number, "number") = numberOf(s.instances, name, std::identity{}, "object");
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

stromboli_code stromboli_maker_add_float_texture(stromboli_maker* maker, uint32_t width,
                                                 uint32_t height, uint32_t channels,
                                                 const float* values, uint32_t* number,
                                                 stromboli_error* error) {
    return guarded(error, [&] {
        there(number, "number");
        there(values, "values");
        if (channels != 3 && channels != 4) throw UsageError("a texture has 3 or 4 channels");
        const size_t count = size_t(channels) * width * height;
        *number = there(maker, "maker").maker.addTexture(width, height, std::span(values, count));
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
