// docs/hard_cases.md: all cases, numbered in turn, and no test that is not there.
#include "host/stress/case.hpp"
#include "source_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace stromboli::test {
namespace {

const std::filesystem::path kSource = STROMBOLI_SOURCE_DIR;

std::string textOf(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// The lines of the tables, without their heads.
std::vector<std::string> rows() {
    std::vector<std::string> found;
    std::istringstream in(textOf(kSource / "docs/hard_cases.md"));
    for (std::string line; std::getline(in, line);)
        if (line.size() > 2 && line.starts_with("| ") && std::isdigit(line[2]))
            found.push_back(line);
    return found;
}

/// Names of all tests ("Suite.Test" and "Test") and of their suites ("Suite.*").
std::set<std::string> testNames() {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kSource / "tests")) {
        if (entry.path().extension() != ".cpp") continue;
        std::istringstream in(textOf(entry.path()));
        for (std::string line; std::getline(in, line);) {
            if (!line.starts_with("TEST")) continue;
            const size_t open = line.find('('), comma = line.find(", "), close = line.find(')');
            if (close == std::string::npos || comma > close) continue;
            const std::string suite = line.substr(open + 1, comma - open - 1);
            const std::string test = line.substr(comma + 2, close - comma - 2);
            names.insert({test, suite + "." + test, suite + ".*"});
        }
    }
    for (const stress::Case& c : stress::allCases())
        names.insert(c.name);
    return names;
}

TEST(HardCaseList, HasAllCases) {
    std::set<int> numbers;
    for (const std::string& row : rows()) {
        std::istringstream cell(row.substr(2, row.find(" |", 2) - 2));
        for (std::string number; std::getline(cell, number, ',');)
            numbers.insert(std::stoi(number));
    }
    EXPECT_GE(numbers.size(), 83u);
    EXPECT_EQ(*numbers.begin(), 1);
    EXPECT_EQ(size_t(*numbers.rbegin()), numbers.size());
}

TEST(HardCaseList, NamesTestsThatAreThere) {
    const std::set<std::string> there = testNames();
    size_t named = 0;
    for (const std::string& row : rows()) {
        std::istringstream in(row);
        std::string outside, name;
        while (std::getline(in, outside, '`') && std::getline(in, name, '`')) {
            if (name.ends_with("...")) continue; // "and others of this beginning"
            ++named;
            EXPECT_TRUE(there.contains(name)) << name << " in " << row;
        }
    }
    EXPECT_GT(named, 100u);
}

} // namespace
} // namespace stromboli::test
