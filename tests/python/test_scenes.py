"""Scenes made in memory, against closed forms, on the reference: no device is needed."""

import inspect
import math
import os
import re

import numpy as np
import pytest

import stromboli
from stromboli import _stromboli

PLANE = [(-9, 0, -9), (-9, 0, 9), (9, 0, 9), (9, 0, -9)]
QUAD = [(0, 1, 2), (0, 2, 3)]


@pytest.fixture(scope="module")
def reference():
    return stromboli.Session(backend="reference", threads=1)


@pytest.fixture
def builder():
    return stromboli.SceneBuilder("test")


def value(reference, builder, **settings):
    """Of the only pixel of a picture whose bounces find the sky: without noise where it is even."""
    settings = {"samples": 8, "width": 1, "height": 1, "direct": "bsdf", **settings}
    return np.asarray(reference.render(builder.finish(), **settings))[0, 0]


def plane_from_aside(builder, albedo=0.8):
    """A floor, seen at the origin in a pixel so small that it is one point."""
    builder.mesh(PLANE, QUAD, builder.material("diffuse", albedo=albedo))
    builder.camera((3, 4, 0), (0, 0, 0), fov=1e-3)


def test_a_sphere_in_a_furnace_has_its_albedo(reference, builder):
    builder.sphere((0, 0, 0), 1, builder.material("diffuse", albedo=(1, 0.5, 0.25)))
    builder.environment(2)
    builder.camera((0, 0, 4), (0, 0, 0), fov=10)
    assert value(reference, builder) == pytest.approx([2, 1, 0.5], rel=1e-6)


def test_irradiance_of_delta_lights(reference, builder):
    # A point light above: intensity / distance squared; directional: as it is said.
    for light, irradiance in [
        ({"kind": "point", "color": (8, 4, 2), "position": (0, 2, 0)}, (2, 1, 0.5)),
        ({"kind": "directional", "color": (3, 2, 1), "direction": (0, -5, 0)}, (3, 2, 1)),
        ({"kind": "directional", "color": 1, "direction": (0, -1, 1)}, (math.sqrt(0.5),) * 3),
        ({"kind": "spot", "color": 4, "position": (0, 2, 0), "angle": 60}, (1, 1, 1)),
        ({"kind": "spot", "color": 4, "position": (3, 2, 0), "angle": 60}, (0, 0, 0)),
    ]:
        plane_from_aside(builder)
        builder.light(**light)
        expected = np.array(irradiance) * 0.8 / math.pi
        assert value(reference, builder) == pytest.approx(expected, rel=1e-5), light


def test_radiance_of_lights_that_fill_the_sky_or_are_seen(reference, builder):
    plane_from_aside(builder)
    builder.light("ambient", color=(1, 2, 3))
    assert value(reference, builder) == pytest.approx([0.8, 1.6, 2.4], rel=1e-5)
    # An area light is seen from its front as its radiance, and is black from behind.
    for height, expected in [(-1, 5), (4, 0)]:
        builder.light("area", color=5, position=(0, 2, 0), direction=(0, -1, 0), size=(2, 2))
        builder.camera((0, height, 0), (0, 2, 0), up=(0, 0, 1), fov=1)
        assert value(reference, builder) == pytest.approx([expected] * 3)


def test_a_texture_begins_at_the_upper_left(reference, builder):
    texels = np.array([[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [255, 255, 255]]], np.uint8)
    for uv, expected in [((0, 0), (1, 0, 0)), ((1, 0), (0, 1, 0)), ((0, 1), (0, 0, 1))]:
        material = builder.material("diffuse", albedo=1)
        builder.use_texture(material, "base_color", builder.texture(texels.repeat(8, 0).repeat(8, 1)))
        # All of the floor has the colour of one place in the picture.
        place = 0.25 + 0.5 * np.array(uv)
        builder.mesh(PLANE, QUAD, material, uvs=np.broadcast_to(place, (4, 2)))
        builder.camera((3, 4, 0), (0, 0, 0), fov=1e-3)
        builder.environment(1)
        assert value(reference, builder) == pytest.approx(expected, abs=1e-5)


def test_a_texture_of_floats_is_linear_and_may_be_brighter_than_1(reference, builder):
    texels = np.empty((4, 4, 3), np.float32)
    texels[:] = (3.5, 0.25, 0.125)
    material = builder.material("diffuse", albedo=0, emission=2)
    builder.use_texture(material, "emission", builder.texture(texels))
    builder.mesh(PLANE, QUAD, material, uvs=np.zeros((4, 2)))
    builder.camera((3, 4, 0), (0, 0, 0), fov=1e-3)
    assert value(reference, builder) == pytest.approx([7, 0.5, 0.25])


def test_a_transform_moves_a_mesh(reference, builder):
    matrix = np.eye(4)
    matrix[:3, 3] = (0, 1.5, 0)  # the floor is lifted
    matrix[0, 0] = 2
    builder.mesh(PLANE, QUAD, builder.material(), transform=matrix)
    builder.environment(1)
    builder.camera((0, 4, 0), (0, 0, 0), up=(0, 0, -1), fov=1e-3)
    scene = builder.finish()
    low, high = scene.bounds
    assert low == (-18, 1.5, -9) and high == (18, 1.5, 9)
    picture = reference.render(scene, samples=1, width=1, height=1, layers=["depth", "normal"])
    assert picture.layers["depth"][0, 0] == pytest.approx(2.5)
    assert picture.layers["normal"][0, 0] == pytest.approx([0, 1, 0], abs=1e-6)


def test_normals_of_vertices_are_shaded_with(reference, builder):
    tilted = np.array([1, 2, 0]) / math.sqrt(5)
    builder.mesh(PLANE, QUAD, builder.material(), normals=np.broadcast_to(tilted, (4, 3)))
    builder.environment(1)
    builder.camera((0, 4, 0), (0, 0, 0), up=(0, 0, -1), fov=1e-3)
    picture = reference.render(builder.finish(), samples=1, width=1, height=1, layers="normal")
    assert picture.layers["normal"][0, 0] == pytest.approx(tilted, abs=1e-3)


def test_an_environment_is_turned_as_it_says(reference, builder):
    # Light from +x alone: three quarters of the width.
    radiance = np.zeros((16, 64, 3))
    radiance[:, 40:56] = 7
    for rotation, direction in [(0, (1, 0, 0)), (90, (0, 0, -1)), (180, (-1, 0, 0))]:
        builder.sphere((0, -50, 0), 1, builder.material())
        builder.environment(radiance, rotation=rotation)
        builder.camera((0, 0, 0), direction, fov=1)
        assert value(reference, builder) == pytest.approx([7] * 3), direction


def test_triangles_that_cannot_be_are_left_out_and_said(builder, caplog):
    positions = [*PLANE, (math.nan, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)]
    triangles = [*QUAD, (0, 1, 4), (5, 6, 7)]
    builder.mesh(positions, triangles, builder.material())
    scene = builder.finish()
    assert scene.triangle_count == 2
    (line,) = scene.report["warnings"]
    assert "2 of 4 triangles left out: 1 of zero area, 1 not finite" in line
    assert [record.message for record in caplog.records if record.levelname == "WARNING"] == [line]


def test_every_parameter_of_every_kind_is_taken(builder):
    for kind in stromboli.material_kinds():
        number = builder.material(kind, name=kind)
        builder.sphere((2 * number, 0, 0), 0.5, number)
    builder.environment(1)
    for material in builder.finish().materials:
        kind = material["kind"]
        if material["name"] != kind:
            continue  # the default one
        parameters = {k: v for k, v in material.items() if k not in ("name", "kind")}
        assert parameters.keys() == stromboli.material_parameters(kind).keys()
        again = stromboli.SceneBuilder()
        again.sphere((0, 0, 0), 1, again.material(kind, **parameters))
        made = again.finish().materials[0]
        assert {k: made[k] for k in parameters} == parameters


def test_what_is_wrong_is_said(builder):
    material = builder.material()
    for call, message in [
        (lambda: builder.mesh(PLANE, [(0, 1, 4)], material), "names vertex 4 of 4"),
        (lambda: builder.mesh(PLANE, QUAD, 7), "no material 7"),
        (lambda: builder.mesh(PLANE, QUAD, material, normals=[(0, 1, 0)]), "as many normals"),
        (lambda: builder.mesh(PLANE, QUAD, material, uvs=[(0, 1)]), "as many texture"),
        (lambda: builder.mesh(PLANE, QUAD, material, transform=np.full((4, 4), np.nan)), "finite"),
        (lambda: builder.sphere((0, 0, 0), 0, material), "radius"),
        (lambda: builder.sphere((0, math.inf, 0), 1, material), "not finite"),
        (lambda: builder.material("wood"), "expected one of diffuse, mirror"),
        (lambda: builder.material("diffuse", albedo=1.5), "from 0 to 1"),
        (lambda: builder.material("diffuse", albedo=(1, 1)), "3 numbers"),
        (lambda: builder.material("diffuse", colour=1), "expected one of emission"),
        (lambda: builder.light("sun"), "expected directional, point"),
        (lambda: builder.light("point", color=-1), "from 0 on"),
        (lambda: builder.light("spot", angle=200), "angle of a spot"),
        (lambda: builder.camera((0, 0, 0), (0, 0, 0)), "where it is"),
        (lambda: builder.camera((0, 0, 0), (0, 0, 1), fov=180), "fov"),
        (lambda: builder.environment(-1), "not negative"),
        (lambda: builder.use_texture(material, "base_color", 3), "no texture 3"),
        (lambda: stromboli.load("room.xml", environment_strength=-1), "environment_strength"),
    ]:
        with pytest.raises(stromboli.UsageError, match=message):
            call()
    with pytest.raises(TypeError):
        builder.mesh(PLANE, [(0, 1, -1)], material)
    with pytest.raises(TypeError):
        builder.texture(np.zeros((2, 2, 3), int))
    with pytest.raises(stromboli.UsageError, match="from -65504 to 65504"):
        builder.texture(np.full((2, 2, 3), np.nan))


def test_loading(reference, tmp_path):
    scene = stromboli.load("light_point", environment=(1, 2, 3), default_light=False)
    assert scene.triangle_count > 0 and scene.materials and "light_point" in repr(scene)
    assert scene.file.startswith(stromboli.__path__[0])  # the scenes that are installed with it
    with pytest.raises(stromboli.SceneError, match="no_such_scene"):
        stromboli.load("no_such_scene")
    broken = tmp_path / "broken.xml"
    broken.write_text("<scene version='3.0.0'><shape type='sphere'>")
    with pytest.raises(stromboli.SceneError, match="broken.xml"):
        stromboli.load(broken)
    (tmp_path / "empty.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n")
    scene = stromboli.load(tmp_path / "empty.obj")
    assert any("9" in line for lines in scene.report.values() for line in lines)
    with pytest.raises(stromboli.SceneError):
        stromboli.load(tmp_path / "empty.obj", strict=True)
    with pytest.raises(stromboli.UsageError, match="no material 'gold'"):
        scene.number_of("material", "gold")


def test_the_documents_have_all_names():
    folder = os.path.join(os.environ["STROMBOLI_EXAMPLES"], "..", "docs", "guide")
    with open(os.path.join(folder, "library.md"), encoding="utf-8") as file:
        settings, rest = file.read().split("## Settings")[1].split("## Reading a scene")
    reading, materials = rest.split("## Materials")
    for text, names in [(settings, stromboli.settings()), (reading, _stromboli.reading_settings())]:
        rows = re.findall(r"^\| `(\w+)` \| (.*) \|$", text, re.M)
        assert len(rows) == len(names) and dict(rows) == names
    for kind, parameters in re.findall(r"^\| `(\w+)` \|[^|]*\|(.*)\|$", materials, re.M):
        named = set(re.findall(r"`(\w+)`", parameters)) | {"emission", "emits_both_sides"}
        assert named == stromboli.material_parameters(kind).keys(), kind
    assert all(f"| `{kind}` |" in materials for kind in stromboli.material_kinds())
    # And the keywords of render() are the settings, with those of devices.
    keywords = set(inspect.signature(stromboli.render).parameters) - {"scene", "progress"}
    assert keywords == set(stromboli.settings()) | set(_stromboli.device_settings())
    loads = set(inspect.signature(stromboli.load).parameters) - {"source"}
    assert loads == set(_stromboli.reading_settings())
