#include "host/core/error.hpp"
#include "host/study/study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace stromboli::study {
namespace {

using testing::ElementsAre;

TEST(StudyConfiguration, NamesOfTheTableAreUnique) {
    std::set<std::string> names;
    for (const Configuration& c : knownConfigurations()) {
        EXPECT_TRUE(names.insert(c.name).second) << c.name;
        EXPECT_FALSE(c.what.empty()) << c.name;
        EXPECT_EQ(c.effort.empty(), c.steps.empty()) << c.name;
    }
}

TEST(StudyConfiguration, OnesOwnWithAndWithoutSteps) {
    const auto chosen =
        chooseConfigurations({"default", "four=-l 4 --direct lights", "mine=-a 16 {0.4,0.2} -l 2"});
    ASSERT_EQ(chosen.size(), 3u);
    EXPECT_THAT(optionsAt(chosen[1], 7), ElementsAre("-l", "4", "--direct", "lights"));
    EXPECT_THAT(chosen[2].steps, ElementsAre(0.4, 0.2));
    EXPECT_THAT(optionsAt(chosen[2], 0.2), ElementsAre("-a", "16", "0.2", "-l", "2"));
}

TEST(StudyConfiguration, MistakesAreUserErrors) {
    for (const std::vector<std::string>& wanted :
         std::vector<std::vector<std::string>>{{"nothing"},
                                               {"default", "default"},
                                               {"=-l 4"},
                                               {"a=-a 16 {0.4"},
                                               {"a=-a 16 }0.4{"},
                                               {"a=-a 16 {}"},
                                               {"a=-a 16 {0.4,x}"}})
        EXPECT_THROW(chooseConfigurations(wanted), UsageError) << wanted.back();
}

} // namespace
} // namespace stromboli::study
