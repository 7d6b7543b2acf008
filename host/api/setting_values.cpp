#include "host/api/setting_values.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::api {

void refuse(std::string_view name, const Value& value, const std::string& expected) {
    const auto* word = std::get_if<std::string>(&value);
    throw UsageError(fmt::format(
        "{}: expected {}, not {}", name, expected,
        word ? fmt::format("'{}'", *word)
             : fmt::format("{:g}", fmt::join(std::get<std::vector<double>>(value), ", "))));
}

std::vector<double> numbers(std::string_view name, const Value& value, size_t count, double least,
                            double most, const std::string& expected) {
    const auto* all = std::get_if<std::vector<double>>(&value);
    if (!all || all->size() != count) refuse(name, value, expected);
    for (const double number : *all)
        if (!(number >= least && number <= most)) refuse(name, value, expected);
    return *all;
}

double number(std::string_view name, const Value& value, double least, double most) {
    return numbers(name, value, 1, least, most,
                   fmt::format("a number from {:g} to {:g}", least, most))[0];
}

uint32_t whole(std::string_view name, const Value& value, uint32_t least, uint32_t most) {
    const std::string expected = fmt::format("a whole number from {} to {}", least, most);
    const double result = numbers(name, value, 1, least, most, expected)[0];
    if (result != std::floor(result)) refuse(name, value, expected);
    return uint32_t(result);
}

bool yes(std::string_view name, const Value& value) {
    return whole(name, value, 0, 1) == 1;
}

glm::dvec3 point(std::string_view name, const Value& value) {
    const auto p = numbers(name, value, 3, -kFarthest, kFarthest, "three coordinates in metres");
    return {p[0], p[1], p[2]};
}

const std::string& word(std::string_view name, const Value& value, const std::string& expected) {
    const auto* text = std::get_if<std::string>(&value);
    if (!text) refuse(name, value, expected);
    return *text;
}

glm::vec3 color(std::string_view name, const Value& value, double most, const std::string& what) {
    const auto* given = std::get_if<std::vector<double>>(&value);
    const bool isGrey = given && given->size() == 1;
    const auto c = numbers(name, value, isGrey ? 1 : 3, 0, most, what);
    return isGrey ? glm::vec3(float(c[0])) : glm::vec3(float(c[0]), float(c[1]), float(c[2]));
}

SunRequest sun(std::string_view name, const Value& value) {
    const std::string expected =
        "degrees around, degrees above the horizon (0 to 90), and maybe haze (1 to 10)";
    const auto* given = std::get_if<std::vector<double>>(&value);
    const size_t count = given && given->size() == 2 ? 2 : 3;
    const auto n = numbers(name, value, count, -3600, 3600, expected);
    SunRequest result{n[0], n[1]};
    if (count == 3) result.turbidity = n[2];
    if (!(result.elevation >= 0 && result.elevation <= 90 && result.turbidity >= 1 &&
          result.turbidity <= 10))
        refuse(name, value, expected);
    return result;
}

std::vector<std::string> names(std::string_view name, const Value& value, const std::string& what) {
    std::vector<std::string> result;
    const std::string& list = word(name, value, what + " with commas between");
    for (size_t first = 0, end = 0; !list.empty() && end != std::string::npos; first = end + 1) {
        end = list.find(',', first);
        result.push_back(list.substr(first, end - first));
    }
    return result;
}

std::vector<Layer> layers(std::string_view name, const Value& value) {
    std::vector<Layer> result;
    for (const std::string& one : names(name, value, "names of layers")) {
        const auto layer = valueNamed<Layer>(one);
        if (!layer) refuse(name, one, allNames<Layer>());
        if (std::ranges::count(result, *layer) == 0) result.push_back(*layer);
    }
    return result;
}

Roulette roulette(std::string_view name, const Value& value) {
    Roulette result;
    if (const auto* mode = std::get_if<std::string>(&value)) {
        if (*mode != "none" && *mode != "throughput")
            refuse(name, value, "none, throughput or a probability");
        result.mode = *mode == "none" ? Roulette::Mode::None : Roulette::Mode::Throughput;
        return result;
    }
    result.mode = Roulette::Mode::Fixed;
    result.terminationProbability = number(name, value, 0, std::nextafter(1.0, 0.0));
    return result;
}

Focus focus(std::string_view name, const Value& value) {
    constexpr const char* kMeant = "metres, 'auto', or the column and the row of a pixel";
    if (const auto* text = std::get_if<std::string>(&value)) {
        if (*text == "auto") return Focus::onMiddle();
        refuse(name, value, kMeant);
    }
    if (std::get<std::vector<double>>(value).size() == 2) {
        const auto pixel = numbers(name, value, 2, 0, 65535, kMeant);
        return Focus::onPixel({pixel[0], pixel[1]});
    }
    return number(name, value, std::numeric_limits<double>::min(), kFarthest);
}

} // namespace stromboli::api
