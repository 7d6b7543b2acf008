#include "scene/mitsuba/document_reader.hpp"

#include "host/core/error.hpp"
#include "scene/build/read_file.hpp"
#include "scene/build/tolerate.hpp"
#include "scene/mitsuba/color_text.hpp"
#include "scene/mitsuba/transforms.hpp"
#include "scene/mitsuba/upgrade.hpp"
#include "scene/mitsuba/words.hpp"
#include "scene/xml/parse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace stromboli::mitsuba {
namespace {

/// Mitsuba's own limit of files that include each other.
constexpr size_t kMostIncludeLevels = 15;
/// A file that includes itself twice would be read 2^15 times.
constexpr size_t kMostIncludes = 1000;

constexpr std::array<std::string_view, 14> kPluginTags = {
    "scene",   "shape", "sampler", "film",   "emitter", "sensor",     "bsdf",
    "texture", "phase", "volume",  "medium", "rfilter", "integrator", "subsurface"};
constexpr std::array<std::string_view, 10> kParameterTags = {
    "integer", "float", "boolean", "string",   "vector",
    "point",   "rgb",   "srgb",    "spectrum", "blackbody"};

template <size_t N>
bool isOneOf(const std::array<std::string_view, N>& words, std::string_view word) {
    return std::ranges::find(words, word) != words.end();
}

} // namespace

DocumentReader::DocumentReader(Document& document, const std::filesystem::path& file,
                               const std::vector<Definition>& definitions, build::Report& report)
    : document_(document), file_(file), report_(report) {
    for (const Definition& d : definitions) {
        values_[d.name] = d.value;
        defined_.insert(d.name);
    }
}

void DocumentReader::read() {
    Source source{file_.string(), file_.parent_path(), false, false, 0};
    document_.folders_ = {source.folder};
    tinyxml2::XMLDocument xml;
    xml::parse(xml, source.name, build::readFile(file_));
    const Element& root = *xml.RootElement();
    if (std::string_view(root.Name()) != "scene")
        placeOf(root, source).fail("the root element must be <scene>");
    if (!root.Attribute("version")) {
        report_.forgive(placeOf(root, source), "has no attribute 'version', such as 3.0.0",
                        "the scene is read as one of Mitsuba 0.x");
        source.isOld = true;
        source.isAncient = root.FirstChildElement("camera") || root.FirstChildElement("luminaire");
    }
    readVersion(root, source);
    // No other renderer has this element.
    if (source.isOld && root.FirstChildElement("mode")) {
        document_.isRainbows_ = true;
        report_.assume("the file has an element <mode>: it is one of the renderer Rainbow, whose "
                       "surfaces reflect on both sides");
    }
    document_.scene_ = &document_.plugins_.emplace_back();
    document_.scene_->tag = document_.scene_->type = "scene";
    document_.scene_->place = placeOf(root, source);
    document_.scene_->report = &report_;
    readChildren(root, source, *document_.scene_, 0);
    resolveReferences();
    for (const std::string& name : defined_)
        if (!used_.contains(name))
            throw SceneError(source.name, 0, "",
                             fmt::format("-D {}: nothing in the scene refers to ${}", name, name));
}

void DocumentReader::readVersion(const Element& root, Source& source) {
    const char* version = root.Attribute("version");
    if (!version) return;
    const std::string_view text(version);
    const size_t dot = std::min(text.find('.'), text.size());
    int64_t major = 3;
    build::tolerate(report_, build::Shortfall::Word,
                    [&] { major = integerOf(placeOf(root, source), text.substr(0, dot)); });
    source.isOld = major < 2;
    source.isAncient = major == 0 && (text.starts_with("0.1") || text.starts_with("0.2") ||
                                      text.starts_with("0.3"));
    if (major > 3) report_.assume(fmt::format("version {} of the file is read as version 3", text));
}

void DocumentReader::readChildren(const Element& element, const Source& source, Plugin& into,
                                  size_t depth) {
    if (depth > kMostLevels)
        placeOf(element, source).fail(fmt::format("lies more than {} levels deep", kMostLevels));
    for (const Element* child = element.FirstChildElement(); child;
         child = child->NextSiblingElement()) {
        const bool isParameter =
            isOneOf(kParameterTags, tagOf(*child, source)) || tagOf(*child, source) == "transform";
        build::tolerate(report_, isParameter ? build::Shortfall::Parameter : build::Shortfall::Node,
                        [&] { readChild(*child, source, into, depth + 1); });
    }
}

void DocumentReader::readChild(const Element& element, const Source& source, Plugin& into,
                               size_t depth) {
    const std::string tag = tagOf(element, source);
    const bool isSpectrumPlugin = tag == "spectrum" && element.Attribute("type");
    if (isOneOf(kPluginTags, tag) || isSpectrumPlugin) {
        Plugin& plugin = readPlugin(element, source, depth);
        into.add({nameOf(element, source, into), &plugin, plugin.place, ""});
    } else if (isOneOf(kParameterTags, tag) || tag == "transform") {
        readParameter(element, source, into);
    } else if (tag == "animation") {
        readAnimation(element, source, into);
    } else if (tag == "ref") {
        readReference(element, source, into);
    } else if (tag == "default") {
        readDefault(element, source);
    } else if (tag == "alias") {
        readAlias(element, source);
    } else if (tag == "path") {
        readPath(element, source);
    } else if (tag == "include") {
        include(element, source, into, depth);
    } else if (tag != "mode" || !document_.isRainbows_) {
        report_.forgive(placeOf(element, source), "is no element of a Mitsuba scene",
                        "it is left out");
    }
}

Plugin& DocumentReader::readPlugin(const Element& element, const Source& source, size_t depth) {
    checkAttributes(element, source, {"type", "id", "name", "version"});
    Plugin& plugin = document_.plugins_.emplace_back();
    plugin.place = placeOf(element, source);
    plugin.tag = tagOf(element, source);
    plugin.type = requireAttribute(element, source, "type");
    plugin.type = inSmallLetters(plugin.type);
    plugin.report = &report_;
    plugin.isOld = source.isOld;
    plugin.isAncient = source.isAncient;
    if (source.isOld) plugin.type = upgradedType(plugin.tag, plugin.type);
    plugin.id = attribute(element, source, "id").value_or("");
    if (!plugin.id.empty())
        build::tolerate(report_, build::Shortfall::Reference,
                        [&] { name(plugin.id, plugin, plugin.place); });
    readChildren(element, source, plugin, depth);
    return plugin;
}

void DocumentReader::readParameter(const Element& element, const Source& source, Plugin& into) {
    const std::string tag = tagOf(element, source);
    const build::FilePlace where = placeOf(element, source);
    (void)requireAttribute(element, source, "name");
    const std::string name = nameOf(element, source, into);
    if (tag == "transform") {
        checkAttributes(element, source, {"name"});
        return into.add(name, readTransform(element, source), where);
    }
    if (const Element* inside = element.FirstChildElement())
        placeOf(*inside, source).fail(fmt::format("cannot be inside a <{}>", tag));
    if (tag == "vector" || tag == "point") {
        checkAttributes(element, source, {"name", "value", "x", "y", "z"});
        const auto named = [&](std::string_view attributeName) {
            return attribute(element, source, std::string(attributeName).c_str());
        };
        return into.add(name, vectorOfAttributes(where, named, 0), where);
    }
    if (tag == "blackbody") return into.add(name, colorOf(element, source, tag), where);
    checkAttributes(element, source, {"name", "value", "filename", "intent", "unit"});
    if (tag == "spectrum" || tag == "rgb" || tag == "srgb")
        return into.add(name, colorOf(element, source, tag), where);
    const std::string text = requireAttribute(element, source, "value");
    const auto valueOf = [&]() -> Value {
        if (tag == "integer") return integerOf(where, text);
        if (tag == "float") return numberOf(where, text);
        if (tag == "boolean") return flagOf(where, text);
        return text;
    };
    into.add(name, valueOf(), where);
}

Value DocumentReader::colorOf(const Element& element, const Source& source,
                              const std::string& tag) {
    const build::FilePlace where = placeOf(element, source);
    if (tag == "blackbody") {
        checkAttributes(element, source, {"name", "temperature", "scale", "multiplier"});
        const std::string temperature = requireAttribute(element, source, "temperature");
        const char* scale = source.isAncient ? "multiplier" : "scale";
        return blackbodyOf(where, temperature, attribute(element, source, scale).value_or("1"));
    }
    if (const std::optional<std::string> file = attribute(element, source, "filename"))
        return spectrumOfFile(where, build::readFile(document_.find(where, *file)));
    const std::string text = requireAttribute(element, source, "value");
    if (tag == "spectrum") return spectrumOf(where, text);
    if (tag == "srgb") return srgbOf(where, text);
    if (!text.starts_with('#')) return rgbOf(where, text);
    if (source.isOld) return hexOf(where, text);
    report_.forgive(
        where,
        fmt::format("is '{}', expected three numbers; <srgb> takes #rrggbb", text.substr(0, 40)),
        "it is taken for sRGB");
    return srgbOf(where, text);
}

/// Nothing moves here: what it begins with is where the object is.
void DocumentReader::readAnimation(const Element& element, const Source& source, Plugin& into) {
    const build::FilePlace where = placeOf(element, source);
    const Element* first = element.FirstChildElement("transform");
    if (!first) where.fail("has no <transform> inside, expected one");
    report_.replace(where, build::Shortfall::Model, "is a movement",
                    "its first transform is taken");
    into.add(nameOf(element, source, into), readTransform(*first, source), where);
}

std::string DocumentReader::nameOf(const Element& element, const Source& source,
                                   const Plugin& into) {
    std::string name = attribute(element, source, "name").value_or("");
    if (!source.isOld) return name;
    if (source.isAncient) name = ancientName(into.tag, into.type, name);
    return upgradedName(name);
}

glm::dmat4 DocumentReader::readTransform(const Element& element, const Source& source) {
    glm::dmat4 transform(1.0);
    for (const Element* step = element.FirstChildElement(); step;
         step = step->NextSiblingElement()) {
        checkAttributes(*step, source,
                        {"x", "y", "z", "value", "angle", "origin", "target", "up", "ox", "oy",
                         "oz", "tx", "ty", "tz", "ux", "uy", "uz"});
        const auto named = [&](std::string_view name) {
            return attribute(*step, source, std::string(name).c_str());
        };
        const std::string tag = tagOf(*step, source);
        const auto apply = [&](const Attributes& attributes) {
            return build::tolerate(report_, build::Shortfall::Parameter, [&] {
                transform = transformStep(placeOf(*step, source), tag, attributes) * transform;
            });
        };
        // A look-at whose `up` is of no use has one without.
        if (!apply(named) && tag == "lookat")
            apply([&](std::string_view name) {
                return name.starts_with('u') ? std::nullopt : named(name);
            });
    }
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(transform[column][row]))
                placeOf(element, source).fail("has numbers that are too large");
    return transform;
}

void DocumentReader::readReference(const Element& element, const Source& source, Plugin& into) {
    checkAttributes(element, source, {"name", "id"});
    into.add({nameOf(element, source, into), nullptr, placeOf(element, source),
              requireAttribute(element, source, "id")});
}

void DocumentReader::readDefault(const Element& element, const Source& source) {
    checkAttributes(element, source, {"name", "value"});
    const std::string name = requireAttribute(element, source, "name");
    if (name.empty()) placeOf(element, source).fail("has an empty name");
    values_.try_emplace(name, requireAttribute(element, source, "value"));
}

void DocumentReader::readAlias(const Element& element, const Source& source) {
    checkAttributes(element, source, {"id", "as"});
    const build::FilePlace where = placeOf(element, source);
    const std::string id = requireAttribute(element, source, "id");
    const auto found = ids_.find(id);
    if (found == ids_.end()) where.fail(fmt::format("there is no object with the id '{}'", id));
    name(requireAttribute(element, source, "as"), *found->second.plugin, where);
}

void DocumentReader::readPath(const Element& element, const Source& source) {
    checkAttributes(element, source, {"value"});
    const std::filesystem::path folder = source.folder / requireAttribute(element, source, "value");
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error))
        placeOf(element, source).fail(fmt::format("there is no folder '{}'", folder.string()));
    document_.folders_.insert(document_.folders_.begin(), folder);
}

void DocumentReader::include(const Element& element, const Source& source, Plugin& into,
                             size_t depth) {
    checkAttributes(element, source, {"filename"});
    const build::FilePlace where = placeOf(element, source);
    const std::filesystem::path file =
        document_.find(where, requireAttribute(element, source, "filename"));
    Source inner{file.string(), file.parent_path(), source.isOld, source.isAncient,
                 source.depth + 1};
    if (inner.depth > kMostIncludeLevels)
        where.fail(
            fmt::format("files include each other more than {} levels deep", kMostIncludeLevels));
    if (++includes_ > kMostIncludes)
        where.fail(fmt::format("is the include number {}, too many", includes_));
    tinyxml2::XMLDocument xml;
    xml::parse(xml, inner.name, build::readFile(file));
    const Element& root = *xml.RootElement();
    readVersion(root, inner);
    if (std::string_view(root.Name()) == "scene")
        readChildren(root, inner, into, depth);
    else
        readChild(root, inner, into, depth);
}

std::string DocumentReader::tagOf(const Element& element, const Source& source) {
    const std::string_view name = element.Name();
    if (!source.isOld) return std::string(name);
    if (name == "lookAt") return "lookat";
    if (name == "luminaire") return "emitter";
    return name == "camera" ? "sensor" : std::string(name);
}

build::FilePlace DocumentReader::placeOf(const Element& element, const Source& source) const {
    return {source.name, element.GetLineNum(), element.Name()};
}

std::optional<std::string> DocumentReader::attribute(const Element& element, const Source& source,
                                                     const char* name) {
    const char* value = element.Attribute(name);
    if (!value) return std::nullopt;
    return replaced(placeOf(element, source), value);
}

std::string DocumentReader::requireAttribute(const Element& element, const Source& source,
                                             const char* name) {
    std::optional<std::string> value = attribute(element, source, name);
    if (!value) placeOf(element, source).fail(fmt::format("has no attribute '{}'", name));
    return *std::move(value);
}

void DocumentReader::checkAttributes(const Element& element, const Source& source,
                                     std::initializer_list<std::string_view> known) const {
    for (const auto* a = element.FirstAttribute(); a; a = a->Next())
        if (std::ranges::find(known, std::string_view(a->Name())) == known.end())
            report_.replace(placeOf(element, source), build::Shortfall::Parameter,
                            fmt::format("has the attribute '{}', expected one of {}", a->Name(),
                                        fmt::join(known, ", ")));
}

/// Puts values in the place of $names: where several names fit, that of the longest.
std::string DocumentReader::replaced(const build::FilePlace& where, std::string_view text) {
    std::string result;
    for (size_t at = 0; at < text.size();) {
        if (text[at] != '$') {
            result += text[at++];
            continue;
        }
        const std::string_view rest = text.substr(at + 1);
        const std::pair<const std::string, std::string>* longest = nullptr;
        for (const auto& value : values_)
            if (rest.starts_with(value.first) &&
                (!longest || value.first.size() > longest->first.size()))
                longest = &value;
        if (!longest)
            throw build::UnusableScene(SceneError(
                where.file, where.line, where.element,
                fmt::format("refers to '${}', which has no value: expected a <default> before it, "
                            "or -D NAME=VALUE",
                            rest.substr(0, 40))));
        used_.insert(longest->first);
        result += longest->second;
        at += 1 + longest->first.size();
    }
    return result;
}

} // namespace stromboli::mitsuba
