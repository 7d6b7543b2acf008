#include "scene/gltf/primitives.hpp"

#include "host/core/error.hpp"
#include "scene/gltf/draco.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace stromboli::gltf {
namespace {

enum Mode : uint64_t { kTriangles = 4, kStrip = 5, kFan = 6 };

/// Reads the attributes of one primitive, packed or not.
class PrimitiveReader {
  public:
    PrimitiveReader(Context& context, const Element& at) : context_(context), at_(at) {
        if (const auto packed = at.extension("KHR_draco_mesh_compression"))
            unpacked_ = unpackDraco(context.document, at.strictly(), packed->strictly());
    }

    std::optional<Primitive> read(const std::array<uint32_t, 2>& uvSets) {
        const std::optional<Element> attributes = at_.child("attributes");
        if (!attributes) at_.fail("has no 'attributes'");
        std::optional<Values> positions = values(attributes->strictly(), "POSITION", 3);
        if (!positions) {
            context_.report().ignore("primitives", "they have no positions");
            return std::nullopt;
        }
        Primitive p;
        p.vertexCount = positions->count;
        p.positions = std::move(*positions);
        vertexCount_ = p.vertexCount;
        const Element wanted = attributes->strictly();
        p.normals = valuesOr(wanted, "NORMAL", 3);
        p.tangents = valuesOr(wanted, "TANGENT", 4);
        forgiveAttribute([&] { p.colors = colors(wanted); });
        for (size_t i = 0; i < 2; ++i)
            p.uvs[i] = valuesOr(wanted, fmt::format("TEXCOORD_{}", uvSets[i]), 2);
        forgiveAttribute([&] { readSkin(wanted, p); });
        readTargets(p, uvSets);
        p.triangles = triangles();
        if (p.triangles.empty()) return std::nullopt;
        return p;
    }

  private:
    /// An attribute by its name; nothing if it is not there. Of a packed mesh all but morph
    /// targets' may be packed.
    std::optional<Values> values(const Element& attributes, const std::string& name, size_t width,
                                 bool mayBePacked = true) {
        const std::optional<size_t> accessor =
            attributes.index(name, context_.document.size("accessors"));
        if (!accessor) return std::nullopt;
        const auto packed =
            mayBePacked ? unpacked_.attributes.find(name) : unpacked_.attributes.end();
        Values found = packed != unpacked_.attributes.end()
                           ? packed->second
                           : readValues(context_.document, *accessor, width);
        if (width != 0 && found.width != width)
            attributes.fail(name, fmt::format("has {} numbers, expected {}", found.width, width));
        if (vertexCount_ && found.count != *vertexCount_)
            attributes.fail(name, fmt::format("has {} elements, but there are {} positions",
                                              found.count, *vertexCount_));
        return found;
    }

    /// One attribute never costs the mesh.
    template <class Read>
    void forgiveAttribute(Read&& read) {
        try {
            read();
        } catch (const SceneError& error) {
            context_.report().replace(error, build::Shortfall::Attribute);
        }
    }

    std::optional<Values> valuesOr(const Element& attributes, const std::string& name, size_t width,
                                   bool mayBePacked = true) {
        std::optional<Values> found;
        forgiveAttribute([&] { found = values(attributes, name, width, mayBePacked); });
        return found;
    }

    /// Colours of whole numbers are fractions, whether their accessor says so or not: many programs
    /// forget it.
    void takeWholeNumbers(const Element& attributes, Values& colors) {
        const size_t accessor =
            attributes.index("COLOR_0", context_.document.size("accessors")).value();
        const AccessorType type = typeOf(context_.document.at("accessors", accessor));
        if (type.normalized || normalizedFactor(type) == 1) return;
        const bool isAboveOne =
            std::ranges::any_of(colors.numbers, [](double value) { return value > 1; });
        if (!isAboveOne) return;
        context_.report().forgive(attributes.place(),
                                  "COLOR_0 has whole numbers that are not 'normalized'",
                                  "they count as fractions of the largest one of their type");
        for (double& value : colors.numbers)
            value *= normalizedFactor(type);
    }

    static double normalizedFactor(AccessorType type) {
        constexpr int isFloat = 5126;
        type.normalized = type.component != isFloat;
        return normalization(type);
    }

    std::optional<Values> colors(const Element& attributes) {
        std::optional<Values> found = values(attributes, "COLOR_0", 0);
        if (found && found->width != 3 && found->width != 4)
            attributes.fail("COLOR_0",
                            fmt::format("has {} numbers, expected 3 or 4", found->width));
        if (found) takeWholeNumbers(attributes, *found);
        if (attributes.has("COLOR_1"))
            context_.report().ignore("vertex colours", "only the first set has a meaning");
        return found;
    }

    void readSkin(const Element& attributes, Primitive& p) {
        for (int set = 0; attributes.has(fmt::format("JOINTS_{}", set)); ++set) {
            std::optional<Values> weights = values(attributes, fmt::format("WEIGHTS_{}", set), 4);
            if (!weights) attributes.fail(fmt::format("has JOINTS_{} and no WEIGHTS_{}", set, set));
            p.joints.push_back(values(attributes, fmt::format("JOINTS_{}", set), 4).value());
            p.weights.push_back(std::move(*weights));
        }
    }

    void readTargets(Primitive& p, const std::array<uint32_t, 2>& uvSets) {
        for (const Element& stated : at_.items("targets")) {
            Primitive::Target& target = p.targets.emplace_back();
            const auto read = [&](const std::string& name, size_t width) {
                return valuesOr(stated.strictly(), name, width, false);
            };
            target.positions = read("POSITION", 3);
            target.normals = read("NORMAL", 3);
            target.tangents = read("TANGENT", 3);
            if (p.colors) target.colors = read("COLOR_0", 0);
            for (size_t i = 0; i < 2; ++i)
                if (p.uvs[i]) target.uvs[i] = read(fmt::format("TEXCOORD_{}", uvSets[i]), 2);
        }
    }

    std::vector<uint32_t> indices() {
        if (!unpacked_.indices.empty()) return std::move(unpacked_.indices);
        const std::optional<size_t> accessor =
            at_.strictly().index("indices", context_.document.size("accessors"));
        if (accessor) return readIndices(context_.document, *accessor);
        std::vector<uint32_t> all(*vertexCount_);
        std::iota(all.begin(), all.end(), 0u);
        return all;
    }

    std::vector<std::array<uint32_t, 3>> triangles() {
        const uint64_t mode = at_.strictly().count("mode", kTriangles);
        if (mode > kFan) at_.fail("mode", fmt::format("is {}, expected 0 to 6", mode));
        if (mode < kTriangles) {
            context_.report().ignore("primitives of points or lines", "only triangles are shown");
            return {};
        }
        const std::vector<uint32_t> v = indices();
        std::vector<std::array<uint32_t, 3>> found;
        if (mode == kTriangles) {
            if (v.size() % 3 != 0)
                context_.report().forgive(
                    at_.place(), fmt::format("{} corners are no whole triangles", v.size()),
                    "what is left over is left out");
            for (size_t i = 0; i + 2 < v.size(); i += 3)
                found.push_back({v[i], v[i + 1], v[i + 2]});
        } else {
            for (size_t i = 0; i + 2 < v.size(); ++i)
                found.push_back(mode == kFan
                                    ? std::array{v[i + 1], v[i + 2], v[0]}
                                    : std::array{v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
        }
        leaveOutWrongOnes(found);
        return found;
    }

    /// A triangle with a corner that is not there costs no other one.
    void leaveOutWrongOnes(std::vector<std::array<uint32_t, 3>>& triangles) {
        std::erase_if(triangles, [&](const std::array<uint32_t, 3>& t) {
            const uint32_t last = std::max({t[0], t[1], t[2]});
            if (last < *vertexCount_) return false;
            at_.forgive(
                build::Shortfall::Geometry, "indices",
                fmt::format("has the index {}, but there are {} vertices", last, *vertexCount_));
            return true;
        });
    }

    Context& context_;
    const Element& at_;
    UnpackedPrimitive unpacked_;
    std::optional<size_t> vertexCount_;
};

} // namespace

std::optional<Primitive> readPrimitive(Context& context, const Element& element,
                                       const std::array<uint32_t, 2>& uvSets) {
    return PrimitiveReader(context, element).read(uvSets);
}

} // namespace stromboli::gltf
