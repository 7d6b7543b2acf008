#include "scene/generate/island.hpp"

#include "scene/generate/collada_text.hpp"
#include "scene/generate/terrain.hpp"

#include <fmt/format.h>

namespace stromboli {

std::string islandScene() {
    const StripMesh island = volcanoIsland(322);
    const glm::dvec3 sea[4] = {
        {-15000, -15000, 0}, {15000, -15000, 0}, {15000, 15000, 0}, {-15000, 15000, 0}};
    const std::string effects =
        effectText("ash", {0.27, 0.22, 0.19}) + effectText("beach", {0.34, 0.30, 0.25}) +
        effectText("rock", {0.20, 0.16, 0.13}) + effectText("scar", {0.10, 0.09, 0.09}) +
        effectText("scrub", {0.13, 0.17, 0.06}) + effectText("water", {0.03, 0.08, 0.13});
    std::string materials;
    for (const char* name : {"ash", "beach", "rock", "scar", "scrub", "water"})
        materials += materialText(name);
    std::vector<std::string> islandMaterials;
    for (const auto& [material, strips] : island.strips)
        islandMaterials.push_back(material);

    return fmt::format(R"(<?xml version="1.0" encoding="utf-8"?>
<!-- A volcano's island of {0} triangles under the sun and a blue sky: a directional and an
     ambient light. Plain COLLADA 1.4.1. Written by scene/generate (stromboli_generate_scenes). -->
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset>
    <created>2026-01-01T00:00:00Z</created>
    <modified>2026-01-01T00:00:00Z</modified>
    <unit name="meter" meter="1"/>
    <up_axis>Z_UP</up_axis>
  </asset>
  <library_lights>
    <light id="sun" name="sun"><technique_common><directional>
      <color>5.2 4.7 4.0</color>
    </directional></technique_common></light>
    <light id="sky" name="sky"><technique_common><ambient>
      <color>0.45 0.6 0.85</color>
    </ambient></technique_common></light>
  </library_lights>
  <library_cameras>
    <camera id="camera" name="camera"><optics><technique_common><perspective>
      <xfov>36</xfov><aspect_ratio>1.777778</aspect_ratio><znear>1</znear><zfar>50000</zfar>
    </perspective></technique_common></optics></camera>
  </library_cameras>
  <library_effects>
{1}  </library_effects>
  <library_materials>
{2}  </library_materials>
  <library_geometries>
{3}{4}  </library_geometries>
  <library_visual_scenes>
    <visual_scene id="scene">
      <node id="camera-node" name="camera">
        <lookat>1700 -3500 2150  60 -80 190  0 0 1</lookat>
        <instance_camera url="#camera"/>
      </node>
      <node id="sun-node" name="sun">
        <!-- Shines down the node's -z axis: tilted 55 degrees off the vertical, then turned. -->
        <rotate>0 0 1 40</rotate>
        <rotate>0 1 0 55</rotate>
        <instance_light url="#sun"/>
      </node>
      <node id="sky-node" name="sky"><instance_light url="#sky"/></node>
{5}{6}    </visual_scene>
  </library_visual_scenes>
  <scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
)",
                       island.triangleCount(), effects, materials, quadText("sea", sea, "water"),
                       geometryText("island", island, 1), nodeText("sea", {"water"}),
                       nodeText("island", islandMaterials));
}

} // namespace stromboli
