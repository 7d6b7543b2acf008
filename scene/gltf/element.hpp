#pragma once

#include "host/core/json.hpp"
#include "scene/build/report.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli::gltf {

/// An object of the file, which knows its place, such as `meshes[0].primitives[2]`. Its members are
/// read with the type that they must have; those that have another one are errors that name the
/// member where nothing can be shown without it. Where the member may be missing, it counts as
/// that, and the report says so.
class Element {
  public:
    /// `file`, `json` and `report` must outlive the element. No report: all is an error.
    Element(const std::string& file, std::string path, const Json& json,
            build::Report* report = nullptr);

    const std::string& path() const { return path_; }
    build::FilePlace place() const { return {*file_, 0, path_}; }
    [[noreturn]] void fail(const std::string& message) const { place().fail(message); }
    /// About one member.
    [[noreturn]] void fail(std::string_view member, const std::string& message) const;
    /// Reports likewise, where the rest can be shown: the report says what is taken instead.
    void forgive(build::Shortfall kind, std::string_view member, const std::string& message) const;
    /// This element, but all that is wrong with it is an error.
    Element strictly() const { return {*file_, path_, *json_}; }

    bool has(std::string_view member) const { return find(member) != nullptr; }

    /// An object, or nothing if it is not there.
    std::optional<Element> child(std::string_view member) const;
    /// `extensions.NAME`, or nothing.
    std::optional<Element> extension(std::string_view name) const;
    /// How many elements an array has; 0 if it is not there.
    size_t size(std::string_view member) const;
    /// One object of an array; `index` must be below its size.
    Element item(std::string_view member, size_t index) const;
    /// Those of an array that are objects.
    std::vector<Element> items(std::string_view member) const;
    /// The names of all members.
    std::vector<std::string> names() const;

    double number(std::string_view member) const;
    double number(std::string_view member, double otherwise) const;
    /// A number in a range.
    double number(std::string_view member, double otherwise, double least, double most) const;
    bool flag(std::string_view member, bool otherwise) const;
    std::string text(std::string_view member, const std::string& otherwise = "") const;
    /// A whole number that is not negative.
    uint64_t count(std::string_view member) const;
    uint64_t count(std::string_view member, uint64_t otherwise) const;
    /// The number of something there are `size` of, such as a node; nothing if it is not there.
    std::optional<size_t> index(std::string_view member, size_t size) const;
    std::vector<size_t> indices(std::string_view member, size_t size) const;
    /// Reads likewise; numbers that name nothing are left out.
    std::vector<size_t> indicesOr(std::string_view member, size_t size) const;
    /// Those of an array that are texts.
    std::vector<std::string> texts(std::string_view member) const;
    /// As many finite numbers as said (any number of them if 0); empty if not there.
    std::vector<double> numbers(std::string_view member, size_t expected) const;
    /// Reads likewise; numbers that are none, or another count of them, count as not there.
    std::vector<double> numbersOr(std::string_view member, size_t expected) const;
    glm::dvec3 vector(std::string_view member, const glm::dvec3& otherwise) const;

    /// Its `name`, or else its place.
    std::string displayName() const;

  private:
    /// Reads a member that may be missing; where that fails, `otherwise` is taken.
    template <class Value, class Read>
    Value readOr(const Value& otherwise, build::Shortfall kind, Read&& read) const;
    std::string pathOf(std::string_view member) const;
    const Json* find(std::string_view member) const;
    const Json& require(std::string_view member) const;
    /// Nothing if it is not there.
    const Json* array(std::string_view member) const;
    double numberOf(std::string_view member, const Json& json) const;
    size_t indexOf(std::string_view member, const Json& json, size_t size) const;
    uint64_t countOf(std::string_view member, const Json& json) const;

    const std::string* file_;
    std::string path_;
    const Json* json_;
    build::Report* report_;
};

} // namespace stromboli::gltf
