#include "scene/obj/mtl_file.hpp"

#include "host/core/error.hpp"
#include "scene/build/number_word.hpp"
#include "scene/build/read_file.hpp"
#include "scene/obj/blender.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace stromboli::obj {
namespace {

/// Keywords in small letters: programs do not agree on their capitals.
struct ColorKeyword {
    std::string_view name;
    std::optional<glm::dvec3> MtlMaterial::*member;
};
constexpr ColorKeyword kColors[] = {{"kd", &MtlMaterial::diffuse},
                                    {"ks", &MtlMaterial::specular},
                                    {"ke", &MtlMaterial::emission},
                                    {"tf", &MtlMaterial::filter}};

struct NumberKeyword {
    std::string_view name;
    std::optional<double> MtlMaterial::*member;
    bool isFraction = false; ///< of the range [0, 1]
};
constexpr NumberKeyword kNumbers[] = {{"ns", &MtlMaterial::exponent},
                                      {"ni", &MtlMaterial::ior},
                                      {"d", &MtlMaterial::dissolve, true},
                                      {"tr", &MtlMaterial::transparency, true},
                                      {"pr", &MtlMaterial::roughness, true},
                                      {"pm", &MtlMaterial::metallic, true},
                                      {"ps", &MtlMaterial::sheen, true},
                                      {"pc", &MtlMaterial::clearcoat, true},
                                      {"pcr", &MtlMaterial::clearcoatRoughness, true},
                                      {"aniso", &MtlMaterial::anisotropy, true},
                                      {"anisor", &MtlMaterial::anisotropyRotation},
                                      {"illum", &MtlMaterial::illumination}};

struct MapKeyword {
    std::string_view name;
    std::optional<Map> MtlMaterial::*member;
};
constexpr MapKeyword kMaps[] = {
    {"map_kd", &MtlMaterial::diffuseMap},   {"map_ks", &MtlMaterial::specularMap},
    {"map_ke", &MtlMaterial::emissionMap},  {"map_d", &MtlMaterial::opacityMap},
    {"map_pr", &MtlMaterial::roughnessMap}, {"map_pm", &MtlMaterial::metallicMap},
    {"norm", &MtlMaterial::normalMap},      {"map_kn", &MtlMaterial::normalMap},
    {"bump", &MtlMaterial::bumpMap},        {"map_bump", &MtlMaterial::bumpMap}};

/// What some programs call a map in plain words.
struct OtherName {
    std::string_view name, means;
};
constexpr OtherName kOtherNames[] = {
    {"map_color", "map_kd"},    {"map_diffuse", "map_kd"},   {"map_basecolor", "map_kd"},
    {"map_specular", "map_ks"}, {"map_emissive", "map_ke"},  {"map_emission", "map_ke"},
    {"map_opacity", "map_d"},   {"map_alpha", "map_d"},      {"map_roughness", "map_pr"},
    {"map_metallic", "map_pm"}, {"map_metalness", "map_pm"}, {"map_normal", "norm"},
    {"map_norm", "norm"},       {"normal", "norm"}};

// What has a meaning in files of Blender only.
constexpr ColorKeyword kBlenderColors[] = {{"ka", &MtlMaterial::ambient}};
constexpr MapKeyword kBlenderMaps[] = {{"map_ns", &MtlMaterial::exponentMap},
                                       {"map_refl", &MtlMaterial::reflectionMap},
                                       {"refl", &MtlMaterial::reflectionMap}};

struct IgnoredKeyword {
    std::string_view name, why;
};
constexpr IgnoredKeyword kIgnored[] = {
    {"ka", "light from everywhere is computed, not stated"},
    {"map_ka", "light from everywhere is computed, not stated"},
    {"disp", "surfaces stay where they are"},
    {"map_disp", "surfaces stay where they are"},
    {"decal", "there is one picture for each colour"},
    {"refl", "what is around a surface is seen in it"},
    {"map_refl", "what is around a surface is seen in it"},
    {"map_ns", "the exponent is the same all over a surface"},
    {"map_tr", "opacity is that of 'map_d'"},
    {"map_ps", "sheen is the same all over a surface"},
    {"map_pc", "the coat is the same all over a surface"},
    {"map_pcr", "the coat is the same all over a surface"},
    {"map_rma", "no two programs agree on its channels"},
    {"map_orm", "no two programs agree on its channels"},
    {"map_aat", "every picture is antialiased"},
    {"sharpness", "reflections are as sharp as the surface is smooth"},
    {"km", "it is in no specification"}};

template <typename Table>
auto find(const Table& table, std::string_view name) {
    const auto found = std::find_if(std::begin(table), std::end(table),
                                    [&](const auto& row) { return row.name == name; });
    return found == std::end(table) ? nullptr : &*found;
}

class MtlReader {
  public:
    MtlReader(const std::filesystem::path& file, build::Report& report)
        : MtlReader(file, build::readFile(file), report) {}

    MtlReader(const std::filesystem::path& file, const std::string& text, build::Report& report)
        : statements_(file.string(), text), blender_(blenderOf(text)), report_(report) {}

    std::vector<MtlMaterial> read() {
        while (statements_.next())
            readStatement(inSmallLetters(statements_.keyword().substr(0, 40)));
        if (blender_ && !materials_.empty())
            report_.assume("materials are those of Blender, which writes roughness as Ns, a share "
                           "of what dielectrics reflect as Ks and normal maps as map_Bump");
        for (MtlMaterial& material : materials_)
            if (blender_) takeMeaningOf(*blender_, material);
        return std::move(materials_);
    }

  private:
    void readStatement(std::string keyword) {
        if (const auto* other = find(kOtherNames, keyword)) {
            report_.forgive(statements_.place(), "is no statement of MTL",
                            fmt::format("it is read as '{}'", other->means));
            keyword = other->means;
        }
        if (keyword == "newmtl") {
            // A line of a few bytes; a material takes many.
            build::requireMemory(statements_.place().file,
                                 (materials_.size() + 1) * 2 * sizeof(MtlMaterial));
            materials_.push_back({});
            materials_.back().place = statements_.place();
            materials_.back().name = statements_.rest();
            return;
        }
        const auto* ofBlender = blender_ ? find(kBlenderColors, keyword) : nullptr;
        const auto* mapOfBlender = blender_ ? find(kBlenderMaps, keyword) : nullptr;
        const bool isRead = ofBlender || mapOfBlender;
        if (const auto* ignored = find(kIgnored, keyword); ignored && !isRead)
            return report_.ignore(fmt::format("'{}' of a material", statements_.keyword()),
                                  std::string(ignored->why));
        const auto* color = ofBlender ? ofBlender : find(kColors, keyword);
        const auto* fact = find(kNumbers, keyword);
        const auto* map = mapOfBlender ? mapOfBlender : find(kMaps, keyword);
        if (!color && !fact && !map)
            return report_.forgive(statements_.place(), "is no statement of MTL that is known",
                                   "the line is skipped");
        if (materials_.empty())
            return report_.forgive(statements_.place(), "stands before the first 'newmtl'",
                                   "the line is skipped");
        MtlMaterial& material = materials_.back();
        try {
            readParameter(color, fact, map, material);
        } catch (const SceneError& error) {
            // One parameter never costs the material.
            report_.replace(error, build::Shortfall::Word);
        }
    }

    template <class Color, class Number, class Picture>
    void readParameter(const Color* color, const Number* fact, const Picture* map,
                       MtlMaterial& material) {
        if (color) readColor(material.*color->member);
        if (fact) readNumber(*fact, material.*fact->member);
        if (map) readMap(material.*map->member);
    }

    /// r [g b]: without g and b, all are r.
    void readColor(std::optional<glm::dvec3>& color) {
        Words words(statements_.values());
        if (words.rest().starts_with("spectral"))
            return report_.ignore("colours by spectral curves", "red, green and blue are needed");
        if (words.rest().starts_with("xyz"))
            return report_.ignore("colours in CIE XYZ", "red, green and blue are needed");
        glm::dvec3 value(number(words));
        if (!words.atEnd()) {
            value.y = number(words);
            value.z = number(words);
        }
        color = value;
    }

    /// Scenes hold these numbers in single precision.
    double number(Words& words) {
        const double value = numberWithComma(words);
        if (!std::isfinite(float(value)))
            statements_.fail("has a number beyond the range of single precision");
        return value;
    }

    double numberWithComma(Words& words) {
        Words ahead = words;
        const std::optional<double> value = build::realWithCommaIn(ahead.next());
        if (!value) return statements_.number(words);
        report_.forgive(statements_.place(), "a number has a decimal comma",
                        "it is read as a decimal point");
        words = ahead;
        return *value;
    }

    void readNumber(const NumberKeyword& keyword, std::optional<double>& result) {
        Words words(statements_.values());
        if (words.rest().starts_with("-halo")) {
            words.next();
            report_.ignore("'d -halo'", "opacity does not depend on the angle");
        }
        double value = number(words);
        if (blender_ && keyword.name == "pc") value /= Blender::kWholeCoat;
        if (keyword.isFraction && (value < 0 || value > 1)) {
            report_.warn(
                fmt::format("'{}' of a material: a fraction outside [0, 1] is clamped to it",
                            statements_.keyword()));
            value = std::clamp(value, 0.0, 1.0);
        }
        result = value;
    }

    void readMap(std::optional<Map>& result) {
        Map map;
        map.place = statements_.place();
        Words words(statements_.rest());
        while (words.rest().starts_with('-')) {
            Words ahead = words;
            if (!readOption(ahead, map)) break;
            words = ahead;
        }
        map.name = words.rest();
        takeOptionsBehind(map);
        if (map.name.size() > 2 && map.name.starts_with('"') && map.name.ends_with('"')) {
            map.name = map.name.substr(1, map.name.size() - 2);
            report_.forgive(statements_.place(), "a name stands in quotation marks",
                            "they are no part of it");
        }
        if (map.name.empty())
            return report_.replace(statements_.place(), build::Shortfall::Picture, "names no file");
        if (result && result->name != map.name)
            report_.forgive(statements_.place(), "is there twice in a material",
                            "the last one counts");
        result = std::move(map);
    }

    /// Options belong before the name; some programs write them behind it.
    void takeOptionsBehind(Map& map) {
        const std::string text = map.name;
        for (size_t at = text.find(" -"); at != std::string::npos; at = text.find(" -", at + 1)) {
            Map changed = map;
            Words words(std::string_view(text).substr(at));
            // Where a name stands behind them, options read no word of it as a number of theirs.
            const std::string options = std::string(words.rest()) + " .";
            Words ahead(options);
            try {
                while (ahead.rest().starts_with('-'))
                    if (!readOption(ahead, changed)) break;
            } catch (const SceneError&) {
                continue; // of a file whose name looks like this
            }
            if (ahead.rest() != ".") continue;
            map = changed;
            map.name = Words(std::string_view(text).substr(0, at)).rest();
            while (map.name.ends_with(' ') || map.name.ends_with('\t'))
                map.name.pop_back();
            return report_.forgive(statements_.place(), "options stand behind the name",
                                   "they are read as if they stood before it");
        }
    }

    /// False if the words begin with no option: a name of a file may begin with '-' too.
    bool readOption(Words& words, Map& map) {
        const std::string option = inSmallLetters(words.next().substr(0, 40));
        if (option == "-clamp") {
            map.clamp = isOn(words);
        } else if (option == "-s" || option == "-o") {
            glm::dvec2& pair = option == "-s" ? map.scale : map.offset;
            readPair(words, pair);
        } else if (option == "-bm") {
            map.strength = number(words);
        } else if (option == "-imfchan") {
            map.channel = channelOf(words.next());
        } else if (option == "-t") {
            glm::dvec2 turbulence;
            readPair(words, turbulence);
            ignoreOption(option);
        } else if (option == "-mm") {
            const double base = number(words), gain = number(words);
            if (base != 0 || gain != 1) ignoreOption(option);
        } else if (option == "-colorspace") {
            if (inSmallLetters(words.next()) != "srgb") ignoreOption(option);
        } else if (option == "-boost" || option == "-texres" || option == "-blendu" ||
                   option == "-blendv" || option == "-cc" || option == "-type") {
            words.next();
            if (option == "-boost" || option == "-cc") ignoreOption(option);
        } else {
            return false;
        }
        return true;
    }

    void ignoreOption(const std::string& option) {
        report_.ignore(fmt::format("option {} of a picture", option),
                       "pictures are shown as they are");
    }

    bool isOn(Words& words) {
        const std::string_view value = words.next();
        if (value != "on" && value != "off")
            report_.replace(
                statements_.place(), build::Shortfall::Word,
                fmt::format("'{}' stands where on or off is expected", shortened(value)));
        return value == "on";
    }

    /// u [v [w]]; what comes last is the name of the file, also if it is a number.
    void readPair(Words& words, glm::dvec2& pair) {
        pair.x = number(words);
        for (int i = 1; i < 3; ++i) {
            Words ahead = words;
            const std::optional<double> value = build::realIn(ahead.next());
            if (!value || !std::isfinite(float(*value)) || ahead.atEnd()) return;
            words = ahead;
            if (i == 1) pair.y = *value;
        }
    }

    MapChannel channelOf(std::string_view word) {
        if (word == "r") return MapChannel::Red;
        if (word == "g") return MapChannel::Green;
        if (word == "b") return MapChannel::Blue;
        if (word == "m") return MapChannel::Alpha;
        if (word == "l") return MapChannel::Luminance;
        if (word == "z")
            report_.ignore("option -imfchan z of a picture", "pictures have no depth");
        else
            report_.replace(
                statements_.place(), build::Shortfall::Word,
                fmt::format("'{}' is no channel; expected r, g, b, m, l or z", shortened(word)));
        return MapChannel::Unstated;
    }

    Statements statements_;
    std::optional<Blender> blender_;
    build::Report& report_;
    std::vector<MtlMaterial> materials_;
};

} // namespace

std::vector<MtlMaterial> readMtlFile(const std::filesystem::path& file, build::Report& report) {
    return MtlReader(file, report).read();
}

} // namespace stromboli::obj
