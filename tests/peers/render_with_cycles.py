"""Renders a glTF file with Cycles; run by Blender, or by a Python that has its module bpy
(against_cycles.py says how).

    blender -b -P render_with_cycles.py -- SETTINGS.json
    python3 render_with_cycles.py -- SETTINGS.json

SETTINGS.json: model, environment, width, height, samples, bounces, fov (degrees, of the height), from, at,
matte (true: principled materials scatter diffusely alone), seed, picture (EXR). Writes the picture,
linear, and prints the seconds of processor time that the render took.
"""

import builtins
import json
import math
import sys
import time

import numpy

# The importer of Blender 3.4 uses names that numpy has dropped.
for name in ("bool", "int", "float", "object"):
    if name not in vars(numpy):
        setattr(numpy, name, getattr(builtins, name))

import bpy  # noqa: E402 (numpy first)
import addon_utils  # noqa: E402 (which bpy brings)
import mathutils  # noqa: E402


def in_blender(v):
    """From glTF's axes, y up, to Blender's, z up."""
    return mathutils.Vector((v[0], -v[2], v[1]))


def import_model(settings):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("io_scene_gltf2")
    addon_utils.enable("cycles")
    bpy.ops.import_scene.gltf(filepath=settings["model"])
    for material in bpy.data.materials:
        if not material.use_nodes:
            continue
        if settings["matte"]:
            make_matte(material.node_tree)
        for node in material.node_tree.nodes:
            if node.type == "BSDF_PRINCIPLED":
                node.distribution = "MULTI_GGX"  # keeps the energy of rough facets


def make_matte(tree):
    """Diffuse nodes in the place of principled ones, whose diffuse part is not Lambert's."""
    for node in [n for n in tree.nodes if n.type == "BSDF_PRINCIPLED"]:
        def hand_over(name, to):
            source = node.inputs[name]
            if source.is_linked:
                tree.links.new(source.links[0].from_socket, to)
            else:
                to.default_value = source.default_value
        diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
        hand_over("Base Color", diffuse.inputs["Color"])
        if node.inputs["Normal"].is_linked:
            hand_over("Normal", diffuse.inputs["Normal"])
        emission = tree.nodes.new("ShaderNodeEmission")
        hand_over("Emission Color" if "Emission Color" in node.inputs else "Emission",
                  emission.inputs["Color"])
        hand_over("Emission Strength", emission.inputs["Strength"])
        both = tree.nodes.new("ShaderNodeAddShader")
        tree.links.new(diffuse.outputs["BSDF"], both.inputs[0])
        tree.links.new(emission.outputs["Emission"], both.inputs[1])
        mix = tree.nodes.new("ShaderNodeMixShader")
        hand_over("Alpha", mix.inputs["Fac"])
        tree.links.new(tree.nodes.new("ShaderNodeBsdfTransparent").outputs["BSDF"], mix.inputs[1])
        tree.links.new(both.outputs["Shader"], mix.inputs[2])
        for link in list(node.outputs["BSDF"].links):
            tree.links.new(mix.outputs["Shader"], link.to_socket)
        tree.nodes.remove(node)


def place_camera(scene, settings):
    data = bpy.data.cameras.new("camera")
    camera = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.location = in_blender(settings["from"])
    direction = in_blender(settings["at"]) - in_blender(settings["from"])
    camera.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()
    data.sensor_fit = "VERTICAL"
    data.angle = math.radians(settings["fov"])
    data.clip_start, data.clip_end = direction.length * 1e-3, direction.length * 1e3


def surround(scene, settings):
    """With the environment, whose middle Blender has in another direction than Stromboli."""
    world = bpy.data.worlds.new("world")
    scene.world = world
    world.use_nodes = True
    tree = world.node_tree
    background = tree.nodes.get("Background") or tree.nodes.new("ShaderNodeBackground")
    picture = tree.nodes.new("ShaderNodeTexEnvironment")
    picture.image = bpy.data.images.load(settings["environment"])
    picture.interpolation = "Linear"
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    turn = tree.nodes.new("ShaderNodeMapping")
    turn.inputs["Rotation"].default_value = (0, 0, -math.pi / 2)
    tree.links.new(coordinates.outputs["Generated"], turn.inputs["Vector"])
    tree.links.new(turn.outputs["Vector"], picture.inputs["Vector"])
    tree.links.new(picture.outputs["Color"], background.inputs["Color"])


def render(scene, settings):
    """Without what makes pictures biased: clamping, blurred caustics, lights left out."""
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.seed = settings["seed"]
    cycles.samples = settings["samples"]
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    # Cycles does not count the first scattering.
    bounces = settings["bounces"] - 1
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = bounces
    cycles.transmission_bounces = bounces
    cycles.transparent_max_bounces = 64
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = 0
    cycles.light_sampling_threshold = 0
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1
    scene.render.resolution_x, scene.render.resolution_y = settings["width"], settings["height"]
    scene.render.resolution_percentage = 100
    image = scene.render.image_settings
    image.file_format, image.color_depth, image.exr_codec = "OPEN_EXR", "32", "ZIP"
    scene.view_settings.view_transform = "Raw"
    scene.render.filepath = settings["picture"]
    start = time.process_time()
    bpy.ops.render.render(write_still=True)
    print("RENDER_SECONDS", time.process_time() - start, "with", bpy.app.version_string)


def main():
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as file:
        settings = json.load(file)
    import_model(settings)
    scene = bpy.context.scene
    place_camera(scene, settings)
    surround(scene, settings)
    render(scene, settings)


main()
