#include "scene/collada/document.hpp"

#include "scene/build/percent_decoding.hpp"
#include "scene/collada/source_text.hpp"
#include "scene/xml/parse.hpp"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <utility>

namespace stromboli::collada {
namespace {

std::string key(const char* kind, std::string_view id) {
    return fmt::format("{}#{}", kind, id);
}

bool isCgl(const Element& technique) {
    const char* profile = technique.Attribute("profile");
    return profile && (std::strcmp(profile, "CGL") == 0 || std::strcmp(profile, "CMU462") == 0);
}

} // namespace

Document::Document(const std::filesystem::path& file, build::Report& report) : report_(report) {
    SourceText source = readSourceText(file, report);
    file_ = std::move(source.name);
    companions_ = std::move(source.companions);
    parse(source.text);
    collectIds();
}

void Document::parse(const std::string& text) {
    xml::parse(xml_, file_, text);
    if (!named(root(), "COLLADA")) fail(root(), "the root element must be <COLLADA>");
}

void Document::collectIds() {
    // Recursion is bounded by the parser's limit on nesting.
    const auto visit = [this](const auto& self, const Element& element) -> void {
        ++elementCount_;
        if (const char* id = element.Attribute("id")) addId(element, id);
        if (named(element, "technique") && isCgl(element)) cglDialect_ = true;
        for (const Element& child : children(element))
            self(self, child);
    };
    visit(visit, root());
}

void Document::addId(const Element& element, const char* id) {
    const auto [known, isNew] = byKindAndId_.try_emplace(key(element.Name(), id), &element);
    if (isNew) return;
    forgive(element, fmt::format("the id '{}' is there already", id),
            "the first element with it that is not empty counts");
    if (known->second->NoChildren()) known->second = &element;
}

build::FilePlace Document::place(const Element& at) const {
    return {file_, at.GetLineNum(), at.Name()};
}

void Document::fail(const Element& at, const std::string& message) const {
    place(at).fail(message);
}

void Document::forgive(const Element& at, const std::string& problem,
                       const std::string& reading) const {
    report_.forgive(place(at), problem, reading);
}

void Document::replace(const Element& at, build::Shortfall kind, const std::string& problem) const {
    report_.replace(place(at), kind, problem);
}

void Document::replace(const Error& error, build::Shortfall kind) const {
    report_.replace(error, kind);
}

const Element& Document::require(const Element& parent, const char* child) const {
    if (const Element* found = parent.FirstChildElement(child)) return *found;
    fail(parent, fmt::format("has no <{}>, which is required", child));
}

std::string Document::requireAttribute(const Element& at, const char* name) const {
    if (const char* value = at.Attribute(name)) return value;
    fail(at, fmt::format("has no attribute '{}', which is required", name));
}

const Element* Document::find(const char* kind, std::string_view reference) const {
    return reference.starts_with('#') ? findId(kind, reference.substr(1)) : nullptr;
}

const Element* Document::findId(const char* kind, std::string_view id) const {
    auto found = byKindAndId_.find(key(kind, id));
    if (found == byKindAndId_.end())
        found = byKindAndId_.find(key(kind, build::percentDecoded(id)));
    return found == byKindAndId_.end() ? nullptr : found->second;
}

Reference Document::lookUp(const Element& at, const char* attribute, const char* kind) const {
    const std::string reference = requireAttribute(at, attribute);
    const auto problem = [&](const std::string& what) {
        return Reference{nullptr, fmt::format("{}=\"{}\"{}", attribute, reference, what)};
    };
    const size_t hash = reference.find('#');
    if (hash == std::string::npos)
        if (const Element* target = findId(kind, reference)) {
            forgive(at, fmt::format("{}=\"{}\" has no '#'", attribute, reference),
                    "the element with this id is taken");
            return {target, ""};
        }
    if (hash == std::string::npos)
        return {nullptr, fmt::format("{}=\"{}\" must be the id of a <{}>, written as #id",
                                     attribute, reference, kind)};
    const std::string_view file = std::string_view(reference).substr(0, hash);
    if (hash > 0 && std::filesystem::path(build::percentDecoded(file)).filename() !=
                        std::filesystem::path(file_).filename())
        return problem(" refers to another file; only references within the file (#id) are "
                       "supported");
    if (const Element* target = findId(kind, reference.substr(hash + 1))) return {target, ""};
    return problem(fmt::format(": the file has no <{}> with this id", kind));
}

const Element& Document::resolve(const Element& at, const char* attribute, const char* kind) const {
    const Reference reference = lookUp(at, attribute, kind);
    if (!reference.target) fail(at, reference.problem);
    return *reference.target;
}

const Element* Document::resolveOr(const Element& at, const char* attribute, const char* kind,
                                   const char* reading) const {
    const Reference reference = lookUp(at, attribute, kind);
    if (!reference.target) forgive(at, reference.problem, reading);
    return reference.target;
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
