#include "scene/collada/primitives.hpp"

#include "host/core/error.hpp"
#include "scene/collada/sources.hpp"

#include <fmt/format.h>

#include <string_view>

namespace stromboli::collada {

static bool isSurface(const Element& element) {
    for (const char* kind : {"triangles", "polylist", "polygons", "tristrips", "trifans"})
        if (named(element, kind)) return true;
    return false;
}

void MeshReader::readTriangles(const Element& primitive, const Inputs& inputs, MeshPart& part) {
    size_t count = 0;
    for (const Element& p : children(primitive)) {
        if (!named(p, "p")) continue;
        const std::vector<Corner> corners = readCorners(p, inputs);
        if (corners.size() % 3 != 0)
            context_.document.fail(
                p, fmt::format("has {} corners, not a multiple of 3", corners.size()));
        for (size_t i = 0; i < corners.size(); i += 3)
            part.push_back({corners[i], corners[i + 1], corners[i + 2]});
        count += corners.size() / 3;
    }
    checkCount(primitive, count);
}

void MeshReader::readPolylist(const Element& primitive, const Inputs& inputs, MeshPart& part) {
    const Element* vcount = primitive.FirstChildElement("vcount");
    const Element* p = primitive.FirstChildElement("p");
    if (!vcount && !p) return checkCount(primitive, 0);
    const Document& document = context_.document;
    const std::vector<uint32_t> sizes =
        readIndices(document, document.require(primitive, "vcount"));
    const std::vector<Corner> corners = readCorners(document.require(primitive, "p"), inputs);
    checkCount(primitive, sizes.size());
    uint64_t sum = 0;
    for (uint32_t size : sizes)
        sum += size;
    if (sum != corners.size())
        document.fail(*vcount, fmt::format("its numbers add up to {} corners, but <p> has {}", sum,
                                           corners.size()));
    part.reserve(corners.size());
    const Corner* first = corners.data();
    for (uint32_t size : sizes) {
        polygons_.add({first, size}, part);
        first += size;
    }
}

void MeshReader::readPolygons(const Element& primitive, const Inputs& inputs, MeshPart& part) {
    size_t count = 0;
    for (const Element& child : children(primitive)) {
        const bool withHoles = named(child, "ph");
        if (!withHoles && !named(child, "p")) continue;
        const Element& p = withHoles ? context_.document.require(child, "p") : child;
        const std::vector<Corner> corners = readCorners(p, inputs);
        polygons_.add(corners, part);
        ++count;
        if (!withHoles) continue;
        for (const Element& hole : children(child))
            if (named(hole, "h")) context_.report.ignore("<h>", "holes in polygons are filled");
    }
    checkCount(primitive, count);
}

void MeshReader::readStrips(const Element& primitive, const Inputs& inputs, MeshPart& part) {
    size_t count = 0;
    for (const Element& p : children(primitive)) {
        if (!named(p, "p")) continue;
        const std::vector<Corner> c = readCorners(p, inputs);
        for (size_t i = 2; i < c.size(); ++i) {
            const bool odd = i % 2 != 0; // every other triangle runs the other way round
            part.push_back({c[odd ? i - 1 : i - 2], c[odd ? i - 2 : i - 1], c[i]});
        }
        ++count;
    }
    checkCount(primitive, count);
}

void MeshReader::readFans(const Element& primitive, const Inputs& inputs, MeshPart& part) {
    size_t count = 0;
    for (const Element& p : children(primitive)) {
        if (!named(p, "p")) continue;
        const std::vector<Corner> c = readCorners(p, inputs);
        for (size_t i = 2; i < c.size(); ++i)
            part.push_back({c[0], c[i - 1], c[i]});
        ++count;
    }
    checkCount(primitive, count);
}

void MeshReader::checkCount(const Element& primitive, size_t found) const {
    if (!primitive.Attribute("count")) return;
    const uint32_t count = readCount(context_.document, primitive, "count");
    if (count != found)
        context_.document.forgive(
            primitive, fmt::format("count=\"{}\", but its contents make {}", count, found),
            "what is there is shown");
}

void MeshReader::readPrimitive(const Element& primitive, const TexcoordInputs& texcoords) {
    const std::string_view kind = primitive.Name();
    MeshPart part;
    try {
        const Inputs inputs = readInputs(primitive, texcoords);
        if (kind == "triangles") readTriangles(primitive, inputs, part);
        if (kind == "polylist") readPolylist(primitive, inputs, part);
        if (kind == "polygons") readPolygons(primitive, inputs, part);
        if (kind == "tristrips") readStrips(primitive, inputs, part);
        if (kind == "trifans") readFans(primitive, inputs, part);
    } catch (const SceneError& error) { // which costs this part of the mesh
        context_.report.replace(error, build::Shortfall::Geometry);
        part.clear();
    }
    mesh_.parts.push_back(std::move(part));
}

std::vector<Primitive> primitivesOf(const Element& meshElement) {
    const auto addTexcoords = [](const Element& parent, std::vector<const Element*>& found) {
        for (const Element& input : children(parent)) {
            const char* semantic = input.Attribute("semantic");
            if (named(input, "input") && semantic && std::string_view(semantic) == "TEXCOORD")
                found.push_back(&input);
        }
    };
    const Element* vertices = meshElement.FirstChildElement("vertices");
    std::vector<Primitive> primitives;
    for (const Element& child : children(meshElement)) {
        if (!isSurface(child)) continue;
        const char* symbol = child.Attribute("material");
        Primitive& primitive = primitives.emplace_back();
        primitive.element = &child;
        primitive.symbol = symbol ? symbol : "";
        addTexcoords(child, primitive.texcoords);
        if (vertices) addTexcoords(*vertices, primitive.texcoords);
    }
    return primitives;
}

Mesh MeshReader::read(const Element& meshElement, std::span<const TexcoordInputs> texcoords) {
    readVertices(meshElement);
    size_t part = 0;
    for (const Element& child : children(meshElement)) {
        if (isSurface(child))
            readPrimitive(child, texcoords[part++]);
        else if (!named(child, "source") && !named(child, "vertices") && !named(child, "extra"))
            context_.report.ignore(fmt::format("<{}>", child.Name()), "only surfaces are rendered");
    }
    return std::move(mesh_);
}

} // namespace stromboli::collada
