#include "scene/pbrt/shapes.hpp"

#include "scene/build/surface_mesh.hpp"
#include "scene/build/tangents.hpp"
#include "scene/build/vectors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stromboli::pbrt {
namespace {

/// Each corner has attributes of its own; where there are no coordinates, those that pbrt takes.
void spreadCorners(build::Mesh& mesh) {
    std::vector<VertexAttributes> spread;
    const glm::vec2 defaults[3] = {{0, 0}, {1, 0}, {1, 1}};
    for (build::MeshPart& part : mesh.parts)
        for (build::MeshTriangle& triangle : part)
            for (size_t k = 0; k < 3; ++k) {
                uint32_t& number = triangle[k].attributes;
                VertexAttributes a;
                if (number == kNoAttributes)
                    a.uv[0] = defaults[k];
                else
                    a = mesh.attributes[number];
                number = uint32_t(spread.size());
                spread.push_back(a);
            }
    mesh.attributes = std::move(spread);
}

/// Sets the second coordinates.
void mapCorners(const Mapping& mapping, const glm::dmat4& toWorld, build::Mesh& mesh) {
    for (const build::MeshPart& part : mesh.parts)
        for (const build::MeshTriangle& triangle : part)
            for (const build::Corner& corner : triangle) {
                const glm::vec2 st(mapping.at(
                    glm::dvec3(toWorld * glm::dvec4(mesh.positions[corner.position], 1))));
                const bool isThere = std::isfinite(st.x) && std::isfinite(st.y);
                mesh.attributes[corner.attributes].uv[1] = isThere ? st : glm::vec2(0);
            }
}

void dropAttributes(build::Mesh& mesh) {
    mesh.attributes.clear();
    for (build::MeshPart& part : mesh.parts)
        for (build::MeshTriangle& triangle : part)
            for (build::Corner& corner : triangle)
                corner.attributes = kNoAttributes;
}

} // namespace

void Shapes::place(const Part& part) {
    context_.builder.place(part.place, part.shape, part.worldFromObject,
                           std::span(&part.material, 1), part.name);
}

void Shapes::add(const std::string& kind, const Parameters& shape, const ShapeState& state,
                 std::vector<Part>* object) {
    Form form = formOf(context_, kind, shape);
    if (kind == "curve" && addToCurves(form, shape, state, object)) return;
    finishCurves(object);
    addForm(std::move(form), kind, shape, state, object);
}

bool Shapes::addToCurves(const Form& form, const Parameters& shape, const ShapeState& state,
                         std::vector<Part>* object) {
    const bool isPlain =
        !state.light && !shape.has("alpha") && (!context_.isV3() || shape.unread().empty());
    constexpr size_t kMostPoints = 4'000'000;
    if (curves_ && (!isPlain || curves_->state.material != state.material ||
                    curves_->state.media != state.media ||
                    curves_->state.worldFromObject != state.worldFromObject ||
                    curves_->form.mesh.positions.size() > kMostPoints))
        finishCurves(object);
    if (!isPlain) return false;
    shape.reportUnread();
    if (!curves_) {
        curves_ = Curves{form, state, shape};
        return true;
    }
    build::Mesh& all = curves_->form.mesh;
    const auto first = uint32_t(all.positions.size());
    const auto append = [](auto& to, const auto& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    append(all.positions, form.mesh.positions);
    append(all.normals, form.mesh.normals);
    append(all.attributes, form.mesh.attributes);
    for (build::MeshTriangle triangle : form.mesh.parts.front()) {
        for (build::Corner& corner : triangle)
            corner = {corner.position + first, corner.normal + first, corner.attributes + first};
        all.parts.front().push_back(triangle);
    }
    return true;
}

void Shapes::finishCurves(std::vector<Part>* object) {
    if (!curves_) return;
    Curves curves = *std::move(curves_);
    curves_.reset();
    addForm(std::move(curves.form), "curve", curves.shape, curves.state, object);
}

std::optional<Pattern> Shapes::alphaOf(const Parameters& shape, const ShapeState& state) {
    if (shape.has("shadowalpha")) {
        shape.skip({"shadowalpha"});
        context_.report().ignore("'shadowalpha' of shapes", "shadows go by 'alpha' here");
    }
    if (!shape.has("alpha")) return std::nullopt;
    const Pattern alpha =
        textures_.pattern(shape, "alpha", ColorOf::Number, glm::dvec3(1), *state.textures, true);
    if (alpha.isConstant && alpha.color.x >= 1) return std::nullopt;
    return alpha;
}

/// In pbrt each triangle or patch of a mesh is a light of its own, which `power` is of. Here a mesh
/// is one, of as much light: the area is that of one of them in the mean.
double Shapes::lightArea(Form& form, const ShapeState& state, const std::string& kind) {
    const glm::dmat4& m = state.worldFromObject;
    if (form.sphereRadius && build::isSimilarity(m)) {
        const double radius = *form.sphereRadius * build::axisLengths(m).x;
        return 4 * std::numbers::pi * radius * radius;
    }
    form.requireMesh();
    const auto at = [&](const build::Corner& corner) {
        return glm::dvec3(m * glm::dvec4(form.mesh.positions[corner.position], 1));
    };
    double area = 0;
    size_t count = 0;
    for (const build::MeshPart& part : form.mesh.parts)
        for (const build::MeshTriangle& t : part) {
            area += glm::length(glm::cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]))) / 2;
            ++count;
        }
    const bool isMesh = kind == "trianglemesh" || kind == "plymesh" || kind == "loopsubdiv" ||
                        kind == "heightfield" || kind == "nurbs";
    size_t lights = isMesh ? count : form.patches;
    if (const size_t faces = form.countFaces ? form.countFaces() : 0; faces > 0) lights = faces;
    return area / double(std::max<size_t>(lights, 1));
}

void Shapes::fit(const BoundMaterial& material, const ShapeState& state, Form& form) {
    build::Mesh& mesh = form.mesh;
    if (!material.wantsCoordinates && !material.wantsTangents) return dropAttributes(mesh);
    if (!form.hasCoordinates || material.mapping) spreadCorners(mesh);
    if (material.mapping) mapCorners(*material.mapping, state.worldFromObject, mesh);
    if (!material.wantsTangents) return;
    for (size_t part = 0; part < mesh.parts.size(); ++part)
        build::computeTangents(mesh, part, 0);
    // pbrt's frames are right-handed, whichever way v grows.
    for (VertexAttributes& a : mesh.attributes)
        if (a.tangent.w != 0) a.tangent.w = 1;
}

void Shapes::addForm(Form form, const std::string& kind, const Parameters& shape,
                     const ShapeState& state, std::vector<Part>* object) {
    std::optional<Emission> emission;
    std::optional<Pattern> alpha = alphaOf(shape, state);
    const std::string& ofKind = state.material->kind;
    const bool isNothing = ofKind == "interface" || ofKind == "none" || ofKind.empty();
    if (state.light && object)
        shape.replace(build::Shortfall::Model, "is an area light in an object",
                      "a surface without light, as in pbrt");
    else if (state.light && isNothing && !context_.isV3())
        shape.replace(build::Shortfall::Model, "is an area light of the material 'interface'",
                      "a surface without light, as in pbrt");
    else if (state.light)
        emission = lights_.emission(state.light->kind, state.light->parameters,
                                    lightArea(form, state, kind));
    if (emission && alpha && alpha->isConstant && !(alpha->color.x > 0) && !context_.isV3()) {
        // It gives all its light. The less it hides of what is behind it, the more noise its
        // reflections have.
        constexpr double kShare = 1.0 / 4;
        shape.replace(build::Shortfall::Model, "is an area light that is not seen: 'alpha' is 0",
                      "a light that is seen, and seen through");
        alpha = Pattern::constant(glm::dvec3(kShare));
        emission->radiance /= float(kShare);
    }
    const BoundMaterial material =
        materials_.of(state.material, {state.textures.get(), state.materials.get()}, shape,
                      emission, alpha, state.media);
    shape.reportUnread();
    const bool sidesDiffer = emission || material.isTransparent;
    const bool staysSphere = form.sphereRadius && !material.wantsCoordinates &&
                             !material.wantsTangents && !(state.isReversed && sidesDiffer) &&
                             build::isSimilarity(state.worldFromObject);
    Part part{shape.place(), {}, state.worldFromObject, material.number, kind};
    if (staysSphere) {
        part.shape = context_.builder.addSphere(kind, *form.sphereRadius);
    } else {
        form.requireMesh();
        fit(material, state, form);
        if (state.isReversed) build::flip(form.mesh);
        part.shape = context_.builder.addMesh(kind, std::move(form.mesh));
    }
    if (object)
        object->push_back(std::move(part));
    else
        place(part);
}

} // namespace stromboli::pbrt
