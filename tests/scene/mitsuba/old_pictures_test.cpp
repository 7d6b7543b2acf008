// Pictures, relief and grids of Mitsuba 0.x where it shows them otherwise than Mitsuba 3.

#include "scene/model/srgb.hpp"
#include "scene/model/surface_lookup.hpp"
#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stromboli::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// One texel of the channels 200, 100 and 0.
std::string picture(const std::string& name, const std::string& inside = "") {
    return "<texture type=\"bitmap\" name=\"" + name + "\"><string name=\"filename\" value=\"" +
           writePicture("one.tga", 1, 1, {{200, 100, 0, 255}}) + "\"/>" + inside + "</texture>";
}

glm::dvec4 shown(const Scene& scene, const Material& material) {
    return lookUp(scene, material.textures.at(0), {{glm::dvec2(0.5), glm::dvec2(0)}});
}

std::string number(const char* name, double value) {
    return fmt::format("<float name=\"{}\" value=\"{}\"/>", name, value);
}

/// Neither turns normals nor darkens what they say, as Mitsuba 3 does.
TEST(MitsubaOldPictures, ReliefHasNoRulesOfLaterVersions) {
    for (const std::string type : {"bumpmap", "normalmap"}) {
        const std::string relief = "<bsdf type=\"" + type + "\">" + picture("normalmap") +
                                   "<bsdf type=\"diffuse\"/></bsdf>";
        const Material old = loadOld(rectangleOf(relief)).materials.at(0);
        EXPECT_EQ(old.reliefRule, ReliefRule::Blacken) << type;
        EXPECT_FALSE(old.reliefShadows) << type;
        const Material later = loadInside(rectangleOf(relief)).materials.at(0);
        EXPECT_EQ(later.reliefRule, ReliefRule::Flip) << type;
        EXPECT_TRUE(later.reliefShadows) << type;
    }
}

} // namespace
} // namespace stromboli::test
