#include "scene/gltf/meshes.hpp"

#include "host/core/error.hpp"
#include "scene/build/corner_paint.hpp"
#include "scene/build/tangents.hpp"
#include "scene/gltf/deform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli::gltf {
namespace {

/// What vertices have beside position and normal. Coordinates that are not finite become 0.
std::vector<VertexAttributes> attributesOf(const Primitive& p, const Element& at,
                                           build::Report& report) {
    std::vector<VertexAttributes> attributes(p.vertexCount);
    bool finite = true;
    const auto number = [&](double value) {
        finite = finite && std::isfinite(value);
        return std::isfinite(value) ? float(value) : 0.0f;
    };
    for (size_t i = 0; i < p.vertexCount; ++i) {
        VertexAttributes& a = attributes[i];
        for (size_t set = 0; set < 2; ++set)
            if (p.uvs[set])
                a.uv[set] = {number(p.uvs[set]->at(i)[0]), number(p.uvs[set]->at(i)[1])};
        if (p.colors)
            for (size_t k = 0; k < p.colors->width; ++k)
                a.color[int(k)] = std::max(number(p.colors->at(i)[k]), 0.0f);
        if (p.tangents) {
            a.tangent = p.tangents->vec4(i);
            // The builder leaves out what has no direction; here a sense is all that is needed.
            a.tangent.w = p.tangents->vec4(i).w < 0 ? -1.0f : 1.0f;
        }
    }
    if (!finite)
        report.warn(fmt::format("{}: texture coordinates or colours that are not finite become 0",
                                at.path()));
    return attributes;
}

} // namespace

std::optional<BuiltMesh> Meshes::get(size_t index, const Deformation& deformation) {
    const Element element = context_.document.at("meshes", index);
    if (!deformation.isNone()) return make(element, deformation);
    const auto found = made_.find(index);
    if (found != made_.end()) return found->second;
    return made_.emplace(index, make(element, deformation)).first->second;
}

std::optional<BuiltMesh> Meshes::make(const Element& element, const Deformation& deformation) {
    const std::vector<double> weights =
        deformation.weights.empty() ? element.numbersOr("weights", 0) : deformation.weights;
    build::Mesh mesh;
    BuiltMesh built;
    for (const Element& at : element.items("primitives")) {
        const BoundMaterial& material = materials_.of(at);
        try {
            std::optional<Primitive> primitive = readPrimitive(context_, at, material.uvSets.sets);
            if (!primitive) continue;
            applyTargets(*primitive, weights);
            const bool hasSkin = !deformation.joints.empty() && !primitive->joints.empty();
            const size_t weightless = hasSkin ? applySkin(*primitive, deformation.joints, at) : 0;
            if (weightless > 0)
                context_.report().forgive(at.place(),
                                          fmt::format("{} vertices have no weight", weightless),
                                          "they move with the joint that they name first");
            built.materials.push_back(append(at, std::move(*primitive), material, mesh));
        } catch (const SceneError& error) {
            context_.report().replace(error, build::Shortfall::Geometry);
        }
    }
    if (mesh.parts.empty()) return std::nullopt;
    built.shape = context_.builder.addMesh(element.displayName(), std::move(mesh));
    return built;
}

/// Adds a part. Corners have attributes only where something looks at them.
uint32_t Meshes::append(const Element& at, Primitive&& p, const BoundMaterial& material,
                        build::Mesh& mesh) {
    const auto firstPosition = uint32_t(mesh.positions.size());
    const auto firstNormal = uint32_t(mesh.normals.size());
    const auto firstAttributes = uint32_t(mesh.attributes.size());
    for (size_t i = 0; i < p.vertexCount; ++i)
        mesh.positions.push_back(p.positions.vec3(i));
    for (size_t i = 0; p.normals && i < p.vertexCount; ++i)
        mesh.normals.push_back(p.normals->vec3(i));

    for (size_t set = 0; set < 2; ++set)
        if (material.uvSets.used[set] && !p.uvs[set])
            context_.report().warn(fmt::format("{}: has no TEXCOORD_{}, which its material looks "
                                               "up pictures by; (0, 0) is taken",
                                               at.path(), material.uvSets.sets[set]));
    const bool wantsAttributes = material.isTextured || material.tangentSet || p.colors;
    if (wantsAttributes) {
        const std::vector<VertexAttributes> attributes = attributesOf(p, at, context_.report());
        mesh.attributes.insert(mesh.attributes.end(), attributes.begin(), attributes.end());
    }
    build::MeshPart part;
    part.reserve(p.triangles.size());
    for (const std::array<uint32_t, 3>& t : p.triangles) {
        build::MeshTriangle triangle;
        for (size_t i = 0; i < 3; ++i)
            triangle[i] = {firstPosition + t[i], p.normals ? firstNormal + t[i] : kNoNormals,
                           wantsAttributes ? firstAttributes + t[i] : kNoAttributes};
        part.push_back(triangle);
    }
    uint32_t number = material.number;
    if (p.colors && material.unlit) number = withColors(*material.unlit, mesh, part);
    mesh.parts.push_back(std::move(part));
    if (material.tangentSet && !p.tangents)
        build::computeTangents(mesh, mesh.parts.size() - 1, *material.tangentSet);
    const auto& rows = material.tangentRows;
    if (rows[0] != glm::dvec2(1, 0) || rows[1] != glm::dvec2(0, 1))
        build::turnTangents(mesh, mesh.parts.size() - 1, rows[0], rows[1]);
    return number;
}

/// The colours of corners multiply what an unlit material emits: where they differ, as a picture by
/// the texture coordinates that the material's own picture leaves. Their alpha stays with the
/// corners. Returns the number of a material for this part alone.
uint32_t Meshes::withColors(Material unlit, build::Mesh& mesh, build::MeshPart& part) {
    const auto colorOf = [&](const build::Corner& corner) {
        const glm::vec3 color(mesh.attributes[corner.attributes].color);
        return glm::clamp(color, 0.0f, 1.0f);
    };
    const glm::vec3 first = part.empty() ? glm::vec3(1) : colorOf(part[0][0]);
    const bool areAlike = std::ranges::all_of(part, [&](const build::MeshTriangle& t) {
        return std::ranges::all_of(t, [&](const build::Corner& c) { return colorOf(c) == first; });
    });
    if (areAlike) {
        unlit.emission *= first;
    } else {
        const auto usesSecond = [](const TextureUse& use) { return use.uvSet == 1; };
        TextureUse paint{.slot = TextureSlot::Emission};
        paint.uvSet = std::ranges::any_of(unlit.textures, usesSecond) ? 0 : 1;
        const uint32_t image = context_.builder.addImage(
            build::paintOfCorners(mesh.attributes, part, build::Layout::Color, true));
        paint.texture = context_.builder.addTexture({.image = image});
        unlit.textures.push_back(paint);
        const std::vector<VertexAttributes> spread =
            build::spreadCorners(mesh.attributes, part, paint.uvSet, mesh.attributes.size());
        mesh.attributes.insert(mesh.attributes.end(), spread.begin(), spread.end());
    }
    for (const build::MeshTriangle& triangle : part)
        for (const build::Corner& corner : triangle) {
            glm::vec4& color = mesh.attributes[corner.attributes].color;
            color = glm::vec4(1, 1, 1, color.a);
        }
    return context_.builder.addMaterial(std::move(unlit));
}

} // namespace stromboli::gltf
