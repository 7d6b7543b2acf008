#include "scene/gltf/element.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::gltf {

Element::Element(const std::string& file, std::string path, const Json& json, build::Report* report)
    : file_(&file), path_(std::move(path)), json_(&json), report_(report) {
    if (!json.is_object()) fail("is no object, expected {...}");
}

void Element::fail(std::string_view member, const std::string& message) const {
    build::FilePlace{*file_, 0, pathOf(member)}.fail(message);
}

std::string Element::pathOf(std::string_view member) const {
    return path_.empty() ? std::string(member) : fmt::format("{}.{}", path_, member);
}

template <class Value, class Read>
Value Element::readOr(const Value& otherwise, build::Shortfall kind, Read&& read) const {
    if (!report_) return read();
    try {
        return read();
    } catch (const SceneError& error) {
        report_->replace(error, kind);
    }
    return otherwise;
}

void Element::forgive(build::Shortfall kind, std::string_view member,
                      const std::string& message) const {
    readOr(0, kind, [&]() -> int { fail(member, message); });
}

const Json* Element::find(std::string_view member) const {
    const auto found = json_->find(member);
    return found == json_->end() ? nullptr : &*found;
}

const Json& Element::require(std::string_view member) const {
    const Json* json = find(member);
    if (!json) fail(fmt::format("has no '{}'", member));
    return *json;
}

std::optional<Element> Element::child(std::string_view member) const {
    const Json* json = find(member);
    if (!json) return std::nullopt;
    return readOr<std::optional<Element>>(std::nullopt, build::Shortfall::Word, [&] {
        return std::optional(Element(*file_, pathOf(member), *json, report_));
    });
}

std::optional<Element> Element::extension(std::string_view name) const {
    const std::optional<Element> extensions = child("extensions");
    return extensions ? extensions->child(name) : std::nullopt;
}

const Json* Element::array(std::string_view member) const {
    const Json* json = find(member);
    if (!json) return nullptr;
    return readOr<const Json*>(nullptr, build::Shortfall::Word, [&] {
        if (!json->is_array()) fail(member, "is no array, expected [...]");
        return json;
    });
}

size_t Element::size(std::string_view member) const {
    const Json* elements = array(member);
    return elements ? elements->size() : 0;
}

Element Element::item(std::string_view member, size_t index) const {
    const std::string name = fmt::format("{}[{}]", member, index);
    return {*file_, path_.empty() ? name : fmt::format("{}.{}", path_, name),
            array(member)->at(index), report_};
}

std::vector<Element> Element::items(std::string_view member) const {
    std::vector<Element> found;
    const size_t count = size(member);
    for (size_t i = 0; i < count; ++i) {
        const auto one = readOr<std::optional<Element>>(
            std::nullopt, build::Shortfall::Word, [&] { return std::optional(item(member, i)); });
        if (one) found.push_back(*one);
    }
    return found;
}

std::vector<std::string> Element::names() const {
    std::vector<std::string> found;
    for (const auto& member : json_->items())
        found.push_back(member.key());
    return found;
}

double Element::numberOf(std::string_view member, const Json& json) const {
    if (!json.is_number()) fail(member, "is no number");
    const double value = json.get<double>();
    if (!std::isfinite(value)) fail(member, "is not finite");
    return value;
}

double Element::number(std::string_view member) const {
    return numberOf(member, require(member));
}

double Element::number(std::string_view member, double otherwise) const {
    const Json* json = find(member);
    if (!json) return otherwise;
    return readOr(otherwise, build::Shortfall::Word, [&] { return numberOf(member, *json); });
}

double Element::number(std::string_view member, double otherwise, double least, double most) const {
    const double value = number(member, otherwise);
    const double inside = std::clamp(value, least, most);
    // Programs hold these numbers in single precision, also the limits of what is legal.
    if (std::abs(value - inside) <= 0x1p-23 * std::abs(inside)) return inside;
    return readOr(inside, build::Shortfall::Number, [&]() -> double {
        fail(member, std::isinf(most)
                         ? fmt::format("is {}, expected at least {}", value, least)
                         : fmt::format("is {}, expected {} to {}", value, least, most));
    });
}

bool Element::flag(std::string_view member, bool otherwise) const {
    const Json* json = find(member);
    if (!json) return otherwise;
    return readOr(otherwise, build::Shortfall::Word, [&] {
        if (!json->is_boolean()) fail(member, "is neither true nor false");
        return json->get<bool>();
    });
}

std::string Element::text(std::string_view member, const std::string& otherwise) const {
    const Json* json = find(member);
    if (!json) return otherwise;
    return readOr(otherwise, build::Shortfall::Word, [&] {
        if (!json->is_string()) fail(member, "is no text");
        return json->get<std::string>();
    });
}

uint64_t Element::countOf(std::string_view member, const Json& json) const {
    const double value = numberOf(member, json);
    // Above 2^53 doubles skip whole numbers; nothing that a file can hold is that large.
    if (!(value >= 0 && value <= 0x1p53 && value == std::floor(value)))
        fail(member, fmt::format("is {}, expected a whole number of at least 0", value));
    return uint64_t(value);
}

uint64_t Element::count(std::string_view member) const {
    return countOf(member, require(member));
}

uint64_t Element::count(std::string_view member, uint64_t otherwise) const {
    const Json* json = find(member);
    if (!json) return otherwise;
    return readOr(otherwise, build::Shortfall::Word, [&] { return countOf(member, *json); });
}

std::optional<size_t> Element::index(std::string_view member, size_t size) const {
    const Json* json = find(member);
    if (!json) return std::nullopt;
    return readOr<std::optional<size_t>>(std::nullopt, build::Shortfall::Reference, [&] {
        return std::optional(indexOf(member, *json, size));
    });
}

size_t Element::indexOf(std::string_view member, const Json& json, size_t size) const {
    const uint64_t value = countOf(member, json);
    if (value >= size)
        fail(member, fmt::format("is {}, but there {} {}", value, size == 1 ? "is" : "are", size));
    return size_t(value);
}

std::vector<size_t> Element::indices(std::string_view member, size_t size) const {
    std::vector<size_t> found;
    const Json* elements = array(member);
    for (size_t i = 0; elements && i < elements->size(); ++i)
        found.push_back(indexOf(fmt::format("{}[{}]", member, i), (*elements)[i], size));
    return found;
}

std::vector<size_t> Element::indicesOr(std::string_view member, size_t size) const {
    std::vector<size_t> found;
    const Json* elements = array(member);
    for (size_t i = 0; elements && i < elements->size(); ++i) {
        const auto one =
            readOr<std::optional<size_t>>(std::nullopt, build::Shortfall::Reference, [&] {
                return std::optional(
                    indexOf(fmt::format("{}[{}]", member, i), (*elements)[i], size));
            });
        if (one) found.push_back(*one);
    }
    return found;
}

std::vector<std::string> Element::texts(std::string_view member) const {
    std::vector<std::string> found;
    const Json* elements = array(member);
    for (size_t i = 0; elements && i < elements->size(); ++i) {
        if ((*elements)[i].is_string())
            found.push_back((*elements)[i].get<std::string>());
        else
            forgive(build::Shortfall::Word, fmt::format("{}[{}]", member, i), "is no text");
    }
    return found;
}

std::vector<double> Element::numbers(std::string_view member, size_t expected) const {
    std::vector<double> found;
    const Json* elements = array(member);
    if (!elements) return found;
    if (expected > 0 && elements->size() != expected)
        fail(member, fmt::format("has {} numbers, expected {}", elements->size(), expected));
    for (size_t i = 0; i < elements->size(); ++i)
        found.push_back(numberOf(fmt::format("{}[{}]", member, i), (*elements)[i]));
    return found;
}

std::vector<double> Element::numbersOr(std::string_view member, size_t expected) const {
    return readOr(std::vector<double>(), build::Shortfall::Word,
                  [&] { return numbers(member, expected); });
}

glm::dvec3 Element::vector(std::string_view member, const glm::dvec3& otherwise) const {
    const std::vector<double> v = numbersOr(member, 3);
    return v.empty() ? otherwise : glm::dvec3(v[0], v[1], v[2]);
}

std::string Element::displayName() const {
    const Json* name = find("name");
    if (name && name->is_string() && !name->get<std::string>().empty())
        return name->get<std::string>();
    return path_;
}

} // namespace stromboli::gltf
