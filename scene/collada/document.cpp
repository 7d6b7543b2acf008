#include "scene/collada/document.hpp"

#include "host/core/error.hpp"
#include "scene/build/read_file.hpp"

#include <fmt/format.h>

#include <cstring>

namespace stromboli::collada {
namespace {

std::string describe(tinyxml2::XMLError error) {
    switch (error) {
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
        return "the file is empty";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
        return "an element is not closed, or closed by another's tag (is the file cut short?)";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
        return fmt::format("elements are nested more than {} deep", TINYXML2_MAX_ELEMENT_DEPTH);
    default:
        return tinyxml2::XMLDocument::ErrorIDToName(error);
    }
}

std::string key(const char* kind, std::string_view id) {
    return fmt::format("{}#{}", kind, id);
}

/// `%20` and the like, which references may use where ids have the character itself.
std::string percentDecoded(std::string_view text) {
    const auto digit = [](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        if (c >= 'A' && c <= 'F') return c - 'A' + 10;
        return -1;
    };
    std::string decoded;
    for (size_t i = 0; i < text.size(); ++i) {
        const bool escape = text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 &&
                            digit(text[i + 2]) >= 0;
        if (escape) {
            decoded += char(digit(text[i + 1]) * 16 + digit(text[i + 2]));
            i += 2;
        } else {
            decoded += text[i];
        }
    }
    return decoded;
}

bool isCgl(const Element& technique) {
    const char* profile = technique.Attribute("profile");
    return profile && (std::strcmp(profile, "CGL") == 0 || std::strcmp(profile, "CMU462") == 0);
}

} // namespace

Document::Document(const std::filesystem::path& file) : file_(file.string()) {
    read(file);
    collectIds();
}

void Document::read(const std::filesystem::path& file) {
    const std::string text = build::readFile(file);
    xml_.Parse(text.data(), text.size());
    if (xml_.Error())
        throw SceneError(file_, xml_.ErrorLineNum(), "",
                         "not well-formed XML: " + describe(xml_.ErrorID()));
    if (!xml_.RootElement())
        throw SceneError(file_, 0, "", "has no elements, expected a COLLADA document");
    if (!named(root(), "COLLADA")) fail(root(), "the root element must be <COLLADA>");
}

void Document::collectIds() {
    // Recursion is bounded by the parser's limit on nesting.
    const auto visit = [this](const auto& self, const Element& element) -> void {
        ++elementCount_;
        if (const char* id = element.Attribute("id"))
            byKindAndId_.try_emplace(key(element.Name(), id), &element);
        if (named(element, "technique") && isCgl(element)) cglDialect_ = true;
        for (const Element& child : children(element))
            self(self, child);
    };
    visit(visit, root());
}

build::FilePlace Document::place(const Element& at) const {
    return {file_, at.GetLineNum(), at.Name()};
}

void Document::fail(const Element& at, const std::string& message) const {
    place(at).fail(message);
}

const Element& Document::require(const Element& parent, const char* child) const {
    if (const Element* found = parent.FirstChildElement(child)) return *found;
    fail(parent, fmt::format("has no <{}>, which is required", child));
}

std::string Document::requireAttribute(const Element& at, const char* name) const {
    if (const char* value = at.Attribute(name)) return value;
    fail(at, fmt::format("has no attribute '{}', which is required", name));
}

const Element& Document::resolve(const Element& at, const char* attribute, const char* kind) const {
    const std::string reference = requireAttribute(at, attribute);
    const size_t hash = reference.find('#');
    if (hash == std::string::npos)
        fail(at, fmt::format("{}=\"{}\" must be the id of a <{}>, written as #id", attribute,
                             reference, kind));
    if (hash > 0)
        fail(at, fmt::format("{}=\"{}\" refers to another file; only references within the file "
                             "(#id) are supported",
                             attribute, reference));
    const std::string_view id = std::string_view(reference).substr(1);
    auto found = byKindAndId_.find(key(kind, id));
    if (found == byKindAndId_.end()) found = byKindAndId_.find(key(kind, percentDecoded(id)));
    if (found == byKindAndId_.end())
        fail(at, fmt::format("{}=\"{}\": the file has no <{}> with this id", attribute, reference,
                             kind));
    return *found->second;
}

bool named(const Element& element, const char* name) {
    return std::strcmp(element.Name(), name) == 0;
}

std::string displayName(const Element& element) {
    for (const char* attribute : {"name", "id"})
        if (const char* value = element.Attribute(attribute); value && *value) return value;
    return element.Name();
}

const Element* cglTechnique(const Element& element) {
    for (const Element& extra : children(element)) {
        if (!named(extra, "extra")) continue;
        for (const Element& technique : children(extra))
            if (named(technique, "technique") && isCgl(technique)) return &technique;
    }
    return nullptr;
}

} // namespace stromboli::collada
