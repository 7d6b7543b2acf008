#pragma once

#include <nlohmann/json_fwd.hpp>

#include <stdexcept>
#include <string_view>

namespace stromboli {

/// JSON whose objects keep their members in the order in which they were added. Files that do more
/// than pass it on include <nlohmann/json.hpp>, which takes seconds to compile.
using Json = nlohmann::ordered_json;

/// A text that is no JSON, or too deep.
class JsonError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The value that a text from elsewhere states; throws JsonError, with the line of what is wrong,
/// also where brackets within each other go deeper than `deepest`.
Json parseJson(std::string_view text, int deepest);

} // namespace stromboli
