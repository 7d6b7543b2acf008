#include "host/core/json.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>

namespace stromboli {

Json parseJson(std::string_view text, int deepest) {
    const auto lineOf = [&](size_t byte) {
        return 1 + std::count(text.begin(), text.begin() + ptrdiff_t(std::min(byte, text.size())),
                              '\n');
    };
    const auto checkDepth = [&](int depth, Json::parse_event_t event, const Json&) {
        const bool opens =
            event == Json::parse_event_t::array_start || event == Json::parse_event_t::object_start;
        if (opens && depth >= deepest) // of the outermost it is 0
            throw JsonError("brackets go deeper than " + std::to_string(deepest) + " levels");
        return true;
    };
    try {
        return Json::parse(text, checkDepth);
    } catch (const Json::parse_error& error) {
        throw JsonError("its JSON is wrong in line " + std::to_string(lineOf(error.byte)));
    } catch (const Json::exception&) { // numbers beyond the range of double
        throw JsonError("its JSON has a number beyond the range of double");
    }
}

} // namespace stromboli
