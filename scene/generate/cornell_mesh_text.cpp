#include "scene/generate/collada_text.hpp"
#include "scene/generate/cornell_mesh.hpp"

#include <fmt/format.h>

namespace stromboli {

std::string cornellMeshText(const CornellMesh& mesh) {
    std::string effects, materials, geometries, nodes;
    for (const CornellMesh::Surface& s : mesh.surfaces) {
        effects += effectText(s.name, s.albedo, s.emission);
        materials += materialText(s.name);
    }
    for (const CornellMesh::Wall& wall : mesh.walls) {
        geometries += quadText(wall.name, wall.corners, wall.surface);
        nodes += nodeText(wall.name, {wall.surface});
    }

    return fmt::format(R"(<?xml version="1.0" encoding="utf-8"?>
<!-- A gnarled trefoil knot of {0} triangles with smooth normals in a Cornell box of 2 m.
     Plain COLLADA 1.4.1. Written by scene/generate (stromboli_generate_scenes). -->
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset>
    <created>2026-01-01T00:00:00Z</created>
    <modified>2026-01-01T00:00:00Z</modified>
    <unit name="millimeter" meter="{11}"/>
    <up_axis>Y_UP</up_axis>
  </asset>
  <library_cameras>
    <camera id="camera" name="camera"><optics><technique_common><perspective>
      <xfov>{7}</xfov><aspect_ratio>1</aspect_ratio><znear>{8}</znear><zfar>{9}</zfar>
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
        <translate>0 0 {10}</translate>
        <instance_camera url="#camera"/>
      </node>
{5}{6}    </visual_scene>
  </library_visual_scenes>
  <scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
)",
                       mesh.knot.triangleCount(), effects, materials, geometries,
                       geometryText("knot", mesh.knot, 1), nodes,
                       nodeText("knot", {mesh.knotSurface}), mesh.view.fieldOfView,
                       mesh.view.nearDistance, mesh.view.farDistance, mesh.view.distance,
                       CornellMesh::kMetresPerUnit);
}

} // namespace stromboli
