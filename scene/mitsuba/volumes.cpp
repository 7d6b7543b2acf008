#include "scene/mitsuba/volumes.hpp"

#include "host/core/error.hpp"
#include "scene/build/read_file.hpp"
#include "scene/mitsuba/colors.hpp"

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include <bit>
#include <cmath>
#include <cstring>

namespace stromboli::mitsuba {
namespace {

/// Numbers of a file, the least byte first, one after the other.
class Numbers {
  public:
    Numbers(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    template <class T>
    T next() {
        static_assert(std::endian::native == std::endian::little);
        T value;
        if (bytes_.size() < sizeof value) throw SceneError(name_, 0, "", "ends too early");
        std::memcpy(&value, bytes_.data(), sizeof value);
        bytes_.remove_prefix(sizeof value);
        return value;
    }
    size_t left() const { return bytes_.size(); }

  private:
    std::string_view bytes_;
    const std::string& name_;
};

enum class Encoding : int32_t { Float = 1, Half = 2, Byte = 3 };

size_t bytesOf(Encoding encoding) {
    return encoding == Encoding::Float ? 4 : encoding == Encoding::Half ? 2 : 1;
}

float nextValue(Numbers& numbers, Encoding encoding) {
    if (encoding == Encoding::Float) return numbers.next<float>();
    if (encoding == Encoding::Half) return glm::unpackHalf1x16(numbers.next<uint16_t>());
    return float(numbers.next<uint8_t>()) / 255;
}

/// What is no number, or less than 0, is nothing.
float usable(float value, bool keepsSigns = false) {
    return std::isfinite(value) && (keepsSigns || value > 0) ? value : 0;
}

Volume readGrid(const Context& context, const Plugin& volume) {
    const std::string file = context.document.file(volume, "filename").string();
    VolumeFile read = parseVolume(build::readFile(file), file);
    Volume result;
    result.mean = read.mean;
    // Mitsuba 0.x takes the box of the file, and Mitsuba 3 the unit cube.
    const bool takesBox = volume.flag("use_grid_bbox").value_or(volume.isOld);
    result.toFile = volume.transform("to_world");
    // The outermost values of Mitsuba 0.x are at the sides of the box, those of Mitsuba 3 half a
    // cell inside.
    if (takesBox && volume.isOld)
        for (const int axis : {0, 1, 2}) {
            if (read.grid.size[axis] < 2) continue;
            const double half = (read.high[axis] - read.low[axis]) / (read.grid.size[axis] - 1) / 2;
            read.low[axis] -= half;
            read.high[axis] += half;
        }
    if (takesBox)
        result.toFile = result.toFile * glm::translate(glm::dmat4(1.0), read.low) *
                        glm::scale(glm::dmat4(1.0), read.high - read.low);
    result.grid = std::move(read.grid);
    result.colors = std::move(read.colors);
    if (inSmallLetters(volume.text("filter_type").value_or("trilinear")) == "nearest")
        volume.replace(build::Shortfall::Model, "'filter_type' is 'nearest', expected trilinear",
                       "trilinear");
    for (const char* unused : {"wrap_mode", "raw", "accel", "send_data"})
        volume.skip(unused);
    return result;
}

} // namespace

Volume readVolume(const Context& context, const Plugin& volume) {
    Volume result;
    if (volume.type == "constvolume") {
        result.mean = colorOf(volume, "value", ColorOf::Index).value_or(glm::dvec3(1));
    } else if (volume.type == "gridvolume") {
        result = readGrid(context, volume);
    } else {
        volume.fail(fmt::format(
            "'{}' is no volume that is read, expected constvolume or gridvolume", volume.type));
    }
    volume.requireAllRead();
    return result;
}

VolumeFile parseVolume(std::string_view bytes, const std::string& name, bool keepsSigns) {
    const auto fail = [&](const std::string& problem) { throw SceneError(name, 0, "", problem); };
    if (!bytes.starts_with("VOL\x03")) fail("is no volume of Mitsuba's version 3");
    Numbers numbers(bytes.substr(4), name);
    const auto encoding = Encoding(numbers.next<int32_t>());
    if (encoding < Encoding::Float || encoding > Encoding::Byte)
        fail(fmt::format("has the encoding {}, expected 1, 2 or 3", int32_t(encoding)));
    VolumeFile file;
    uint64_t count = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const auto size = numbers.next<int32_t>();
        if (size < 1 || size > 1 << 16) fail(fmt::format("has the size {}", size));
        file.grid.size[axis] = uint32_t(size);
        count *= uint64_t(size);
    }
    const auto channels = numbers.next<int32_t>();
    if (channels != 1 && channels != 3)
        fail(fmt::format("has {} channels, expected 1 or 3", channels));
    for (glm::dvec3* corner : {&file.low, &file.high})
        for (int axis = 0; axis < 3; ++axis)
            (*corner)[axis] = numbers.next<float>();
    for (int axis = 0; axis < 3; ++axis)
        if (!(file.high[axis] > file.low[axis]) || !std::isfinite(file.high[axis] - file.low[axis]))
            fail("has a box without a volume");
    if (numbers.left() / bytesOf(encoding) / size_t(channels) < count) fail("ends too early");
    file.grid.values.resize(count);
    if (channels == 3) file.colors.emplace().size = file.grid.size;
    for (float& value : file.grid.values) {
        glm::vec3 color(0);
        for (int channel = 0; channel < channels; ++channel)
            color[channel] = usable(nextValue(numbers, encoding), keepsSigns);
        if (channels == 1) color = glm::vec3(color.x);
        if (file.colors) file.colors->values.push_back(color);
        file.mean += glm::dvec3(color) / double(count);
        value = usable(color.x / 3 + color.y / 3 + color.z / 3, keepsSigns);
        if (channels == 1) value = color.x;
    }
    return file;
}

} // namespace stromboli::mitsuba
