#pragma once

#include <cctype>
#include <cmath>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace stromboli::test {

/// The text as the name of a test, which letters, digits and underscores make: "1e-12" is
/// "1e_minus12", "cornell_box.dae" is "cornell_box_dae".
inline std::string testName(std::string_view text) {
    std::string name;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (std::isalnum(static_cast<unsigned char>(c)))
            name += c;
        else if (c == '-')
            name += i == 0 ? "minus" : "_minus";
        else if (c != '+' && c != '"' && !name.empty() && name.back() != '_')
            name += '_';
    }
    while (name.ends_with('_'))
        name.pop_back();
    return name;
}

/// Names the tests of a suite by what GoogleTest prints of their parameters.
struct NamedByValue {
    template <class Info>
    std::string operator()(const Info& one) const {
        return testName(testing::PrintToString(one.param));
    }
};

} // namespace stromboli::test
