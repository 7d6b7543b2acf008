#include "scene/gltf/draco.hpp"

#include <draco/compression/decode.h>
#include <draco/core/decoder_buffer.h>
#include <draco/mesh/mesh.h>
#include <fmt/format.h>

#include <limits>
#include <memory>

namespace stromboli::gltf {
namespace {

std::unique_ptr<draco::Mesh> decodeMesh(const Element& extension, std::string_view packed) {
    draco::DecoderBuffer buffer;
    buffer.Init(packed.data(), packed.size());
    draco::Decoder decoder;
    auto result = decoder.DecodeMeshFromBuffer(&buffer);
    if (!result.ok())
        extension.fail(
            fmt::format("the packed mesh is damaged: {}", result.status().error_msg_string()));
    return std::move(result).value();
}

Values valuesOf(const Element& extension, const draco::Mesh& mesh, uint64_t id,
                const AccessorType& type) {
    const draco::PointAttribute* attribute = id <= std::numeric_limits<uint32_t>::max()
                                                 ? mesh.GetAttributeByUniqueId(uint32_t(id))
                                                 : nullptr;
    if (!attribute) extension.fail(fmt::format("names attribute {}, which is not there", id));
    Values values{mesh.num_points(), type.width, {}};
    values.numbers.resize(values.count * values.width);
    const double factor = normalization(type);
    std::vector<float> element(std::max<size_t>(type.width, attribute->num_components()));
    for (uint32_t i = 0; i < mesh.num_points(); ++i) {
        const draco::AttributeValueIndex place = attribute->mapped_index(draco::PointIndex(i));
        if (!attribute->ConvertValue(place, int8_t(type.width), element.data()))
            extension.fail(fmt::format("attribute {} cannot be read", id));
        // The library makes fractions of normalised integers itself where its attribute says so.
        const double scale = attribute->normalized() ? 1 : factor;
        for (size_t k = 0; k < type.width; ++k)
            values.numbers[i * type.width + k] = double(element[k]) * scale;
    }
    return values;
}

} // namespace

UnpackedPrimitive unpackDraco(const Document& document, const Element& primitive,
                              const Element& extension) {
    const std::optional<size_t> view = extension.index("bufferView", document.size("bufferViews"));
    if (!view) extension.fail("has no 'bufferView'");
    const std::unique_ptr<draco::Mesh> mesh = decodeMesh(extension, document.bytesOfView(*view));
    UnpackedPrimitive unpacked;
    unpacked.indices.reserve(size_t(mesh->num_faces()) * 3);
    for (uint32_t face = 0; face < mesh->num_faces(); ++face)
        for (const draco::PointIndex& point : mesh->face(draco::FaceIndex(face)))
            unpacked.indices.push_back(point.value());
    const std::optional<Element> ids = extension.child("attributes");
    const std::optional<Element> accessors = primitive.child("attributes");
    if (!ids || !accessors) extension.fail("has no 'attributes'");
    for (const std::string& name : ids->names()) {
        const std::optional<size_t> accessor = accessors->index(name, document.size("accessors"));
        if (!accessor) continue;
        const AccessorType type = typeOf(document.at("accessors", *accessor));
        unpacked.attributes.emplace(name, valuesOf(extension, *mesh, ids->count(name), type));
    }
    return unpacked;
}

} // namespace stromboli::gltf
