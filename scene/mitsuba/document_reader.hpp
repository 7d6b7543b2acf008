#pragma once

#include "scene/mitsuba/document.hpp"

#include <tinyxml2.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace stromboli::mitsuba {

using Element = tinyxml2::XMLElement;

/// As deep as the XML parser goes within a file; here with what is included and referred to.
inline constexpr size_t kMostLevels = 500;

/// Makes the objects of a document from the elements of its files.
class DocumentReader {
  public:
    DocumentReader(Document& document, const std::filesystem::path& file,
                   const std::vector<Definition>& definitions, build::Report& report);
    void read();

  private:
    /// The file that is being read.
    struct Source {
        std::string name;
        std::filesystem::path folder;
        bool isOld = false;     ///< of Mitsuba 0.x, with other names
        bool isAncient = false; ///< of Mitsuba 0.3 or earlier
        size_t depth = 0;       ///< how many files include it
    };
    struct Named {
        Plugin* plugin = nullptr;
        build::FilePlace place;
    };

    void readVersion(const Element& root, Source& source);
    /// Reads a parameter or an object inside of another one, as later versions write it.
    std::string nameOf(const Element& element, const Source& source, const Plugin& into);
    Value colorOf(const Element& element, const Source& source, const std::string& tag);
    void readAnimation(const Element& element, const Source& source, Plugin& into);
    void readChildren(const Element& element, const Source& source, Plugin& into, size_t depth);
    void readChild(const Element& element, const Source& source, Plugin& into, size_t depth);
    Plugin& readPlugin(const Element& element, const Source& source, size_t depth);
    void readParameter(const Element& element, const Source& source, Plugin& into);
    glm::dmat4 readTransform(const Element& element, const Source& source);
    void readReference(const Element& element, const Source& source, Plugin& into);
    void readDefault(const Element& element, const Source& source);
    void readAlias(const Element& element, const Source& source);
    void readPath(const Element& element, const Source& source);
    void include(const Element& element, const Source& source, Plugin& into, size_t depth);

    static std::string tagOf(const Element& element, const Source& source);
    build::FilePlace placeOf(const Element& element, const Source& source) const;
    std::optional<std::string> attribute(const Element& element, const Source& source,
                                         const char* name);
    std::string requireAttribute(const Element& element, const Source& source, const char* name);
    void checkAttributes(const Element& element, const Source& source,
                         std::initializer_list<std::string_view> known) const;
    std::string replaced(const build::FilePlace& where, std::string_view text);
    void name(const std::string& id, Plugin& plugin, const build::FilePlace& where);
    void resolveReferences();
    size_t heightOf(Plugin& plugin, size_t depth);

    Document& document_;
    std::filesystem::path file_;
    build::Report& report_;
    std::map<std::string, std::string> values_; ///< of $names
    std::set<std::string> defined_, used_;      ///< names on the command line; names that are used
    std::unordered_map<std::string, Named> ids_;
    std::unordered_map<const Plugin*, size_t> heights_; ///< 0: being found out
    size_t includes_ = 0;
};

} // namespace stromboli::mitsuba
