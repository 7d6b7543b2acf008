#include "scene/gltf/meshopt.hpp"

#include "scene/build/read_file.hpp"

#include <fmt/format.h>
#include <meshoptimizer.h>

namespace stromboli::gltf {
namespace {

/// Elements that a byte can stand for: of each byte of the vertices' stride, sixteen that do not
/// change take two bits. Indices take more.
constexpr uint64_t kMeshoptRatio = 64;

void requireSizes(const Element& extension, const std::string& mode, uint64_t count,
                  uint64_t stride) {
    const bool vertices = mode == "ATTRIBUTES";
    if (vertices && (stride == 0 || stride % 4 != 0 || stride > 256))
        extension.fail("byteStride",
                       fmt::format("is {}, expected a multiple of 4 up to 256", stride));
    if (!vertices && stride != 2 && stride != 4)
        extension.fail("byteStride", fmt::format("is {}, expected 2 or 4", stride));
    if (mode == "TRIANGLES" && count % 3 != 0)
        extension.fail("count", fmt::format("is {}, expected a multiple of 3", count));
}

void applyFilter(const Element& extension, std::string& bytes, uint64_t count, uint64_t stride) {
    const std::string filter = extension.text("filter", "NONE");
    const auto require = [&](bool fits) {
        if (!fits)
            extension.fail("filter",
                           fmt::format("{} does not go with a stride of {}", filter, stride));
    };
    if (filter == "NONE") return;
    if (filter == "OCTAHEDRAL") {
        require(stride == 4 || stride == 8);
        meshopt_decodeFilterOct(bytes.data(), count, stride);
    } else if (filter == "QUATERNION") {
        require(stride == 8);
        meshopt_decodeFilterQuat(bytes.data(), count, stride);
    } else if (filter == "EXPONENTIAL") {
        require(stride % 4 == 0);
        meshopt_decodeFilterExp(bytes.data(), count, stride);
    } else {
        extension.fail("filter", fmt::format("is '{}', expected NONE, OCTAHEDRAL, QUATERNION or "
                                             "EXPONENTIAL",
                                             filter));
    }
}

} // namespace

std::string unpackMeshopt(const Element& extension, std::string_view packed) {
    const uint64_t count = extension.count("count"), stride = extension.count("byteStride");
    const std::string mode = extension.text("mode");
    requireSizes(extension, mode, count, stride);
    if (count > packed.size() * kMeshoptRatio)
        extension.fail(
            "count", fmt::format("is {}, which {} packed bytes cannot hold", count, packed.size()));
    build::requireMemory(extension.place().file, count * stride);
    std::string bytes(count * stride, '\0');
    const auto* from = reinterpret_cast<const unsigned char*>(packed.data());
    int result = -1;
    if (mode == "ATTRIBUTES")
        result = meshopt_decodeVertexBuffer(bytes.data(), count, stride, from, packed.size());
    else if (mode == "TRIANGLES")
        result = meshopt_decodeIndexBuffer(bytes.data(), count, stride, from, packed.size());
    else if (mode == "INDICES")
        result = meshopt_decodeIndexSequence(bytes.data(), count, stride, from, packed.size());
    else
        extension.fail("mode",
                       fmt::format("is '{}', expected ATTRIBUTES, TRIANGLES or INDICES", mode));
    if (result != 0) extension.fail("the packed data are damaged");
    applyFilter(extension, bytes, count, stride);
    return bytes;
}

} // namespace stromboli::gltf
