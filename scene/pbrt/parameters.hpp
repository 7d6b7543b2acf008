#pragma once

#include "scene/build/report.hpp"
#include "scene/pbrt/statement.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli::pbrt {

/// What a directive says of a thing: the first parameter of a name counts. Those of another type
/// than is asked for are said, and count as absent.
class Parameters {
  public:
    Parameters() = default;
    /// `report` must outlive the parameters.
    Parameters(const Statement& statement, build::Report& report)
        : place_(statement.place), list_(statement.parameters), report_(&report) {}

    const build::FilePlace& place() const { return place_; }
    build::FilePlace placeOf(const Parameter& parameter) const;
    /// How messages call the thing: the directive and its kind.
    void setKind(const std::string& kind) { place_.element += " \"" + kind + "\""; }

    /// Where nothing in the file stands for it.
    void placeAt(const build::FilePlace& place) { place_ = place; }

    /// Parameters that count where there are none of their names before.
    void append(const std::vector<Parameter>& more);
    /// Parameters that count in place of others.
    void prepend(const std::vector<Parameter>& more);
    const std::vector<Parameter>& all() const { return list_; }
    std::vector<Parameter> unread() const;

    /// Null where there is none; it counts as read.
    const Parameter* find(std::string_view name) const;
    bool has(std::string_view name) const;

    /// One number, in a range; nothing if there is none. One outside becomes the nearest in it.
    std::optional<double> number(std::string_view name) const;
    double number(std::string_view name, double otherwise, double least, double most) const;
    std::optional<int64_t> integer(std::string_view name) const;
    bool flag(std::string_view name, bool otherwise) const;
    std::optional<std::string> text(std::string_view name) const;
    std::vector<double> numbers(std::string_view name) const;
    /// Triples of numbers; what is left over is said.
    std::vector<glm::dvec3> points(std::string_view name) const;
    std::optional<glm::dvec3> vector(std::string_view name) const;
    /// The name of the texture that a parameter is.
    std::optional<std::string> texture(std::string_view name) const;

    /// They have no meaning here, which need not be said.
    void skip(std::initializer_list<std::string_view> names) const;
    /// Says which parameters nothing has read.
    void reportUnread() const;

    void replace(build::Shortfall kind, const std::string& problem) const;
    void replace(build::Shortfall kind, const std::string& problem,
                 const std::string& instead) const;
    void replaceParameter(std::string_view name, build::Shortfall kind,
                          const std::string& problem) const;

  private:
    /// The parameter, if it has numbers; said if it has none.
    const Parameter* numeric(std::string_view name, std::string_view expected) const;

    build::FilePlace place_;
    std::vector<Parameter> list_;
    build::Report* report_ = nullptr;
};

} // namespace stromboli::pbrt
