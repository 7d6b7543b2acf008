#include "scene/generate/cornell_mesh.hpp"

#include "scene/generate/collada_text.hpp"
#include "scene/generate/gnarled_knot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli {

namespace {

constexpr double kHalf = 1000; // of the box's edge, millimetres

struct Wall {
    const char* name;
    const char* material;
    glm::dvec3 corners[4];
};

/// Corners counter-clockwise seen from inside the box; the side z = +kHalf is open.
const Wall kWalls[] = {
    {"floor", "white", {{-1, -1, 1}, {1, -1, 1}, {1, -1, -1}, {-1, -1, -1}}},
    {"ceiling", "white", {{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}},
    {"back", "white", {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}}},
    {"left", "red", {{-1, -1, 1}, {-1, -1, -1}, {-1, 1, -1}, {-1, 1, 1}}},
    {"right", "green", {{1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1}}},
    {"lamp",
     "lamp",
     {{-0.35, 0.99, -0.35}, {0.35, 0.99, -0.35}, {0.35, 0.99, 0.35}, {-0.35, 0.99, 0.35}}},
};

/// Leaning on one edge of its ring, standing on the floor.
StripMesh standingKnot() {
    StripMesh mesh = gnarledKnot(500, 50, "clay");
    const double c = std::cos(1.05), s = std::sin(1.05);
    const auto lean = [&](const glm::dvec3& p) {
        return glm::dvec3(p.x, c * p.y - s * p.z, s * p.y + c * p.z);
    };
    double lowest = 0;
    for (glm::dvec3& p : mesh.positions) {
        p = 0.62 * kHalf * lean(p);
        lowest = std::min(lowest, p.y);
    }
    for (glm::dvec3& p : mesh.positions)
        p.y += -kHalf - lowest;
    for (glm::dvec3& n : mesh.normals)
        n = lean(n);
    return mesh;
}

} // namespace

std::string cornellMeshScene() {
    const StripMesh knot = standingKnot();
    std::string geometries, nodes;
    for (const Wall& wall : kWalls) {
        glm::dvec3 corners[4];
        std::transform(wall.corners, wall.corners + 4, corners,
                       [](const glm::dvec3& p) { return kHalf * p; });
        geometries += quadText(wall.name, corners, wall.material);
        nodes += nodeText(wall.name, {wall.material});
    }
    std::string effects, materials;
    effects += effectText("white", {0.73, 0.73, 0.73}) + effectText("red", {0.62, 0.07, 0.06}) +
               effectText("green", {0.13, 0.44, 0.10}) + effectText("clay", {0.72, 0.52, 0.36}) +
               effectText("lamp", {0, 0, 0}, {12, 11, 9.5});
    for (const char* name : {"white", "red", "green", "clay", "lamp"})
        materials += materialText(name);

    return fmt::format(R"(<?xml version="1.0" encoding="utf-8"?>
<!-- A gnarled trefoil knot of {0} triangles with smooth normals in a Cornell box of 2 m.
     Plain COLLADA 1.4.1. Written by scene/generate (stromboli_generate_scenes). -->
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset>
    <created>2026-01-01T00:00:00Z</created>
    <modified>2026-01-01T00:00:00Z</modified>
    <unit name="millimeter" meter="0.001"/>
    <up_axis>Y_UP</up_axis>
  </asset>
  <library_cameras>
    <camera id="camera" name="camera"><optics><technique_common><perspective>
      <xfov>30</xfov><aspect_ratio>1</aspect_ratio><znear>1</znear><zfar>100000</zfar>
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
        <translate>0 0 5200</translate>
        <instance_camera url="#camera"/>
      </node>
{5}{6}    </visual_scene>
  </library_visual_scenes>
  <scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
)",
                       knot.triangleCount(), effects, materials, geometries,
                       geometryText("knot", knot, 1), nodes, nodeText("knot", {"clay"}));
}

} // namespace stromboli
