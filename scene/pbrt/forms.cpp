#include "scene/pbrt/forms.hpp"

#include "scene/build/mesh_of_scene.hpp"
#include "scene/build/surface_mesh.hpp"
#include "scene/build/vectors.hpp"
#include "scene/ply/load_ply.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli::pbrt {
namespace {

/// Texture coordinates and normals of vertices, where there is one for each.
void readVertices(const Parameters& shape, Form& form) {
    build::Mesh& mesh = form.mesh;
    mesh.positions = shape.points("P");
    mesh.normals = shape.points("N");
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size()) {
        shape.replaceParameter("N", build::Shortfall::Attribute,
                               fmt::format("has {} normals for {} points", mesh.normals.size(),
                                           mesh.positions.size()));
        mesh.normals.clear();
    }
    mesh.isFlat = mesh.normals.empty();
    const char* name = shape.has("uv") ? "uv" : "st";
    const std::vector<double> uv = shape.numbers(name);
    form.hasCoordinates = !uv.empty() && uv.size() == 2 * mesh.positions.size();
    if (!uv.empty() && !form.hasCoordinates)
        shape.replaceParameter(
            name, build::Shortfall::Attribute,
            fmt::format("has {} numbers for {} points", uv.size(), mesh.positions.size()));
    if (form.hasCoordinates)
        for (size_t i = 0; i + 1 < uv.size(); i += 2) {
            const glm::vec2 at(uv[i], uv[i + 1]);
            const bool isThere = std::isfinite(at.x) && std::isfinite(at.y);
            mesh.attributes.emplace_back().uv[0] = isThere ? at : glm::vec2(0);
        }
    shape.skip({"S", "faceIndices"});
}

Form triangleMesh(const Parameters& shape) {
    Form form;
    readVertices(shape, form);
    std::vector<double> indices = shape.numbers("indices");
    if (indices.empty() && form.mesh.positions.size() == 3) indices = {0, 1, 2};
    addTriangles(shape, indices, form.mesh);
    return form;
}

Form plyMesh(Context& context, const Parameters& shape) {
    SceneConventions conventions = context.builder.conventions();
    conventions.defaultLight = false;
    conventions.strict = false; // Report::adopt is strict with what has a meaning
    const std::filesystem::path file =
        context.files.find(shape.place(), shape.text("filename").value_or(""));
    const Scene scene = loadPly(file, conventions);
    context.report().adopt(scene.report, [](const std::string&) { return false; });
    Form form;
    form.mesh = build::meshOfScene(scene);
    form.mesh.isFlat = form.mesh.normals.empty();
    if (!context.isV3()) form.countFaces = [file] { return facesOfPly(file); };
    for (VertexAttributes& a : form.mesh.attributes) {
        form.hasCoordinates = form.hasCoordinates || a.uv[0] != glm::vec2(0);
        a.uv[0].y = 1 - a.uv[0].y; // the reader turns v upside down
        a.color = glm::vec4(1);
    }
    if (shape.has("displacement"))
        shape.replace(build::Shortfall::Model, "'displacement' moves the surface",
                      "the mesh as it is");
    shape.skip({"displacement", "displacement.edgelength", "edgelength"});
    return form;
}

/// Patches between four corners each, (0, 0), (1, 0), (0, 1) and (1, 1) of u and v.
Form bilinearMesh(const Parameters& shape) {
    Form given;
    readVertices(shape, given);
    const build::Mesh& corners = given.mesh;
    shape.skip({"emissionfilename"}); // by which pbrt finds light, and not how much there is
    std::vector<double> indices = shape.numbers("indices");
    if (indices.empty() && corners.positions.size() == 4) indices = {0, 1, 2, 3};
    Form form;
    form.hasCoordinates = true;
    form.mesh.isFlat = false;
    form.mesh.parts.emplace_back();
    size_t lost = 0;
    for (size_t i = 0; i + 3 < indices.size(); i += 4) {
        std::array<size_t, 4> at{};
        bool isThere = true;
        for (size_t k = 0; k < 4; ++k) {
            isThere =
                isThere && indices[i + k] >= 0 && indices[i + k] < double(corners.positions.size());
            if (isThere) at[k] = size_t(indices[i + k]);
        }
        if (!isThere && ++lost) continue;
        ++form.patches;
        const auto mixed = [&](const auto& values, double s, double t) {
            return glm::mix(glm::mix(values[at[0]], values[at[1]], s),
                            glm::mix(values[at[2]], values[at[3]], s), t);
        };
        const auto p = [&](size_t k) { return corners.positions[at[k]]; };
        const glm::dvec3 twist = p(0) - p(1) - p(2) + p(3);
        const bool isPlane = glm::length(twist) <= 1e-9 * glm::length(p(3) - p(0));
        const uint32_t sides = isPlane ? 1 : 16;
        const build::Mesh patch = build::gridMesh(sides, sides, [&](double s, double t) {
            build::SurfacePoint point;
            point.position = mixed(corners.positions, s, t);
            const glm::dvec3 alongS = glm::mix(p(1) - p(0), p(3) - p(2), t),
                             alongT = glm::mix(p(2) - p(0), p(3) - p(1), s);
            point.normal =
                corners.normals.empty() ? glm::cross(alongS, alongT) : mixed(corners.normals, s, t);
            point.uv = {s, t};
            if (given.hasCoordinates)
                point.uv = glm::mix(glm::mix(glm::dvec2(corners.attributes[at[0]].uv[0]),
                                             glm::dvec2(corners.attributes[at[1]].uv[0]), s),
                                    glm::mix(glm::dvec2(corners.attributes[at[2]].uv[0]),
                                             glm::dvec2(corners.attributes[at[3]].uv[0]), s),
                                    t);
            return point;
        });
        const auto first = uint32_t(form.mesh.positions.size());
        for (build::MeshTriangle triangle : patch.parts.front()) {
            for (build::Corner& corner : triangle)
                corner = {corner.position + first, corner.normal + first,
                          corner.attributes + first};
            form.mesh.parts.front().push_back(triangle);
        }
        const auto append = [](auto& to, const auto& from) {
            to.insert(to.end(), from.begin(), from.end());
        };
        append(form.mesh.positions, patch.positions);
        append(form.mesh.normals, patch.normals);
        append(form.mesh.attributes, patch.attributes);
    }
    if (lost > 0)
        shape.replaceParameter("indices", build::Shortfall::Geometry,
                               fmt::format("has {} patches with corners that are not there", lost));
    return form;
}

/// A corner for each height, over the unit square.
Form heightField(const Parameters& shape) {
    const int64_t nu = shape.integer("nu").value_or(0), nv = shape.integer("nv").value_or(0);
    const std::vector<double> heights = shape.numbers("Pz");
    if (nu < 2 || nv < 2 || nu > 65536 || nv > 65536 || uint64_t(nu * nv) != heights.size())
        shape.place().fail(
            fmt::format("has {} heights for {} times {} points", heights.size(), nu, nv));
    Form form;
    form.hasCoordinates = true;
    form.mesh.isFlat = true;
    for (int64_t y = 0; y < nv; ++y)
        for (int64_t x = 0; x < nu; ++x) {
            const glm::dvec2 uv(double(x) / double(nu - 1), double(y) / double(nv - 1));
            form.mesh.positions.emplace_back(uv, heights[size_t(y * nu + x)]);
            form.mesh.attributes.emplace_back().uv[0] = uv;
        }
    build::MeshPart& part = form.mesh.parts.emplace_back();
    for (int64_t y = 0; y + 1 < nv; ++y)
        for (int64_t x = 0; x + 1 < nu; ++x) {
            const auto corner = [&](int64_t dx, int64_t dy) {
                const auto number = uint32_t((y + dy) * nu + x + dx);
                return build::Corner{number, kNoNormals, number};
            };
            part.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
            part.push_back({corner(0, 0), corner(1, 1), corner(0, 1)});
        }
    return form;
}

} // namespace

void addTriangles(const Parameters& shape, const std::vector<double>& indices, build::Mesh& mesh) {
    build::MeshPart& part = mesh.parts.emplace_back();
    const auto count = double(mesh.positions.size());
    const bool hasNormals = !mesh.normals.empty(), hasAttributes = !mesh.attributes.empty();
    size_t lost = indices.size() % 3 == 0 ? 0 : 1;
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        build::MeshTriangle triangle;
        bool isThere = true;
        for (size_t k = 0; k < 3; ++k) {
            const double index = indices[i + k];
            isThere = isThere && index >= 0 && index < count;
            const uint32_t number = isThere ? uint32_t(index) : 0;
            triangle[k] = {number, hasNormals ? number : kNoNormals,
                           hasAttributes ? number : kNoAttributes};
        }
        if (isThere)
            part.push_back(triangle);
        else
            ++lost;
    }
    if (lost > 0)
        shape.replaceParameter(
            "indices", build::Shortfall::Geometry,
            fmt::format("has {} triangles with corners that are not there", lost));
    if (part.empty()) shape.place().fail("has no triangles");
}

Form formOf(Context& context, const std::string& kind, const Parameters& shape) {
    if (kind == "trianglemesh") return triangleMesh(shape);
    if (kind == "plymesh") return plyMesh(context, shape);
    if (std::optional<Form> form = revolvedForm(kind, shape)) return *std::move(form);
    if (kind == "bilinearmesh") return bilinearMesh(shape);
    if (kind == "loopsubdiv") return subdividedForm(shape);
    if (kind == "curve") return curveForm(context, shape);
    if (kind == "heightfield") return heightField(shape);
    if (kind == "nurbs") return nurbsForm(shape);
    shape.place().fail(fmt::format(
        "'{}' is no shape that is read, expected trianglemesh, plymesh, sphere, cylinder, disk, "
        "cone, paraboloid, hyperboloid, bilinearmesh, loopsubdiv, curve, heightfield or nurbs",
        kind));
}

} // namespace stromboli::pbrt
