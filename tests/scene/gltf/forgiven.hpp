#pragma once

#include "tests/scene/gltf/gltf_text.hpp"

namespace stromboli::test {

inline GltfText triangle() {
    GltfText g;
    g.addTriangle();
    return g;
}

inline SceneConventions strictly() {
    SceneConventions conventions;
    conventions.strict = true;
    return conventions;
}

/// The file is read with the triangle, one line says what is wrong, which is an error if strict.
inline void expectForgiven(const GltfText& g, const std::string& wrong,
                           const std::string& instead) {
    const Scene scene = load(g);
    EXPECT_EQ(scene.triangles.size(), 1u) << wrong;
    EXPECT_THAT(scene.report.forgiven,
                testing::ElementsAre(
                    testing::AllOf(testing::HasSubstr(wrong), testing::HasSubstr(instead))));
    EXPECT_EQ(problem(g, strictly()), wrong + " (an error because of --strict)");
}

} // namespace stromboli::test
