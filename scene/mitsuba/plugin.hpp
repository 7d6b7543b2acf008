#pragma once

#include "scene/build/file_place.hpp"
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
    std::string tag;    ///< the element's name: shape, bsdf, ...
    std::string type;   ///< which of its kind: sphere, diffuse, ...
    std::string id;     ///< empty: it has none
    bool isOld = false; ///< of a file of Mitsuba 0.x

    struct Child {
        std::string name; ///< empty: it has none
        const Plugin* plugin = nullptr;
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

    // Parameters. Each throws SceneError if the parameter is of another type.

    bool has(std::string_view name) const;
    /// The value itself, whatever it is; null if there is none.
    const Value* find(std::string_view name) const;
    std::optional<bool> flag(std::string_view name) const;
    std::optional<std::string> text(std::string_view name) const;
    std::optional<glm::dvec3> vector(std::string_view name) const;
    /// A whole number.
    std::optional<int64_t> integer(std::string_view name) const;
    /// A finite number in [least, most]; whole ones count.
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
    /// The same, where there can be one at most; throws SceneError if there are more.
    const Plugin* onlyChildOf(std::string_view tag) const;
    /// Counts a parameter or object as read.
    void skip(std::string_view name) const { asked_.insert(std::string(name)); }

    /// The names of parameters and the names or tags of objects that nothing asked for.
    std::vector<std::string> unread() const;
    /// Throws SceneError for the first one, with what was asked for.
    void requireAllRead() const;

  private:
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
