// Damaged scenes: an error or a scene, never a crash.

#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <random>

namespace stromboli::test {
namespace {

const char* const kScene = R"(<scene version="3.0.0">
<default name="d" value="3"/>
<integrator type="path"><integer name="max_depth" value="$d"/></integrator>
<sensor type="perspective"><float name="fov" value="40"/>
<transform name="to_world"><lookat origin="0,0,5" target="0,0,0" up="0,1,0"/></transform>
<film type="hdrfilm"><integer name="width" value="8"/><rfilter type="box"/></film></sensor>
<bsdf type="diffuse" id="m"><rgb name="reflectance" value="0.2 0.5 1"/></bsdf>
<bsdf type="mask" id="k"><float name="opacity" value="0.5"/><ref id="m"/></bsdf>
<shape type="rectangle"><ref id="k"/><emitter type="area"><spectrum name="radiance"
 value="400:0, 500:8"/></emitter></shape>
<shape type="shapegroup" id="g"><shape type="cube"><bsdf type="roughconductor">
<string name="material" value="Au"/></bsdf></shape></shape>
<shape type="instance"><ref id="g"/><transform name="to_world"><scale value="2"/></transform></shape>
<emitter type="point"><rgb name="intensity" value="1"/></emitter></scene>
)";

TEST(MitsubaMutations, NeverCrash) {
    ASSERT_EQ(problemOf(kScene), "");
    std::mt19937 random(1);
    const std::string original = kScene;
    size_t loaded = 0, shown = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string text = original;
        for (uint64_t changes = 1 + random() % 3; changes > 0; --changes) {
            const size_t at = random() % text.size();
            const size_t length = std::min<size_t>(random() % 12, text.size() - at);
            switch (random() % 4) {
            case 0:
                text[at] = char(random() % 128);
                break;
            case 1:
                text.erase(at, length);
                break;
            case 2:
                text.insert(at, original, random() % original.size(), length);
                break;
            default: // another digit
                if (const size_t digit = text.find_first_of("0123456789", at);
                    digit != std::string::npos)
                    text[digit] = "0123456789-.e$"[random() % 14];
            }
            if (text.empty()) text = " ";
        }
        loaded += problemOf(text).empty() ? 1 : 0;
        try {
            loadText(text); // whatever can be shown of it
            ++shown;
        } catch (const SceneError&) {
        }
    }
    EXPECT_GT(loaded, 50u);
    EXPECT_GT(shown, loaded);
}

} // namespace
} // namespace stromboli::test
