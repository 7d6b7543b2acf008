#pragma once

#include "scene/build/file_place.hpp"

#include <string>
#include <vector>

namespace stromboli::pbrt {

/// `"type name" [ values ]`.
struct Parameter {
    std::string type, name;
    int line = 0;
    std::vector<double> numbers;
    std::vector<std::string> words; ///< strings, and true and false without quotes

    /// What has been read of it; what never is, is said.
    mutable bool isRead = false;
};

/// A directive of a file with what belongs to it.
struct Statement {
    build::FilePlace place; ///< its element is the directive
    std::vector<std::string> words;
    std::vector<double> numbers;
    std::vector<Parameter> parameters;

    const std::string& directive() const { return place.element; }
};

} // namespace stromboli::pbrt
