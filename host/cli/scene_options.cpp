// Options: which scene, how it is read, and what is put around it.
#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"
#include "host/core/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace stromboli {
namespace {

constexpr Range<uint32_t> kSceneNumbers{0, 0xFFFFFFFEu};
constexpr Range<uint32_t> kTextureSides{0, 65536};
constexpr Range<double> kAnimationSeconds{0, 1e9};

/// The numbers of a list, whose commas have nothing but numbers between them; else empty.
std::vector<double> numbersOfList(const std::string& word) {
    std::vector<double> numbers;
    for (size_t from = 0; from <= word.size();) {
        const size_t comma = std::min(word.find(',', from), word.size());
        const std::optional<double> value = realNumber(word.substr(from, comma - from));
        if (!value) return {};
        numbers.push_back(*value);
        from = comma + 1;
    }
    return numbers;
}

/// DENSITY[,R,G,B][,G].
FogRequest readFog(const std::string& word) {
    const std::vector<double> n = numbersOfList(word);
    const auto within = [&](size_t from, size_t end, double low, double high) {
        return std::all_of(n.begin() + long(from), n.begin() + long(end),
                           [&](double x) { return x >= low && x <= high; });
    };
    const bool hasColor = n.size() >= 4, hasAsymmetry = n.size() == 2 || n.size() == 5;
    const bool isRead = n.size() == 1 || n.size() == 2 || n.size() == 4 || n.size() == 5;
    if (!isRead || !within(0, 1, 0, 1e9) || (hasColor && !within(1, 4, 0, 1)) ||
        (hasAsymmetry &&
         !within(n.size() - 1, n.size(), -double(kMostAsymmetry), double(kMostAsymmetry))))
        throw UsageError(fmt::format(
            "--fog is '{}': expected a density per metre, or DENSITY,R,G,B with a colour in "
            "[0, 1], and behind either a mean cosine from -0.9999 to 0.9999",
            word));
    FogRequest fog;
    fog.density = n[0];
    if (hasColor) fog.color = {float(n[1]), float(n[2]), float(n[3])};
    if (hasAsymmetry) fog.asymmetry = n.back();
    return fog;
}

/// AZIMUTH,ELEVATION[,TURBIDITY].
SunRequest readSun(const std::string& word) {
    const std::vector<double> n = numbersOfList(word);
    const auto within = [&](size_t i, double low, double high) {
        return i >= n.size() || (n[i] >= low && n[i] <= high);
    };
    if (n.size() < 2 || n.size() > 3 || !within(0, -3600, 3600) || !within(1, 0, 90) ||
        !within(2, 1, 10))
        throw UsageError(fmt::format("--sun is '{}': expected AZIMUTH,ELEVATION in degrees, the "
                                     "second from 0 to 90, and behind them the haze from 1 to 10",
                                     word));
    SunRequest sun;
    sun.azimuth = n[0], sun.elevation = n[1];
    if (n.size() == 3) sun.turbidity = n[2];
    return sun;
}

GroundRequest readGround(const std::string& word) {
    GroundRequest ground;
    ground.isGiven = true;
    if (word == "on") return ground;
    const std::optional<glm::vec3> color = readRadiance(word);
    if (!color || std::max({color->x, color->y, color->z}) > 1)
        throw UsageError(fmt::format("--ground is '{}': expected on, a number from 0 to 1, or "
                                     "three with commas",
                                     word));
    ground.color = *color;
    return ground;
}

} // namespace

std::optional<glm::vec3> readRadiance(const std::string& word) {
    const size_t first = word.find(','), second = word.find(',', first + 1);
    const auto channel = [](const std::string& text) -> std::optional<float> {
        const std::optional<double> value = realNumber(text);
        if (!value || *value < 0 || *value > 1e30) return std::nullopt;
        return float(*value);
    };
    if (first == std::string::npos) {
        const std::optional<float> grey = channel(word);
        return grey ? std::optional(glm::vec3(*grey)) : std::nullopt;
    }
    if (second == std::string::npos) return std::nullopt;
    const std::optional<float> r = channel(word.substr(0, first)),
                               g = channel(word.substr(first + 1, second - first - 1)),
                               b = channel(word.substr(second + 1));
    return r && g && b ? std::optional(glm::vec3(*r, *g, *b)) : std::nullopt;
}

void declareScene(OptionList& list, SceneRequest& scene, Words* several) {
    list.group("Scene");
    const char* const help =
        "COLLADA (.dae, .zae), glTF (.gltf, .glb), Mitsuba (.xml), pbrt, OBJ, PLY, or by Assimp "
        "STL, "
        "FBX, 3DS, ... file; or a "
        "bundled scene by its name "
        "(reading_room, atrium, "
        "...); or generate:cornell_mesh:N for a scene of N triangles made in memory, "
        "generate:lamps:N for one lit by N triangles, generate:forest:N for N trees that "
        "are instances";
    CommandOption& named = several ? list.list("SCENE", "", help, *several)
                                   : list.text("SCENE", "", help, scene.source);
    named.required().proposes(Proposed::Scenes);
    SceneConventions& reading = scene.reading;
    list.onOff("--default-light",
               "on: a plain sky lights a file without any light; off: it stays black",
               reading.defaultLight);
    EnvironmentRequest& environment = scene.environment;
    list.words("--env", "FILE",
               "light from all around: an equirectangular picture (.hdr, .exr, ...), or a bundled "
               "one by its name: evening_sky, studio, overcast, interior; or its radiance as a "
               "number or as R,G,B; takes the place of ambient "
               "light and is seen by the camera",
               1,
               [&environment](const Words& words) {
                   if (words[0].empty()) throw UsageError("--env is empty: expected text");
                   environment.constant = readRadiance(words[0]);
                   environment.file = environment.constant ? "" : words[0];
               })
        .proposes(Proposed::Files);
    list.words("--sun", "AZIMUTH,ELEVATION",
               "light from a clear sky with its sun: degrees clockwise from -z as on a compass, "
               "seen from above, and above the horizon; a third number is the haze, 1 to 10 [3]",
               1, [&environment](const Words& words) { environment.sun = readSun(words[0]); })
        .excludes("--env", "both are the light from all around");
    list.words("--ground", "[COLOR]",
               "puts a wide diffuse floor under all there is: on (grey, also without COLOR), the "
               "share of light that it reflects, 0 to 1, or R,G,B",
               1, [&scene](const Words& words) { scene.ground = readGround(words[0]); })
        .maybeWithout("on", [](const std::string& word) {
            return word == "on" || word.find_first_not_of("0123456789.,e-+") == std::string::npos;
        });
    list.real("--env-rotate", "DEGREES",
              "turns it, or the file's own one, about the vertical, counter-clockwise seen from "
              "above",
              environment.rotationDegrees, {-3600, 3600}, kDegrees)
        .excludes("--sun", "its first number turns it");
    list.real("--env-strength", "X", "multiplies its radiance", environment.strength, {0, 1e9})
        .needs("--env");
    list.list("--portal", "NAME",
              "objects, with commas between, that are no surfaces, but rectangles through which "
              "the sky is seen: light samples to it aim at them",
              scene.portals)
        .separatedByCommas = true;
    list.words("--fog", "DENSITY",
               "fills the scene with fog of that extinction per metre; DENSITY,R,G,B: of a colour; "
               "and ,G behind either: its light goes forwards (up to 0.9999) or back (-0.9999)",
               1, [&scene](const Words& words) { scene.fog = readFog(words[0]); });
    FileSelection& selection = reading.selection;
    list.words("--scene", "N", "glTF: the scene of this number, from 0", 1,
               [&selection](const Words& words) {
                   selection.scene = readNumber("--scene", words[0], kSceneNumbers);
               })
        .usually("the file's own choice")
        .from(inWords(kSceneNumbers));
    list.text("--variant", "NAME", "glTF: the set of materials of this name", selection.variant);
    list.words("--at", "SECONDS", "glTF: the pose that the first animation has at this time", 1,
               [&selection](const Words& words) {
                   selection.seconds = readReal("--at", words[0], kAnimationSeconds, kTimes);
               })
        .usually("the pose without animation")
        .from(inWords(kAnimationSeconds));
    list.words(
            "-D,--define", "NAME=VALUE",
            "Mitsuba: the value of $NAME in the scene, in place of its <default>; may be repeated",
            1,
            [&selection](const Words& words) {
                for (const std::string& word : words) {
                    const size_t equals = word.find('=');
                    if (equals == 0 || equals == std::string::npos)
                        refuse("-D", word, "NAME=VALUE");
                    selection.definitions.push_back(
                        {word.substr(0, equals), word.substr(equals + 1)});
                }
            })
        .mayRepeat = true;
    list.number("--max-texture", "N",
                "halves pictures on surfaces until no side has more pixels; 0: never",
                selection.largestTexture, kTextureSides);
    list.choice(
        "--instances", "HOW",
        "what meshes that a file shows several times do with their triangles; sharing takes "
        "less memory, copies are faster",
        reading.instances);
    list.choice("--up", "AXIS",
                "which axis points up in OBJ, PLY, STL and other files that do not say so",
                reading.up);
    list.flag("--strict",
              "what breaks the rules of the scene's format or cannot be read is an error, also "
              "where it is clear "
              "what is meant",
              reading.strict);
}

} // namespace stromboli
