#pragma once

#include "scene/build/file_place.hpp"
#include "scene/build/report.hpp"
#include "scene/mitsuba/value.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli::mitsuba {

/// An object of a scene file: a shape, a BSDF, the camera, ..., with its parameters and the objects
/// inside it. It remembers which of them were asked for, so that what nothing reads can be named.
class Plugin {
  public:
    build::FilePlace place;
    std::string tag;        ///< the element's name: shape, bsdf, ...
    std::string type;       ///< which of its kind: sphere, diffuse, ...
    std::string id;         ///< empty: it has none
    bool isOld = false;     ///< of a file of Mitsuba 0.x
    bool isAncient = false; ///< of Mitsuba 0.3 or earlier
    /// Where it says what of it cannot be read; the document sets it.
    build::Report* report = nullptr;

    struct Child {
        std::string name; ///< empty: it has none
        Plugin* plugin = nullptr;
        build::FilePlace place; ///< of the reference, where it is one
        std::string reference;  ///< to be resolved, while the file is read
    };

    /// Throw SceneError if there is one of that name already.
    void add(const std::string& name, Value value, const build::FilePlace& where);
    void add(Child child);
    std::vector<Child>& children() { return children_; }
    const std::vector<Child>& children() const { return children_; }

    /// For messages: its id, or its type.
    std::string displayName() const { return id.empty() ? type : id; }

    /// Throws SceneError about the object, or about one of its parameters.
    [[noreturn]] void fail(const std::string& message) const { place.fail(message); }
    [[noreturn]] void fail(std::string_view parameter, const std::string& message) const;
    /// Says what is wrong with the object or with a parameter where something else can be taken
    /// instead, as the table of kinds says or, where it is stated, as `instead` does.
    void replace(build::Shortfall kind, const std::string& message) const;
    void replace(build::Shortfall kind, const std::string& message,
                 const std::string& instead) const;
    void replaceParameter(std::string_view parameter, build::Shortfall kind,
                          const std::string& message) const;

    // Parameters. One of another type than expected is said, and counts as absent.

    bool has(std::string_view name) const;
    /// The names of all parameters, in the order of the file.
    const std::vector<std::string>& names() const { return order_; }
    /// The value itself, whatever it is; null if there is none.
    const Value* find(std::string_view name) const;
    std::optional<bool> flag(std::string_view name) const;
    std::optional<std::string> text(std::string_view name) const;
    std::optional<glm::dvec3> vector(std::string_view name) const;
    /// A whole number.
    std::optional<int64_t> integer(std::string_view name) const;
    /// A finite number; whole ones count. One outside of [least, most] is said, and the nearest one
    /// in it is taken.
    std::optional<double> number(std::string_view name,
                                 double least = std::numeric_limits<double>::lowest(),
                                 double most = std::numeric_limits<double>::max()) const;
    glm::dmat4 transform(std::string_view name) const; ///< the identity where there is none
    /// A text; throws SceneError if there is none.
    std::string requireText(std::string_view name) const;

    /// The object of that name inside it; null if there is none.
    const Plugin* child(std::string_view name) const;
    /// The objects inside it with that tag, with or without a name.
    std::vector<const Plugin*> childrenOf(std::string_view tag) const;
    /// The object, where there can be one at most: the first one; others are said.
    const Plugin* onlyChildOf(std::string_view tag) const;
    /// Counts a parameter or object as read.
    void skip(std::string_view name) const { asked_.insert(std::string(name)); }

    /// The names of parameters and the names or tags of objects that nothing asked for.
    std::vector<std::string> unread() const;
    /// Says each of them, with what was asked for.
    void requireAllRead() const;

  private:
    build::FilePlace placeOf(std::string_view parameter) const;
    struct Parameter {
        Value value;
        build::FilePlace place;
    };

    const Parameter* ask(std::string_view name) const;
    template <class T>
    const T* askFor(std::string_view name, const char* expected) const;
    bool isRead(const Child& child) const;

    std::map<std::string, Parameter, std::less<>> parameters_;
    std::vector<std::string> order_; ///< of the file
    std::vector<Child> children_;
    mutable std::set<std::string, std::less<>> asked_, askedTags_;
};

} // namespace stromboli::mitsuba
