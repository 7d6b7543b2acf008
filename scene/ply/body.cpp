#include "scene/ply/body.hpp"

#include "scene/build/number_word.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>

namespace stromboli::ply {
namespace {

bool isSpace(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

/// As C writes them; elements that nobody looks at may hold them.
bool isNotFinite(std::string_view word) {
    std::string small(word.substr(0, 10));
    std::transform(small.begin(), small.end(), small.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    if (small.starts_with('-') || small.starts_with('+')) small.erase(0, 1);
    return small == "nan" || small == "inf" || small == "infinity" || small.starts_with("nan(");
}

template <typename T>
double fromBytes(const char* bytes, bool reverse) {
    char ordered[sizeof(T)];
    std::memcpy(ordered, bytes, sizeof(T));
    if (reverse) std::reverse(ordered, ordered + sizeof(T));
    T value;
    std::memcpy(&value, ordered, sizeof(T));
    return double(value);
}

} // namespace

build::FilePlace Body::place() const {
    const std::string name = kind_ ? fmt::format("{}[{}]", kind_->name.substr(0, 60), number_) : "";
    return {file_, encoding_ == Encoding::Ascii ? line_ : 0, name};
}

uint64_t Body::mostOf(const Element& kind) const {
    uint64_t least = 0;
    for (const Property& property : kind.properties)
        least += encoding_ == Encoding::Ascii ? 2 // a digit and what separates it from the next one
                                              : sizeOf(property.countType.value_or(property.type));
    // The last number of a file needs nothing after it.
    const uint64_t left = bytesLeft() + (encoding_ == Encoding::Ascii ? 1 : 0);
    return least > 0 ? left / least : std::numeric_limits<uint64_t>::max();
}

void Body::failAtEnd(const std::string& message) const {
    try {
        place().fail(message);
    } catch (const SceneError& error) {
        throw Truncated(error);
    }
}

void Body::begin(const Element& kind) {
    kind_ = &kind;
    number_ = 0;
    const uint64_t most = mostOf(kind);
    if (kind.count <= most) return;
    try {
        build::FilePlace{file_, 0, kind.name.substr(0, 60)}.fail(
            fmt::format("the header says that there are {}, but {} bytes are left, which hold {} "
                        "at most",
                        kind.count, bytesLeft(), most));
    } catch (const SceneError& error) {
        throw Truncated(error);
    }
}

void Body::beginElement(uint64_t number) {
    number_ = number;
}

/// An element has a line of its own.
void Body::endElement() {
    if (encoding_ != Encoding::Ascii || kind_->properties.empty()) return;
    while (at_ < bytes_.size() && isSpace(bytes_[at_]) && bytes_[at_] != '\n' &&
           bytes_[at_] != '\r')
        ++at_;
    const size_t end = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
    if (end == at_) return;
    report_.forgive(place(), "the line has more numbers than the header says",
                    "what is left over is skipped");
    at_ = end;
}

std::string_view Body::word() {
    while (at_ < bytes_.size() && isSpace(bytes_[at_])) {
        const bool isPair =
            bytes_[at_] == '\r' && at_ + 1 < bytes_.size() && bytes_[at_ + 1] == '\n';
        if (bytes_[at_] == '\n' || (bytes_[at_] == '\r' && !isPair)) ++line_;
        ++at_;
    }
    const size_t begin = at_;
    while (at_ < bytes_.size() && !isSpace(bytes_[at_]))
        ++at_;
    return bytes_.substr(begin, at_ - begin);
}

double Body::textNumber() {
    const std::string_view text = word();
    if (text.empty()) failAtEnd("the file ends where a number is expected");
    if (const std::optional<double> value = build::realIn(text)) return *value;
    if (!isNotFinite(text))
        report_.replace(place(), build::Shortfall::Vertex,
                        fmt::format("'{}' is no number", text.substr(0, 60)));
    return std::numeric_limits<double>::quiet_NaN();
}

double Body::binaryNumber(ScalarType type) {
    const size_t size = sizeOf(type);
    if (bytesLeft() < size) failAtEnd("the file ends where a number is expected");
    const char* bytes = bytes_.data() + at_;
    at_ += size;
    const bool isLittle = std::endian::native == std::endian::little;
    const bool reverse = (encoding_ == Encoding::LittleEndian) != isLittle;
    switch (type) {
    case ScalarType::Int8:
        return fromBytes<int8_t>(bytes, reverse);
    case ScalarType::UInt8:
        return fromBytes<uint8_t>(bytes, reverse);
    case ScalarType::Int16:
        return fromBytes<int16_t>(bytes, reverse);
    case ScalarType::UInt16:
        return fromBytes<uint16_t>(bytes, reverse);
    case ScalarType::Int32:
        return fromBytes<int32_t>(bytes, reverse);
    case ScalarType::UInt32:
        return fromBytes<uint32_t>(bytes, reverse);
    case ScalarType::Float32:
        return fromBytes<float>(bytes, reverse);
    case ScalarType::Float64:
        return fromBytes<double>(bytes, reverse);
    case ScalarType::Int64:
        return fromBytes<int64_t>(bytes, reverse);
    case ScalarType::UInt64:
        return fromBytes<uint64_t>(bytes, reverse);
    }
    return 0;
}

double Body::number(ScalarType type) {
    return encoding_ == Encoding::Ascii ? textNumber() : binaryNumber(type);
}

uint64_t Body::listLength(const Property& property) {
    const double length = number(*property.countType);
    if (!(length >= 0) || length != std::floor(length))
        fail(fmt::format("the length of the list '{}' is {}", property.name.substr(0, 60), length));
    const uint64_t least = encoding_ == Encoding::Ascii ? 2 : sizeOf(property.type);
    const uint64_t left = bytesLeft() + (encoding_ == Encoding::Ascii ? 1 : 0);
    if (length > double(left / least))
        failAtEnd(fmt::format("the list '{}' has {} numbers, but {} bytes are left",
                              property.name.substr(0, 60), length, bytesLeft()));
    return uint64_t(length);
}

void Body::skip(const Property& property) {
    if (!property.countType) return void(number(property.type));
    const uint64_t length = listLength(property);
    for (uint64_t i = 0; i < length; ++i)
        number(property.type);
}

} // namespace stromboli::ply
