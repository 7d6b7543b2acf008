// Mitsuba's format of meshes: each is a packed stream of its own, and a table at the end of the
// file says where they begin (Jakob, "Mitsuba Documentation" 0.5, section 8.1.4).
#include "scene/mitsuba/serialized.hpp"

#include "scene/build/file_place.hpp"
#include "scene/build/read_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>

namespace stromboli::mitsuba {
namespace {

static_assert(std::endian::native == std::endian::little, "the format is little-endian");

constexpr uint16_t kMagic = 0x041C;

enum Flag : uint32_t {
    HasNormals = 0x0001,
    HasCoordinates = 0x0002,
    HasColors = 0x0008,
    HasFaceNormals = 0x0010, ///< those of corners are not used
    IsSingle = 0x1000,
    IsDouble = 0x2000,
};

template <class T>
T numberAt(std::string_view bytes, size_t place) {
    T value;
    std::memcpy(&value, bytes.data() + place, sizeof value);
    return value;
}

/// Unpacks as much as is asked for.
class Unpacker {
  public:
    Unpacker(std::string_view packed, const build::FilePlace& place)
        : place_(place), packedSize_(packed.size()) {
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
        stream_.avail_in = uInt(std::min<size_t>(packed.size(), std::numeric_limits<uInt>::max()));
        if (inflateInit(&stream_) != Z_OK) place_.fail("cannot be unpacked: no memory");
    }
    ~Unpacker() { inflateEnd(&stream_); }
    Unpacker(const Unpacker&) = delete;
    Unpacker& operator=(const Unpacker&) = delete;

    void read(void* where, size_t bytes) {
        auto* out = static_cast<Bytef*>(where);
        while (bytes > 0) {
            constexpr size_t kAtOnce = size_t(1) << 30;
            stream_.next_out = out;
            stream_.avail_out = uInt(std::min(bytes, kAtOnce));
            const size_t wanted = stream_.avail_out;
            const int status = inflate(&stream_, Z_SYNC_FLUSH);
            const size_t got = wanted - stream_.avail_out;
            out += got, bytes -= got;
            if (bytes == 0) return;
            if (status == Z_STREAM_END || status == Z_BUF_ERROR || (status == Z_OK && got == 0))
                place_.fail("ends within a mesh");
            if (status != Z_OK)
                place_.fail(fmt::format("cannot be unpacked: {}",
                                        stream_.msg ? stream_.msg : "wrong data"));
        }
    }
    template <class T>
    T number() {
        T value;
        read(&value, sizeof value);
        return value;
    }
    /// zlib packs by a factor of 1032 at most: what claims more is wrong.
    void requireRoomFor(uint64_t elements, uint64_t bytesOfOne) {
        constexpr uint64_t kMostPacking = 1032;
        if (elements > kMostPacking * packedSize_ / bytesOfOne)
            place_.fail(fmt::format("states {} elements, more than its bytes can hold", elements));
    }

  private:
    const build::FilePlace& place_;
    size_t packedSize_;
    z_stream stream_{};
};

/// Numbers of the file's precision.
class Numbers {
  public:
    Numbers(Unpacker& unpacker, bool isDouble) : unpacker_(unpacker), isDouble_(isDouble) {}

    std::vector<double> read(uint64_t count) {
        unpacker_.requireRoomFor(count, isDouble_ ? sizeof(double) : sizeof(float));
        std::vector<double> numbers(count);
        if (isDouble_) {
            unpacker_.read(numbers.data(), count * sizeof(double));
            return numbers;
        }
        std::vector<float> floats(count);
        unpacker_.read(floats.data(), count * sizeof(float));
        std::ranges::copy(floats, numbers.begin());
        return numbers;
    }

  private:
    Unpacker& unpacker_;
    bool isDouble_;
};

glm::dvec3 threeAt(std::span<const double> numbers, size_t i) {
    return {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
}

float finite(double value) {
    return std::isfinite(value) ? float(value) : 0.0f;
}

void readTriangles(Unpacker& unpacker, const build::FilePlace& place, uint64_t vertices,
                   uint64_t triangles, build::Mesh& mesh) {
    const bool isWide = vertices > 0xFFFFFFFFu;
    unpacker.requireRoomFor(triangles, isWide ? 24 : 12);
    build::requireMemory(place.file, triangles * sizeof(build::MeshTriangle));
    build::MeshPart& part = mesh.parts.emplace_back();
    part.reserve(triangles);
    for (uint64_t i = 0; i < triangles; ++i) {
        build::MeshTriangle& triangle = part.emplace_back();
        for (build::Corner& corner : triangle) {
            const uint64_t v = isWide ? unpacker.number<uint64_t>() : unpacker.number<uint32_t>();
            if (v >= vertices)
                place.fail(
                    fmt::format("triangle {} names vertex {}, but there are {}", i, v, vertices));
            const auto index = uint32_t(v);
            corner = {index, mesh.normals.empty() ? kNoNormals : index,
                      mesh.attributes.empty() ? kNoAttributes : index};
        }
    }
}

FileMesh readMesh(Unpacker& unpacker, const build::FilePlace& place, uint16_t version) {
    const auto flags = unpacker.number<uint32_t>();
    if (version == 4)
        while (unpacker.number<char>() != 0) // its name
            continue;
    const auto vertices = unpacker.number<uint64_t>(), triangles = unpacker.number<uint64_t>();
    if (vertices >= kNoNormals)
        place.fail(fmt::format("has {} vertices, more than there is room for", vertices));
    // Programs leave both flags out: Mitsuba looks at this one alone.
    const bool isDouble = (flags & IsDouble) != 0;
    const bool hasUv = (flags & HasCoordinates) != 0, hasColors = (flags & HasColors) != 0;
    unpacker.requireRoomFor(vertices, isDouble ? 24 : 12);
    build::requireMemory(
        place.file,
        vertices * (3 * sizeof(glm::dvec3) + (hasUv || hasColors ? sizeof(VertexAttributes) : 0)));
    Numbers numbers(unpacker, isDouble);
    FileMesh found;
    build::Mesh& mesh = found.mesh;
    const std::vector<double> positions = numbers.read(3 * vertices);
    for (uint64_t i = 0; i < vertices; ++i)
        mesh.positions.push_back(threeAt(positions, i));
    if ((flags & HasNormals) != 0) {
        const std::vector<double> normals = numbers.read(3 * vertices);
        for (uint64_t i = 0; i < vertices; ++i)
            mesh.normals.push_back(threeAt(normals, i));
    }
    if ((flags & HasFaceNormals) != 0) {
        mesh.normals.clear();
        mesh.isFlat = true;
    }
    if (hasUv || hasColors) mesh.attributes.resize(vertices);
    if (hasUv) {
        const std::vector<double> uv = numbers.read(2 * vertices);
        for (uint64_t i = 0; i < vertices; ++i)
            mesh.attributes[i].uv[0] = {finite(uv[2 * i]), 1 - finite(uv[2 * i + 1])};
    }
    if (hasColors) {
        const std::vector<double> colors = numbers.read(3 * vertices);
        for (uint64_t i = 0; i < vertices; ++i)
            for (const int c : {0, 1, 2})
                mesh.attributes[i].color[c] = std::max(finite(colors[3 * i + size_t(c)]), 0.0f);
    }
    found.hasCoordinates = hasUv;
    found.hasColors = hasColors;
    readTriangles(unpacker, place, vertices, triangles, mesh);
    return found;
}

} // namespace

/// Where a mesh begins, by the table at the end of the file; nothing where that does not say so.
static std::optional<size_t> beginOf(const std::string& bytes, uint16_t version, uint64_t number) {
    const uint64_t count = numberAt<uint32_t>(bytes, bytes.size() - 4);
    const uint64_t entry = version == 4 ? 8 : 4;
    if (count * entry + 8 > bytes.size() || number >= count) return std::nullopt;
    const size_t table = bytes.size() - 4 - count * entry, at = table + number * entry;
    const uint64_t begin =
        version == 4 ? numberAt<uint64_t>(bytes, at) : numberAt<uint32_t>(bytes, at);
    if (begin > table || table - begin < 4 || numberAt<uint16_t>(bytes, begin) != kMagic)
        return std::nullopt;
    return begin;
}

FileMesh serializedMesh(const std::string& bytes, const std::string& name, uint64_t number,
                        build::Report& report) {
    const build::FilePlace place{name, 0, "mesh"};
    if (bytes.size() < 8) place.fail("is too short to be a serialized mesh");
    if (const auto magic = numberAt<uint16_t>(bytes, 0); magic != kMagic)
        place.fail(fmt::format("begins with {:#06x}, expected {:#06x}", magic, kMagic));
    const auto version = numberAt<uint16_t>(bytes, 2);
    if (version != 3 && version != 4)
        place.fail(fmt::format("is of version {}, expected 3 or 4", version));
    std::optional<size_t> begin = beginOf(bytes, version, number);
    if (!begin && number == 0) {
        report.forgive(place, "has no table of its meshes at its end",
                       "the first mesh is read from the file's beginning");
        begin = 0;
    }
    if (!begin)
        place.fail(fmt::format("has no mesh with the number {}, by the table at its end", number));
    Unpacker unpacker(std::string_view(bytes).substr(*begin + 4), place);
    return readMesh(unpacker, place, version);
}

} // namespace stromboli::mitsuba
