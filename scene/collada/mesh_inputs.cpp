// The part of MeshReader that finds where positions, normals and attributes come from.

#include "scene/collada/primitives.hpp"
#include "scene/collada/sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace stromboli::collada {

void MeshReader::reportUnused(const Element& input, const TexcoordInputs& used) const {
    if (&input == used[0] || &input == used[1]) return;
    const std::string semantic = context_.document.requireAttribute(input, "semantic");
    const bool isTexcoord = semantic == "TEXCOORD";
    context_.report.ignore(fmt::format("<input semantic=\"{}\">", semantic),
                           isTexcoord ? "no texture looks them up"
                                      : "it has no effect on the picture");
}

void MeshReader::readVertices(const Element& meshElement) {
    const Document& document = context_.document;
    vertices_ = &document.require(meshElement, "vertices");
    bool found = false;
    for (const Element& input : children(*vertices_)) {
        if (!named(input, "input")) continue;
        const std::string semantic = document.requireAttribute(input, "semantic");
        if (semantic == "POSITION" && !found) {
            const Element& source = document.resolve(input, "source", "source");
            mesh_.positions = readVectors<3>(document, source, NonFinite::Reject);
            found = true;
        } else if (semantic == "NORMAL" && !vertexNormals_) {
            vertexNormals_ = &input;
        } else {
            vertexOthers_.push_back(&input);
        }
    }
    if (!found)
        document.fail(*vertices_, "has no <input semantic=\"POSITION\">: a mesh needs positions");
}

MeshReader::NormalRange MeshReader::normalsOf(const Element& input) {
    const Element& source = context_.document.resolve(input, "source", "source");
    const auto [found, isNew] = normalRanges_.try_emplace(&source);
    if (isNew) {
        // Exporters write NaN for the normals of degenerate faces; such normals are not used.
        const std::vector<glm::dvec3> normals =
            readVectors<3>(context_.document, source, NonFinite::Allow);
        found->second = {uint32_t(mesh_.normals.size()), uint32_t(normals.size())};
        mesh_.normals.insert(mesh_.normals.end(), normals.begin(), normals.end());
    }
    return found->second;
}

MeshReader::Inputs MeshReader::readInputs(const Element& primitive,
                                          const TexcoordInputs& texcoords) {
    const Document& document = context_.document;
    Inputs inputs;
    const Element *vertex = nullptr, *normal = nullptr, *color = nullptr;
    uint32_t largest = 0;
    for (const Element& input : children(primitive)) {
        if (!named(input, "input")) continue;
        const std::string semantic = document.requireAttribute(input, "semantic");
        const uint32_t offset = readCount(document, input, "offset");
        largest = std::max(largest, offset);
        if (semantic == "VERTEX" && !vertex) {
            vertex = &input;
            inputs.vertexOffset = offset;
        } else if (semantic == "NORMAL" && !normal) {
            normal = &input;
            inputs.normalOffset = offset;
        } else if (semantic == "COLOR" && !color && context_.conventions.textures) {
            color = &input;
        } else {
            reportUnused(input, texcoords);
        }
    }
    for (const Element* input : vertexOthers_) {
        const bool isColor = std::string_view(input->Attribute("semantic")) == "COLOR";
        if (isColor && !color && context_.conventions.textures)
            color = input;
        else
            reportUnused(*input, texcoords);
    }
    if (color)
        context_.report.assume("colours of corners are linear and multiply the diffuse colour");
    if (!vertex) document.fail(primitive, "has no <input semantic=\"VERTEX\">");
    if (&document.resolve(*vertex, "source", "vertices") != vertices_)
        document.fail(*vertex, "its source is the <vertices> of another mesh");
    if (!normal && vertexNormals_) {
        normal = vertexNormals_;
        inputs.normalOffset = inputs.vertexOffset;
    }
    inputs.hasNormals = normal != nullptr;
    if (normal) inputs.normals = normalsOf(*normal);
    inputs.stride = largest + 1;
    if (inputs.stride == 0) document.fail(primitive, "an <input> has an offset that is too large");
    attributes_.begin(texcoords, color, inputs.vertexOffset);
    return inputs;
}

std::vector<Corner> MeshReader::readCorners(const Element& p, const Inputs& inputs) {
    const std::vector<uint32_t> indices = readIndices(context_.document, p);
    if (indices.size() % inputs.stride != 0)
        context_.document.fail(p, fmt::format("has {} indices, not a multiple of {} (one per input "
                                              "of a corner)",
                                              indices.size(), inputs.stride));
    const auto check = [&](uint32_t index, size_t count, std::string_view what) {
        if (index >= count)
            context_.document.fail(
                p, fmt::format("{} index {} is out of range: there are {}", what, index, count));
        return index;
    };
    std::vector<Corner> corners(indices.size() / inputs.stride);
    const uint32_t* at = indices.data();
    for (Corner& corner : corners) {
        corner.position = check(at[inputs.vertexOffset], mesh_.positions.size(), "position");
        corner.normal = kNoNormals;
        if (inputs.hasNormals)
            corner.normal = inputs.normals.first +
                            check(at[inputs.normalOffset], inputs.normals.count, "normal");
        corner.attributes = attributes_.of(at, p);
        at += inputs.stride;
    }
    return corners;
}

} // namespace stromboli::collada
