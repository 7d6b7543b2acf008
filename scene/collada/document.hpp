#pragma once

#include "scene/build/file_place.hpp"
#include "scene/build/report.hpp"
#include "scene/collada/companions.hpp"

#include <tinyxml2.h>

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <unordered_map>

namespace stromboli::collada {

using Element = tinyxml2::XMLElement;

/// What an attribute such as url="#id" points to; null, and why, where that is not there.
struct Reference {
    const Element* target = nullptr;
    std::string problem;
};

/// A COLLADA file in memory: its elements, their ids, and errors that say where.
class Document {
  public:
    /// Reads and parses the file. Throws SceneError if it cannot be read, is not well-formed XML
    /// or its root is not COLLADA. `report`, which must outlive the document, gets what is
    /// forgiven.
    Document(const std::filesystem::path& file, build::Report& report);

    const Element& root() const { return *xml_.RootElement(); }
    size_t elementCount() const { return elementCount_; }
    /// True if any element belongs to the dialect CGL.
    bool cglDialect() const { return cglDialect_; }

    /// The files that lie with it.
    const Companions& companions() const { return companions_; }

    /// Where the element stands.
    build::FilePlace place(const Element& at) const;
    /// Throws SceneError with file, line and name of the element.
    [[noreturn]] void fail(const Element& at, const std::string& message) const;

    /// Reports how the element breaks the standard, and how it is read (Report::forgive). Throws
    /// SceneError where nothing is forgiven.
    void forgive(const Element& at, const std::string& problem, const std::string& reading) const;

    /// Reports what cannot be read and what takes its place (Report::replace). Throws SceneError
    /// where nothing is forgiven.
    void replace(const Element& at, build::Shortfall kind, const std::string& problem) const;
    void replace(const Error& error, build::Shortfall kind) const;

    /// The first child of that name; throws SceneError where there is none.
    const Element& require(const Element& parent, const char* child) const;
    /// The attribute's text; throws SceneError where there is none.
    std::string requireAttribute(const Element& at, const char* name) const;

    /// The element named `kind` with that id; null where there is none.
    const Element* findId(const char* kind, std::string_view id) const;
    /// The element named `kind` that the reference `#id` points to; null where there is none.
    const Element* find(const char* kind, std::string_view reference) const;
    /// What the reference `#id` in the attribute points to: an element named `kind`. Throws
    /// SceneError if the attribute is missing, the reference leaves the file or nothing matches.
    const Element& resolve(const Element& at, const char* attribute, const char* kind) const;
    /// As resolve(); where nothing matches, null, which is forgiven: `reading` says what becomes of
    /// it.
    const Element* resolveOr(const Element& at, const char* attribute, const char* kind,
                             const char* reading) const;

  private:
    Reference lookUp(const Element& at, const char* attribute, const char* kind) const;
    void parse(const std::string& text);
    void collectIds();
    void addId(const Element& element, const char* id);

    build::Report& report_;
    std::string file_;
    Companions companions_;
    tinyxml2::XMLDocument xml_;
    std::unordered_map<std::string, const Element*> byKindAndId_;
    size_t elementCount_ = 0;
    bool cglDialect_ = false;
};

/// True if the element has that name.
bool named(const Element& element, const char* name);

/// The name attribute, else the id, else the element's own name: for messages.
std::string displayName(const Element& element);

/// The element's `<technique profile="CGL">` (or CMU462) inside one of its `<extra>`; null if it
/// has none.
const Element* cglTechnique(const Element& element);

/// Range over an element's children: `for (const Element& child : children(parent))`.
class children {
  public:
    explicit children(const Element& parent) : first_(parent.FirstChildElement()) {}

    struct Iterator {
        const Element* at;
        const Element& operator*() const { return *at; }
        Iterator& operator++() {
            at = at->NextSiblingElement();
            return *this;
        }
        bool operator!=(const Iterator& other) const { return at != other.at; }
    };
    Iterator begin() const { return {first_}; }
    Iterator end() const { return {nullptr}; }

  private:
    const Element* first_;
};

} // namespace stromboli::collada
