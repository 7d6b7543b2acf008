#include "scene/obj/obj_reader.hpp"

#include "host/core/error.hpp"
#include "scene/build/gunzip.hpp"
#include "scene/build/number_word.hpp"
#include "scene/build/read_file.hpp"
#include "scene/model/srgb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

namespace stromboli::obj {
namespace {

/// 32-bit numbers, of which the highest ones have a meaning of their own.
constexpr size_t kMostElements = 0xFFFFFFF0u;

/// What a triangle takes here, in its group's mesh and in the scene: corners of polygons, which
/// take two bytes of the file each, make one each.
constexpr uint64_t kBytesOfTriangle = 2 * sizeof(build::MeshTriangle) + sizeof(Triangle);

float linearFromSrgb(double value) {
    return float(srgbToLinear(std::clamp(value, 0.0, 1.0)));
}

} // namespace

ObjReader::ObjReader(const std::filesystem::path& file, build::SceneBuilder& builder)
    : file_(file), builder_(builder),
      statements_(file.string(), build::gunzipped(build::readFile(file), file.string())),
      materials_(file, builder), polygons_(lists_.mesh, builder.report()) {}

void ObjReader::read() {
    while (statements_.next())
        readStatement(statements_.keyword());
    if (lists_.mesh.positions.empty())
        build::FilePlace{file_.string(), 0, ""}.fail(
            "has no vertex (a line 'v X Y Z'): it is empty, or no OBJ file");
    requireFaces();
    takePaint();
    finishColors();
    groups_.place(file_.string(), lists_, materials_, builder_);
}

/// Points, lines and curved surfaces leave nothing to show.
void ObjReader::requireFaces() const {
    if (cornersRead_ > 0 || builder_.report().firstError()) return;
    build::FilePlace{file_.string(), 0, ""}.fail(
        fmt::format("has {} vertices and no face: expected a line 'f V1 V2 V3' (points, lines and "
                    "curves are not shown)",
                    lists_.mesh.positions.size()));
}

void ObjReader::readStatement(std::string_view keyword) {
    build::Report& report = builder_.report();
    if (keyword == "v") return readPosition();
    if (keyword == "vn") return readNormal();
    if (keyword == "vt") return readTexcoord();
    if (keyword == "f" || keyword == "fo") return readFace();
    if (keyword == "usemtl") return useMaterial();
    if (keyword == "mtllib") return materials_.addLibraries(statements_);
    if (keyword == "o" || keyword == "g") {
        part_ = nullptr;
        if (keyword == "o") object_ = statements_.rest();
        group_ = keyword == "g" ? std::string(statements_.rest()) : "";
        return groups_.enter(object_, group_, statements_.line());
    }
    if (keyword == "s") return smoothing_.enter(Words(statements_.values()).next());
    if (keyword == "l" || keyword == "p")
        return report.ignore("lines and points ('l', 'p')", "only surfaces are shown");
    if (keyword == kPaintKeyword) return readPaint();
    if (isObjKeyword(keyword))
        return report.ignore(fmt::format("'{}'", keyword),
                             "of polygons, their groups and materials alone are read");
    const std::string small = inSmallLetters(keyword);
    if (small != keyword && isObjKeyword(small)) {
        report.forgive(statements_.place(), "has other capitals than the format has",
                       "it is read in small letters");
        return readStatement(small);
    }
    report.forgive(statements_.place(), "is no statement of the format", "the line is skipped");
}

/// A number, or NaN for a word that says so. Programs of some countries write 1,5 for 1.5.
double ObjReader::number(Words& words) {
    Words ahead = words;
    const std::string_view stated = ahead.next();
    if (const std::optional<double> value = build::realIn(stated)) { // nearly always
        words = ahead;
        return *value;
    }
    if (const std::optional<double> value = build::realWithCommaIn(stated)) {
        builder_.report().forgive(statements_.place(), "a number has a decimal comma",
                                  "it is read as a decimal point");
        words = ahead;
        return *value;
    }
    return statements_.numberOrNan(words);
}

/// Three numbers. Where one is none, all are NaN, and `kind` says what becomes of them.
glm::dvec3 ObjReader::readVector(Words& words, build::Shortfall kind) {
    glm::dvec3 v;
    try {
        for (int i = 0; i < 3; ++i)
            v[i] = number(words);
        if (std::isnan(v.x + v.y + v.z)) statements_.fail("has a coordinate that is no number");
        return v;
    } catch (const SceneError& error) {
        builder_.report().replace(error, kind);
        words = Words("");
        return glm::dvec3(std::numeric_limits<double>::quiet_NaN());
    }
}

/// v x y z [w], or v x y z r g b [a]: not in the specification, but programs for scans write it.
void ObjReader::readPosition() {
    Words words(statements_.values());
    const glm::dvec3 p = readVector(words, build::Shortfall::Vertex);
    std::array<double, 4> more{};
    size_t count = 0;
    try {
        while (!words.atEnd() && count < more.size())
            more[count++] = number(words);
    } catch (const SceneError& error) {
        builder_.report().replace(error, build::Shortfall::Attribute);
        count = 0;
    }
    if (count == 1 && more[0] != 1)
        builder_.report().ignore("weights of vertices (the fourth number of 'v')",
                                 "they belong to curved surfaces");
    if (lists_.mesh.positions.size() >= kMostElements) statements_.fail("is one vertex too many");
    lists_.mesh.positions.push_back(p);
    const bool hasColor = count >= 3 && builder_.conventions().textures;
    if (!hasColor && lists_.colors.empty()) return;
    if (lists_.colors.empty())
        builder_.report().assume(
            "colours of vertices are sRGB; they multiply the material's colour");
    // Vertices before the first one with a colour, and those without, are white: nothing changes.
    lists_.colors.resize(lists_.mesh.positions.size(), glm::vec3(1));
    if (hasColor) lists_.colors.back() = glm::vec3(more[0], more[1], more[2]);
    if (!firstColor_) firstColor_ = statements_.place();
}

/// ZBrush writes what is painted on vertices into comments: eight hexadecimal digits for each
/// vertex in turn, two of a mask and two each of red, green and blue.
void ObjReader::readPaint() {
    constexpr size_t kDigits = 8;
    const std::string_view text = statements_.rest();
    for (size_t at = 0; at + kDigits <= text.size(); at += kDigits) {
        uint32_t bits = 0;
        const char* const first = text.data() + at;
        const auto [end, error] = std::from_chars(first, first + kDigits, bits, 16);
        if (error != std::errc() || end != first + kDigits)
            return builder_.report().replace(statements_.place(), build::Shortfall::Attribute,
                                             "has other characters than hexadecimal digits");
        paint_.push_back(glm::vec3(bits >> 16 & 0xFF, bits >> 8 & 0xFF, bits & 0xFF) / 255.f);
    }
}

/// Colours that the vertices state themselves come first.
void ObjReader::takePaint() {
    if (paint_.empty() || !lists_.colors.empty() || !builder_.conventions().textures) return;
    builder_.report().assume("the paint of ZBrush (#MRGB) is sRGB; it multiplies the material's "
                             "colour");
    paint_.resize(lists_.mesh.positions.size(), glm::vec3(1));
    lists_.colors = std::move(paint_);
    firstColor_ = statements_.place();
}

/// Programs for scans write fractions or bytes: bytes where all are whole numbers and some are
/// above 1.
void ObjReader::finishColors() {
    bool areWhole = true;
    float most = 0, least = 0;
    for (const glm::vec3& color : lists_.colors)
        for (int i = 0; i < 3; ++i) {
            areWhole = areWhole && color[i] == std::floor(color[i]);
            most = std::max(most, color[i]);
            least = std::min(least, color[i]);
        }
    const bool areBytes = areWhole && most > 1;
    const double scale = areBytes ? 255 : 1;
    if (areBytes)
        builder_.report().replace(*firstColor_, build::Shortfall::ByteColor,
                                  fmt::format("colours of vertices go up to {}", most));
    else if (most > 1 || least < 0)
        builder_.report().replace(*firstColor_, build::Shortfall::ReflectedFraction,
                                  fmt::format("colours of vertices go from {} to {}", least, most));
    for (glm::vec3& color : lists_.colors) {
        // Vertices without a colour are white.
        const bool isStated = !areBytes || color != glm::vec3(1);
        for (int i = 0; i < 3; ++i)
            color[i] = linearFromSrgb(double(color[i]) / (isStated ? scale : 1));
    }
}

void ObjReader::readNormal() {
    Words words(statements_.values());
    const glm::dvec3 n = readVector(words, build::Shortfall::Normal);
    if (lists_.mesh.normals.size() >= kMostElements) statements_.fail("is one normal too many");
    lists_.mesh.normals.push_back(n);
}

/// vt u [v [w]]
void ObjReader::readTexcoord() {
    glm::vec2 uv(0);
    try {
        Words words(statements_.values());
        const double u = number(words), v = words.atEnd() ? 0 : number(words);
        uv = glm::vec2(u, v);
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
            statements_.fail("is no number in the range of single precision");
    } catch (const SceneError& error) {
        builder_.report().replace(error, build::Shortfall::Texel);
        uv = glm::vec2(0);
    }
    if (lists_.texcoords.size() >= kMostElements)
        statements_.fail("is one texture coordinate too many");
    lists_.texcoords.push_back(uv);
}

void ObjReader::readFace() {
    corners_.clear();
    try {
        for (Words words(statements_.values()); !words.atEnd();)
            corners_.push_back(readCorner(words.next()));
    } catch (const SceneError& error) { // which costs this face
        return builder_.report().replace(error, build::Shortfall::Geometry);
    }
    makeUniform(corners_);
    if (smoothing_.isOn() && corners_.size() > 2 && corners_.front().normal == kNoNormals &&
        lists_.mesh.normals.size() + lists_.smoothNormals.size() < kFirstSmooth - 1)
        smoothing_.apply(corners_, lists_.mesh.positions, kFirstSmooth, lists_.smoothNormals);
    requireMemory();
    if (!part_) part_ = &groups_.part(materialName_);
    polygons_.add(corners_, *part_);
}

/// v, v/vt, v//vn or v/vt/vn.
build::Corner ObjReader::readCorner(std::string_view word) {
    std::array<std::string_view, 3> fields;
    size_t count = 0;
    for (std::string_view rest = word;; ++count) {
        const size_t slash = rest.find('/');
        if (count == 3)
            statements_.fail(fmt::format("'{}' has more than three numbers", shortened(word)));
        fields[count] = rest.substr(0, slash);
        if (slash == std::string_view::npos) break;
        rest.remove_prefix(slash + 1);
    }
    build::Corner corner;
    corner.position = index(word, fields[0], lists_.mesh.positions.size(), "vertex");
    corner.attributes = fields[1].empty()
                            ? kNoAttributes
                            : index(word, fields[1], lists_.texcoords.size(), "texture coordinate");
    corner.normal = fields[2].empty()
                        ? kNoNormals
                        : index(word, fields[2], lists_.mesh.normals.size(), "normal");
    return corner;
}

/// From 1; negative numbers count back from the last element so far.
uint32_t ObjReader::index(std::string_view corner, std::string_view word, size_t count,
                          const char* what) {
    const std::optional<int64_t> number = build::integerIn(word);
    if (!number)
        statements_.fail(fmt::format("'{}' is no corner; expected whole numbers as in v, v/vt, "
                                     "v//vn or v/vt/vn",
                                     shortened(corner)));
    const auto most = int64_t(count);
    if (*number == 0 || *number > most || *number < -most)
        statements_.fail(fmt::format("'{}' names {} {}, but the lines before have {}",
                                     shortened(corner), what, *number, count));
    return uint32_t(*number > 0 ? *number - 1 : most + *number);
}

/// A face has normals at all of its corners or at none, and texture coordinates likewise.
void ObjReader::makeUniform(std::vector<build::Corner>& corners) {
    size_t normals = 0, texcoords = 0;
    for (const build::Corner& corner : corners) {
        normals += corner.normal != kNoNormals;
        texcoords += corner.attributes != kNoAttributes;
    }
    if (normals > 0 && normals < corners.size()) {
        builder_.report().forgive(statements_.place(), "only some corners have normals",
                                  "such a face is shaded flat");
        for (build::Corner& corner : corners)
            corner.normal = kNoNormals;
    }
    if (texcoords > 0 && texcoords < corners.size()) {
        builder_.report().forgive(statements_.place(), "only some corners have texture coordinates",
                                  "such a face has none");
        for (build::Corner& corner : corners)
            corner.attributes = kNoAttributes;
    }
}

void ObjReader::useMaterial() {
    materialName_ = materials_.nameNumber(statements_);
    part_ = nullptr;
}

/// Asked once in many corners.
void ObjReader::requireMemory() {
    constexpr uint64_t interval = uint64_t(1) << 20;
    const uint64_t before = cornersRead_;
    cornersRead_ += corners_.size();
    if (cornersRead_ / interval != before / interval)
        build::requireMemory(file_.string(), cornersRead_ * kBytesOfTriangle);
}

} // namespace stromboli::obj
