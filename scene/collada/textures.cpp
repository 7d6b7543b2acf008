#include "scene/collada/textures.hpp"

#include "host/core/error.hpp"
#include "host/core/system.hpp"
#include "scene/images/texture_image.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli::collada {
namespace {

/// The text of an element without the white space around it; empty where there is none.
std::string textOf(const Element* element) {
    const char* all = element ? element->GetText() : nullptr;
    if (!all) return "";
    std::string text = all;
    const char* spaces = " \t\r\n";
    text.erase(0, std::min(text.find_first_not_of(spaces), text.size()));
    text.erase(text.find_last_not_of(spaces) + 1);
    return text;
}

std::string textOf(const Element& parent, const char* child) {
    return textOf(parent.FirstChildElement(child));
}

Wrap readWrap(Context& context, const Element& sampler, const char* name) {
    const std::string mode = textOf(sampler, name);
    if (mode == "CLAMP") return Wrap::Clamp;
    if (mode == "BORDER" || mode == "NONE") {
        context.report.ignore(fmt::format("<{}> {}", name, mode),
                              "the picture's edge goes on beyond it");
        return Wrap::Clamp;
    }
    if (mode == "MIRROR_ONCE")
        context.report.ignore(fmt::format("<{}> {}", name, mode),
                              "the picture is mirrored at each edge");
    if (mode == "MIRROR" || mode == "MIRROR_ONCE") return Wrap::Mirror;
    if (!mode.empty() && mode != "WRAP")
        context.document.forgive(*sampler.FirstChildElement(name),
                                 fmt::format("'{}' is no way to wrap a picture", mode),
                                 "WRAP is taken");
    return Wrap::Repeat;
}

/// Pictures are looked up at one sharpness. That of a picture seen from near by is what counts;
/// where the file does not state it, that of one seen from afar.
bool isNearest(const Element& sampler) {
    const std::string near = textOf(sampler, "magfilter"), far = textOf(sampler, "minfilter");
    const bool isStated = !near.empty() && near != "NONE";
    return (isStated ? near : far).starts_with("NEAREST");
}

/// Exporters state what the standard has no word for in <extra>.
void reportPlacement(Context& context, const Element& texture) {
    for (const Element& extra : children(texture)) {
        if (!named(extra, "extra")) continue;
        for (const Element& technique : children(extra))
            for (const Element& at : children(technique)) {
                const bool repeats = named(at, "repeatU") || named(at, "repeatV");
                const bool moves = named(at, "offsetU") || named(at, "offsetV") ||
                                   named(at, "rotateUV") || named(at, "rotateFrame") ||
                                   named(at, "mirrorU") || named(at, "mirrorV");
                double value = 0;
                const bool isNumber = at.QueryDoubleText(&value) == tinyxml2::XML_SUCCESS;
                if (isNumber && ((repeats && value != 1) || (moves && value != 0)))
                    context.report.ignore(fmt::format("<{}> of a texture", at.Name()),
                                          "pictures are where their coordinates put them");
            }
    }
}

} // namespace

std::optional<uint32_t> Textures::read(const Scope& scope, const Element& texture,
                                       const char* reading) {
    const Document& document = context_.document;
    const Element* parameter = &texture;
    if (!named(texture, "newparam")) {
        reportPlacement(context_, texture);
        const std::string name = document.requireAttribute(texture, "texture");
        parameter = findParameter(scope, name.c_str());
        if (!parameter) {
            // Before 1.4.1, exporters named the picture itself.
            const Element* image = document.findId("image", name);
            document.forgive(texture,
                             fmt::format("texture=\"{}\": the effect has no <newparam> with this "
                                         "sid",
                                         name),
                             image ? "the picture with this id is taken" : reading);
            return image ? this->texture(nullptr, *image, reading) : std::nullopt;
        }
    }
    const Element* sampler = parameter->FirstChildElement("sampler2D");
    if (!sampler) {
        document.forgive(*parameter, "has no <sampler2D>", reading);
        return std::nullopt;
    }
    const Element* image = imageOf(scope, *sampler, reading);
    return image ? this->texture(sampler, *image, reading) : std::nullopt;
}

/// COLLADA 1.5: <instance_image>. COLLADA 1.4: <source> names a surface, that an image.
const Element* Textures::imageOf(const Scope& scope, const Element& sampler,
                                 const char* reading) const {
    const Document& document = context_.document;
    if (const Element* instance = sampler.FirstChildElement("instance_image"))
        return document.resolveOr(*instance, "url", "image", reading);
    const std::string source = textOf(sampler, "source");
    const Element* parameter = findParameter(scope, source.c_str());
    const Element* surface = parameter ? parameter->FirstChildElement("surface") : nullptr;
    const std::string id = surface ? textOf(*surface, "init_from") : source;
    const Element* image = document.findId("image", id);
    if (!image) image = document.find("image", id); // written as a reference, #id
    if (!surface)
        document.forgive(sampler,
                         fmt::format("its <source> '{}' is no surface of the effect", source),
                         image ? "the picture with this id is taken" : reading);
    else if (!image)
        document.forgive(*surface, fmt::format("the file has no <image> with the id '{}'", id),
                         reading);
    return image;
}

std::optional<uint32_t> Textures::texture(const Element* sampler, const Element& image,
                                          const char* reading) {
    const auto found = textures_.find({sampler, &image});
    if (found != textures_.end()) return found->second;
    const std::optional<uint32_t> picture = this->image(image, reading);
    if (!picture) return std::nullopt;
    Texture texture;
    texture.image = *picture;
    texture.srgb = true;
    if (sampler) {
        texture.wrapU = readWrap(context_, *sampler, "wrap_s");
        texture.wrapV = readWrap(context_, *sampler, "wrap_t");
        texture.nearest = isNearest(*sampler);
    }
    return textures_[{sampler, &image}] = context_.builder.addTexture(texture);
}

std::optional<uint32_t> Textures::image(const Element& element, const char* reading) {
    const auto [found, isNew] = images_.try_emplace(&element);
    if (isNew) found->second = load(element);
    if (!found->second.number) context_.document.forgive(element, found->second.problem, reading);
    return found->second.number;
}

Textures::Image Textures::load(const Element& element) {
    const Document& document = context_.document;
    const Element* from = element.FirstChildElement("init_from");
    const Element* ref = from ? from->FirstChildElement("ref") : nullptr; // COLLADA 1.5
    const std::string reference = textOf(ref ? ref : from);
    if (reference.empty()) return {std::nullopt, "names no file in <init_from>"};
    std::optional<Companion> file;
    TextureImage picture;
    std::vector<images::PictureFault> faults;
    try {
        file = document.companions().read(reference);
        if (!file)
            return {std::nullopt, fmt::format("'{}' is not in the document's folder", reference)};
        const std::string name = document.place(element).describe(reference);
        images::Picture decoded = images::decodePicture(file->bytes, reference);
        faults = std::move(decoded.faults);
        picture = images::textureImage(decoded, name, true);
    } catch (const SceneError& error) {
        return {std::nullopt, error.what()};
    }
    if (!file->problem.empty()) document.forgive(element, file->problem, file->reading);
    for (const images::PictureFault& fault : faults)
        document.replace(element, fault.kind, fmt::format("{}: {}", reference, fault.problem));
    const uint32_t largest = context_.conventions.selection.largestTexture;
    if (largest > 0) images::shrinkToFit(picture, largest, true);
    requireRoom(picture.words.size() * sizeof(uint32_t), element);
    return {context_.builder.addImage(std::move(picture)), ""};
}

/// A picture of one colour takes a few bytes in a file, and a file names any number of them.
void Textures::requireRoom(uint64_t bytes, const Element& element) {
    bytes_ += bytes;
    const uint64_t most = physicalMemory() / 2;
    if (bytes_ > most)
        context_.document.fail(
            element, fmt::format("brings the pictures to {} MiB, more than half of this machine's "
                                 "memory; --max-texture N shrinks them",
                                 bytes_ >> 20));
}

} // namespace stromboli::collada
