// Scenes: read from files, and made in memory.
#include "host/api/named_materials.hpp"
#include "host/api/scene_maker.hpp"
#include "host/engine/load_scene.hpp"
#include "python/parts.hpp"

#include <array>
#include <optional>
#include <string>

namespace stromboli::python {

const Material& materialOf(const std::vector<Material>& materials, uint32_t number) {
    if (number >= materials.size())
        throw UsageError("there is no material " + std::to_string(number));
    return materials[number];
}

glm::dmat4 matrixOf(const Doubles& numbers) {
    glm::dmat4 matrix(1);
    if (numbers.size() == 16)
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                matrix[column][row] = numbers.data()[4 * row + column];
    return matrix;
}

py::dict valuesOf(const Material& material) {
    py::dict result;
    result["name"] = material.name;
    result["kind"] = std::string(api::kindOf(material));
    for (const api::NamedThing& row : api::materialParameters(api::kindOf(material))) {
        const std::vector<double> values = api::materialValue(material, row.name);
        result[py::str(row.name)] =
            values.size() == 1 ? py::object(py::float_(values[0])) : py::object(py::cast(values));
    }
    return result;
}

namespace {

py::dict reportOf(const LoadReport& report) {
    py::dict result;
    result["warnings"] = report.warnings;
    result["forgiven"] = report.forgiven;
    result["ignored"] = report.ignored;
    result["assumed"] = report.assumed;
    return result;
}

SceneHandle load(const std::string& source, const py::dict& settings) {
    SceneRequest request;
    request.source = source;
    forEach(settings, [&](const std::string& name, const api::Value& value) {
        api::setReading(request, name, value);
    });
    const py::gil_scoped_release others;
    return {loadScene(request).scene};
}

void addMesh(api::SceneMaker& maker, const std::string& name, const Doubles& positions,
             const Indices& triangles, uint32_t material, const Doubles& normals,
             const Doubles& uvs, const Doubles& toWorld) {
    api::MeshArrays mesh;
    mesh.name = name;
    mesh.positions = spanOf(positions), mesh.triangles = spanOf(triangles);
    mesh.normals = spanOf(normals), mesh.uvs = spanOf(uvs);
    mesh.material = material;
    mesh.toWorld = matrixOf(toWorld);
    maker.addMesh(mesh);
}

glm::dvec3 vectorOf(const std::array<double, 3>& v) {
    return {v[0], v[1], v[2]};
}
using Triple = std::array<double, 3>;

void addLight(api::SceneMaker& maker, const std::string& kind, const std::string& name,
              const Triple& color, const Triple& position, const Triple& direction,
              const std::array<double, 2>& size, double angle, std::optional<double> inner) {
    maker.addLight({kind,
                    name,
                    vectorOf(color),
                    vectorOf(position),
                    vectorOf(direction),
                    {size[0], size[1]},
                    angle,
                    inner});
}

void addCamera(api::SceneMaker& maker, const std::string& name, const Triple& from,
               const Triple& at, const Triple& up, double fov, double aperture, double focus) {
    maker.addCamera({name, vectorOf(from), vectorOf(at), vectorOf(up), fov, aperture, focus});
}

} // namespace

void defineScenes(py::module_& m) {
    py::class_<SceneHandle>(m, "Scene")
        .def_property_readonly("file", [](const SceneHandle& s) { return s.scene->file; })
        .def_property_readonly("triangle_count",
                               [](const SceneHandle& s) { return s.scene->placedTriangles(); })
        .def_property_readonly("material_count",
                               [](const SceneHandle& s) { return s.scene->materials.size(); })
        .def("material",
             [](const SceneHandle& s, uint32_t number) {
                 return valuesOf(materialOf(s.scene->materials, number));
             })
        .def_property_readonly("lights",
                               [](const SceneHandle& s) {
                                   std::vector<std::string> names;
                                   for (const Light& light : s.scene->lights)
                                       names.push_back(light.name);
                                   return names;
                               })
        .def_property_readonly("objects", [](const SceneHandle& s) { return s.scene->instances; })
        .def_property_readonly("cameras",
                               [](const SceneHandle& s) {
                                   std::vector<std::string> names;
                                   for (const FileCamera& camera : s.scene->cameras)
                                       names.push_back(camera.name);
                                   return names;
                               })
        .def_property_readonly("bounds",
                               [](const SceneHandle& s) {
                                   const Bounds b = s.scene->bounds();
                                   const glm::dvec3 lo = glm::dvec3(b.lo) + s.scene->origin,
                                                    hi = glm::dvec3(b.hi) + s.scene->origin;
                                   return py::make_tuple(py::make_tuple(lo.x, lo.y, lo.z),
                                                         py::make_tuple(hi.x, hi.y, hi.z));
                               })
        .def_property_readonly("report",
                               [](const SceneHandle& s) { return reportOf(s.scene->report); });
    m.def("load", &load);

    py::class_<api::SceneMaker>(m, "SceneMaker")
        .def(py::init<std::string>())
        .def("material",
             [](api::SceneMaker& maker, const std::string& kind, const std::string& name,
                const py::dict& parameters) {
                 Material material = api::makeMaterial(kind, name);
                 forEach(parameters, [&](const std::string& parameter, const api::Value& value) {
                     api::setMaterial(material, parameter, value);
                 });
                 return maker.addMaterial(std::move(material));
             })
        .def("texture",
             [](api::SceneMaker& maker, const Bytes& image, bool srgb) {
                 if (image.ndim() != 3)
                     throw UsageError("a texture is an array of height x width x 3 or 4 bytes");
                 return maker.addTexture(uint32_t(image.shape(1)), uint32_t(image.shape(0)),
                                         spanOf(image), srgb);
             })
        .def("float_texture",
             [](api::SceneMaker& maker, const Floats& image) {
                 if (image.ndim() != 3)
                     throw UsageError("a texture is an array of height x width x 3 or 4 numbers");
                 return maker.addTexture(uint32_t(image.shape(1)), uint32_t(image.shape(0)),
                                         spanOf(image));
             })
        .def("use_texture", &api::SceneMaker::useTexture)
        .def("mesh", &addMesh)
        .def("sphere",
             [](api::SceneMaker& maker, const std::string& name, const Triple& center,
                double radius,
                uint32_t material) { maker.addSphere(name, vectorOf(center), radius, material); })
        .def("light", &addLight)
        .def("camera", &addCamera)
        .def("environment",
             [](api::SceneMaker& maker, const Floats& radiance, double strength, double rotation) {
                 if (radiance.ndim() != 3)
                     throw UsageError("an environment is an array of height x width x 3 radiances");
                 maker.setEnvironment(uint32_t(radiance.shape(1)), uint32_t(radiance.shape(0)),
                                      spanOf(radiance), strength, rotation);
             })
        .def("finish", [](api::SceneMaker& maker) { return SceneHandle{maker.finish()}; });
}

} // namespace stromboli::python
