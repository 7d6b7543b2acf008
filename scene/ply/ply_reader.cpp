#include "scene/ply/ply_reader.hpp"

#include "host/core/error.hpp"
#include "scene/build/companion.hpp"
#include "scene/build/gunzip.hpp"
#include "scene/build/polygon.hpp"
#include "scene/build/read_file.hpp"
#include "scene/images/load_texture.hpp"
#include "scene/images/texture_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace stromboli::ply {
namespace {

/// What a triangle takes here, in the mesh and in the scene: corners of polygons, which take a byte
/// of the file at least, make one each.
constexpr uint64_t kBytesOfTriangle =
    sizeof(uint32_t) + sizeof(build::MeshTriangle) + sizeof(Triangle) + 3 * sizeof(uint32_t);

/// Within a strip, where the next one begins.
constexpr uint32_t kRestart = 0xFFFFFFFFu;
/// The number of a picture for faces that are to have none.
constexpr uint32_t kNoPicture = 0xFFFFFFFFu;
/// A corner that is not there.
constexpr uint32_t kNoVertex = kRestart - 1;

constexpr std::string_view kCornerLists[] = {"vertex_indices", "vertex_index", "indices"};

bool isCornerList(const Property& property) {
    return property.countType &&
           std::ranges::find(kCornerLists, inSmallLetters(property.name)) != std::end(kCornerLists);
}

} // namespace

PlyReader::PlyReader(const std::filesystem::path& file, build::SceneBuilder& builder,
                     const PlyAttribute& colors)
    : file_(file), name_(file.string()), builder_(builder), colors_(colors),
      bytes_(build::gunzipped(build::readFile(file), name_)),
      header_(readHeader(name_, bytes_, builder.report())),
      body_(name_, bytes_, header_, builder.report()) {}

void PlyReader::read() {
    const Element* vertices = header_.find("vertex");
    if (!vertices) build::FilePlace{name_, 0, ""}.fail("the header has no element 'vertex'");
    if (vertices->count >= kNoVertex)
        build::FilePlace{name_, 0, "vertex"}.fail(
            fmt::format("there are {}, more than there is room for", vertices->count));
    vertexCount_ = vertices->count;
    readAll();
    requireFaces();
    const uint64_t ofColors = faceColors_.empty() ? 0 : 2 * sizeof(VertexAttributes); // there too
    build::requireMemory(name_, corners_.size() * (kBytesOfTriangle + ofColors));
    build::Mesh mesh = makeMesh();
    const std::vector<uint32_t> materials = materialsOfParts();
    const std::string instance = file_.stem().string();
    const build::ShapeId shape = builder_.addMesh(instance, std::move(mesh));
    builder_.place({name_, 0, "face"}, shape, glm::dmat4(1), materials, instance);
}

/// What there is of the faces of a file that ends too early is shown.
void PlyReader::readAll() {
    try {
        for (const Element& element : header_.elements)
            readElements(element);
    } catch (const Truncated& error) {
        if (vertices_.positions.size() < vertexCount_) throw;
        size_t whole = 0; // corners of the faces before
        for (const uint32_t size : sizes_)
            whole += size;
        corners_.resize(std::min(whole, corners_.size()));
        builder_.report().replace(error, build::Shortfall::Geometry);
    }
}

/// Clouds of points, and of splats, are PLY files too.
void PlyReader::requireFaces() const {
    if (!sizes_.empty() || builder_.report().firstError()) return;
    build::FilePlace{name_, 0, ""}.fail(fmt::format(
        "has {} vertices and no faces: expected an element 'face' or 'tristrips' (points "
        "are not shown)",
        vertexCount_));
}

void PlyReader::readElements(const Element& stated) {
    Element element = stated;
    // Faces of which the file has too few are read as far as they go.
    if (element.name != "vertex" && vertices_.positions.size() == vertexCount_ &&
        element.count > body_.mostOf(element)) {
        try {
            body_.begin(element);
        } catch (const Truncated& error) {
            builder_.report().replace(error, build::Shortfall::Geometry);
        }
        element.count = body_.mostOf(element);
    }
    body_.begin(element);
    if (element.name == "vertex")
        vertices_ = readVertices(element, body_, builder_,
                                 colors_.isOfFaces ? "color" : colors_.name, colors_);
    else if (element.name == "face" || element.name == "tristrips")
        readFaces(element);
    else
        skip(element);
}

/// Where vertices have colours, those of faces would be other ones.
bool PlyReader::readsFaceColors(const FaceColors& colors) const {
    if (!colors.areThere()) return false;
    return colors_.isOfFaces ||
           (colors_.name == "color" && !vertices_.hasColors && builder_.conventions().textures);
}

/// Two numbers for each corner that was read last.
void PlyReader::readCornerUvs(const Property& property, size_t corners) {
    const uint64_t length = body_.listLength(property);
    const bool fits = length == 2 * corners && corners > 0;
    if (!fits && length > 0)
        builder_.report().replace(
            body_.place(), build::Shortfall::Attribute,
            fmt::format("there are {} texture coordinates for {} corners", length, corners));
    std::array<double, 2> uv{};
    for (uint64_t i = 0; i < length; ++i) {
        const double value = body_.number(property.type);
        uv[i % 2] = std::isfinite(float(value)) ? value : 0;
        if (fits && i % 2 == 1) cornerUvs_.emplace_back(uv[0], uv[1]);
    }
}

void PlyReader::readFaces(const Element& element) {
    bool hasCorners = false;
    FaceColors colors(element, colors_.name);
    const bool readsColors = readsFaceColors(colors);
    const bool areStrips = element.name == "tristrips";
    const auto isUvList = [&](const Property& property) {
        return property.countType && property.name == "texcoord" && !areStrips;
    };
    const auto isPictureNumber = [&](const Property& property) {
        return !property.countType && property.name == "texnumber" && !areStrips;
    };
    for (const Property& property : element.properties) {
        if (isCornerList(property) && !hasCorners)
            hasCorners = true;
        else if ((!readsColors || !colors.isColor(property)) && !isUvList(property) &&
                 !isPictureNumber(property))
            builder_.report().ignore(
                "properties of faces",
                "only their corners, texture coordinates and colours are read");
    }
    if (!hasCorners && element.count > 0) body_.fail("has no list 'vertex_indices'");
    std::vector<uint32_t> strip;
    for (uint64_t i = 0; i < element.count; ++i) {
        body_.beginElement(i);
        bool isRead = false;
        for (const Property& property : element.properties) {
            if (readsColors && colors.isColor(property)) {
                colors.set(property, body_.number(property.type));
                continue;
            }
            if (isPictureNumber(property) && isRead) {
                const double number = body_.number(property.type);
                const bool isThere = number >= 0 && number < double(header_.pictures.size());
                pictureNumbers_.resize(sizes_.size());
                pictureNumbers_.back() = isThere ? uint32_t(number) : kNoPicture;
                continue;
            }
            if (isUvList(property) && isRead) {
                cornerUvs_.resize(corners_.size() - sizes_.back());
                readCornerUvs(property, sizes_.back());
                continue;
            }
            if (!isCornerList(property) || std::exchange(isRead, true)) {
                body_.skip(property);
                continue;
            }
            const uint64_t length = body_.listLength(property);
            strip.clear();
            std::vector<uint32_t>& corners = areStrips ? strip : corners_;
            for (uint64_t k = 0; k < length; ++k) {
                const double index = body_.number(property.type);
                corners.push_back(areStrips && index == -1 ? kRestart : vertex(index));
            }
            if (areStrips)
                addStrip(strip);
            else
                sizes_.push_back(uint32_t(length));
        }
        if (readsColors) faceColors_.resize(sizes_.size(), glm::vec4(colors.color(), 1));
        body_.endElement();
    }
}

/// Each corner from the third on makes a triangle with the two before it; every other one runs the
/// other way round.
void PlyReader::addStrip(const std::vector<uint32_t>& strip) {
    size_t first = 0;
    for (size_t i = 0; i < strip.size(); ++i) {
        if (strip[i] == kRestart) first = i + 1;
        if (i < first + 2) continue;
        if (std::max({strip[i - 2], strip[i - 1], strip[i]}) >= kNoVertex) continue;
        const bool isOdd = (i - first) % 2 == 1;
        corners_.insert(corners_.end(), {strip[i - 2 + isOdd], strip[i - 1 - isOdd], strip[i]});
        sizes_.push_back(3);
    }
}

/// A corner that is not there costs its face.
uint32_t PlyReader::vertex(double index) {
    if (index >= 0 && index < double(vertexCount_) && index == std::floor(index))
        return uint32_t(index);
    try {
        body_.fail(fmt::format("names vertex {}, but there are {}", index, vertexCount_));
    } catch (const SceneError& error) {
        builder_.report().replace(error, build::Shortfall::Geometry);
    }
    return kNoVertex;
}

void PlyReader::skip(const Element& element) {
    builder_.report().ignore(fmt::format("element '{}'", element.name.substr(0, 60)),
                             "only vertices and faces are shown", element.count);
    if (element.properties.empty()) return; // whatever their number, they take no bytes
    for (uint64_t i = 0; i < element.count; ++i) {
        body_.beginElement(i);
        for (const Property& property : element.properties)
            body_.skip(property);
        body_.endElement();
    }
}

/// Faces with colours or texture coordinates of their own share no corner's attributes.
build::Corner PlyReader::cornerOf(size_t face, size_t corner, bool hasAttributes,
                                  build::Mesh& mesh) const {
    const uint32_t v = corners_[corner];
    const uint32_t normal = mesh.normals.empty() ? kNoNormals : v;
    if (faceColors_.empty() && cornerUvs_.empty())
        return {v, normal, hasAttributes ? v : kNoAttributes};
    VertexAttributes a = hasAttributes ? mesh.attributes[v] : VertexAttributes{};
    if (!faceColors_.empty()) a.color = faceColors_[face];
    // On the renderer's pictures v grows downwards.
    if (!cornerUvs_.empty()) a.uv[0] = {cornerUvs_[corner].x, 1 - cornerUvs_[corner].y};
    mesh.attributes.push_back(a);
    return {v, normal, uint32_t(mesh.attributes.size() - 1)};
}

/// The part of a face's picture, which is made where there is none yet.
size_t PlyReader::partOf(size_t face, build::Mesh& mesh) {
    const bool isTold = header_.pictures.size() > 1 && face < pictureNumbers_.size();
    const uint32_t picture = isTold ? pictureNumbers_[face] : 0;
    const auto found = std::ranges::find(partPictures_, picture);
    const auto part = size_t(found - partPictures_.begin());
    if (found != partPictures_.end()) return part;
    partPictures_.push_back(picture);
    mesh.parts.emplace_back();
    return part;
}

build::Mesh PlyReader::makeMesh() {
    build::Mesh mesh;
    mesh.positions = std::move(vertices_.positions);
    mesh.normals = std::move(vertices_.normals);
    if (colors_.isOfFaces)
        for (VertexAttributes& a : vertices_.attributes)
            a.color = glm::vec4(1);
    mesh.attributes = std::move(vertices_.attributes);
    build::PolygonCutter polygons(mesh, builder_.report());
    std::vector<build::Corner> face;
    size_t first = 0;
    const bool hasAttributes = !mesh.attributes.empty();
    faceColors_.resize(faceColors_.empty() ? 0 : sizes_.size(), glm::vec4(1));
    cornerUvs_.resize(cornerUvs_.empty() ? 0 : corners_.size(), glm::vec2(0));
    for (size_t i = 0; i < sizes_.size(); ++i) {
        face.clear();
        const auto* corners = corners_.data() + first;
        const bool isWhole =
            std::find(corners, corners + sizes_[i], kNoVertex) == corners + sizes_[i];
        for (size_t k = 0; isWhole && k < sizes_[i]; ++k)
            face.push_back(cornerOf(i, first + k, hasAttributes, mesh));
        if (isWhole) polygons.add(face, mesh.parts[partOf(i, mesh)]);
        first += sizes_[i];
    }
    return mesh;
}

/// The picture that a comment of the header names, if the surface has coordinates for it.
std::optional<uint32_t> PlyReader::picture(uint32_t number) {
    if (number >= header_.pictures.size() || !builder_.conventions().textures) return std::nullopt;
    const build::FilePlace place{name_, 0, "TextureFile"};
    const std::string& written = header_.pictures[number];
    if (!vertices_.hasUv && cornerUvs_.empty()) {
        builder_.report().ignore("TextureFile", "there are no texture coordinates");
        return std::nullopt;
    }
    if (header_.pictures.size() > 1 && pictureNumbers_.empty())
        builder_.report().forgive(place, fmt::format("there are {}", header_.pictures.size()),
                                  "the first picture is on all faces");
    const build::Companion file = build::pictureCompanion(file_.parent_path(), written);
    if (!file.path) {
        builder_.report().replace(place, build::Shortfall::Picture,
                                  fmt::format("'{}' is not in the file's folder", written));
        return std::nullopt;
    }
    std::string bytes;
    const auto bytesOf = [&]() -> std::string_view {
        bytes = build::readFile(*file.path);
        return bytes;
    };
    std::optional<TextureImage> image =
        images::loadTexture(bytesOf, file.path->string(), true, place, builder_.report());
    if (!image) return std::nullopt;
    if (!file.problem.empty()) builder_.report().forgive(place, file.problem, file.reading);
    const uint32_t largest = builder_.conventions().selection.largestTexture;
    if (largest > 0) images::shrinkToFit(*image, largest, true);
    Texture texture;
    texture.image = builder_.addImage(std::move(*image));
    texture.srgb = true;
    return builder_.addTexture(texture);
}

/// The format has no materials. Where vertices have colours, those are what the surface reflects.
uint32_t PlyReader::material(uint32_t pictureNumber) {
    Material material = build::greyMaterial();
    if (vertices_.hasColors || !faceColors_.empty()) material.albedo = glm::vec3(1);
    if (vertices_.hasAlpha && !colors_.isOfFaces) material.alphaMode = AlphaMode::Blend;
    if (const std::optional<uint32_t> texture = picture(pictureNumber)) {
        TextureUse use;
        use.texture = *texture;
        material.albedo = glm::vec3(1);
        material.textures.push_back(use);
    }
    return builder_.addMaterial(material);
}

std::vector<uint32_t> PlyReader::materialsOfParts() {
    std::vector<uint32_t> materials;
    for (const uint32_t picture : partPictures_)
        materials.push_back(material(picture));
    return materials;
}

} // namespace stromboli::ply
