#!/usr/bin/env python3
"""pbrt_plugins.py PROGRAM [NAME...]: small scenes of pbrt-v4 by this program, and their equivalents by Mitsuba 3.

pbrt itself is at hand nowhere. What its manual and its book say of a material, light, shape or camera is stated here for
Mitsuba by hand, with meshes and pictures made for it where it has no such thing: so this file holds pbrt's rules a second
time. Shown is what mitsuba_plugins.py shows, with the same limits. Needs Mitsuba's Python module; by hand.
"""

import mitsuba as mi
import mitsuba_plugins as plugins
import numpy as np
import pbrt_plugin_files as files
from mitsuba_plugins import LAMP, bsdf, light, num, rgb, shape, word, world
from pbrt_plugin_files import bilinear, grid, sphere_part, turned

HEAD = """
Scale -1 1 1
LookAt 0 2.5 6  0 0.6 0  0 1 0
{camera}
Film "rgb" "integer xresolution" 64 "integer yresolution" 48 "string filename" "x.exr" {film}
PixelFilter "box"
Integrator "volpath" "integer maxdepth" 5
WorldBegin
"""
FLOOR = """
AttributeBegin
Material "diffuse" "rgb reflectance" [ 0.5 0.45 0.4 ]
Shape "trianglemesh" "point3 P" [ -4 0 4  4 0 4  4 0 -4  -4 0 -4 ] "integer indices" [ 0 1 2 0 2 3 ]
AttributeEnd
"""
LAMP4 = """
AttributeBegin
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
AreaLightSource "diffuse" "rgb L" [ 12 11 10 ]
Shape "bilinearmesh" "point3 P" [ 0.2 4 0.2  1.8 4 0.2  0.2 4 1.8  1.8 4 1.8 ]
AttributeEnd
"""
SKY4 = 'LightSource "infinite" "rgb L" [ 0.4 0.5 0.6 ]\n'
SKY = f'<emitter type="constant">{rgb("radiance", "0.4,0.5,0.6")}</emitter>'
CAMERA4 = 'Camera "perspective" "float fov" 32'
FOV = num("fov", 32) + word("fov_axis", "smaller")


def scene4(body, lights=LAMP4 + SKY4, camera=CAMERA4, film="", floor=FLOOR):
    return HEAD.format(camera=camera, film=film) + lights + floor + body


def scene3(body, lights=LAMP + SKY, view=None, integrator="path"):
    return plugins.scene(body, lights, view or plugins.camera(inside=FOV), integrator=integrator)


def ball4(material, more="", kind="sphere"):
    return f'AttributeBegin\nTranslate 0 1 0\n{material}\nShape "{kind}" {more}\nAttributeEnd\n'


def two(inside):
    return bsdf("twosided", inside)


DIFFUSE4 = 'Material "diffuse"'
GREY = two(bsdf("diffuse"))


def rough(kind, alpha, more=""):
    alphas = num("alpha", alpha) if np.isscalar(alpha) else num("alpha_u", alpha[0]) + num("alpha_v", alpha[1])
    return bsdf(kind, word("distribution", "ggx") + alphas + more)


def metal(reflected):
    """Index and extinction of pbrt's `reflectance`."""
    k = [2 * np.sqrt(r) / np.sqrt(1 - r) for r in reflected]
    return rgb("eta", "1,1,1") + rgb("k", ",".join(map(str, k)))


def materials():
    """Name, pbrt's material, Mitsuba's."""
    yield "diffuse", 'Material "diffuse" "rgb reflectance" [ 0.8 0.1 0.3 ]', two(bsdf("diffuse", rgb("reflectance", "0.8,0.1,0.3")))
    yield "conductor", 'Material "conductor"', two(bsdf("conductor", word("material", "Cu")))
    for name in ("Ag", "Al", "Au", "CuZn", "MgO", "TiO2"):
        ours = f'Material "conductor" "spectrum eta" "metal-{name}-eta" "spectrum k" "metal-{name}-k" "float roughness" 0.09'
        theirs = {"CuZn": rgb("eta", "0.444,0.527,1.094") + rgb("k", "3.695,2.765,1.829")}
        yield "conductor_" + name, ours, two(rough("roughconductor", 0.3, theirs.get(name, word("material", name))))
    yield "conductor_reflectance", 'Material "conductor" "rgb reflectance" [ 0.9 0.5 0.2 ]', two(bsdf("conductor", metal((0.9, 0.5, 0.2))))
    gold = '"spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k"'
    unmapped = f'Material "conductor" {gold} "bool remaproughness" false "float roughness" 0.2'
    yield "conductor_unmapped", unmapped, two(rough("roughconductor", 0.2, word("material", "Au")))
    grain = f'Material "conductor" {gold} "float uroughness" 0.01 "float vroughness" 0.16'
    yield "conductor_grain", grain, two(rough("roughconductor", (0.1, 0.4), word("material", "Au")))
    yield "dielectric", 'Material "dielectric"', bsdf("dielectric", num("int_ior", 1.5) + num("ext_ior", 1))
    glass = num("int_ior", 1.5168) + num("ext_ior", 1)
    yield "dielectric_named", 'Material "dielectric" "spectrum eta" "glass-BK7" "float roughness" 0.04', rough("roughdielectric", 0.2, glass)
    water = num("int_ior", 1.33) + num("ext_ior", 1)
    yield "dielectric_unmapped", 'Material "dielectric" "float eta" 1.33 "float roughness" 0.3 "bool remaproughness" false', rough("roughdielectric", 0.3, water)
    yield "thindielectric", 'Material "thindielectric" "float eta" 1.33', bsdf("thindielectric", water)
    clear = 'Material "coateddiffuse" "float thickness" 0 "integer maxdepth" 1000 "rgb reflectance" [ 0.1 0.3 0.6 ]'
    plastic = rgb("diffuse_reflectance", "0.1,0.3,0.6") + '<boolean name="nonlinear" value="true"/>' + num("int_ior", 1.5) + num("ext_ior", 1)
    yield "coateddiffuse", clear, two(bsdf("plastic", plastic))
    yield "coateddiffuse_rough", clear + ' "float roughness" 0.09', two(rough("roughplastic", 0.3, plastic))
    named = 'MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [ 0.8 0.1 0.1 ]\n'
    named += f'MakeNamedMaterial "gold" "string type" "conductor" {gold} "float roughness" 0.04\n'
    red = bsdf("diffuse", rgb("reflectance", "0.8,0.1,0.1"))
    mixed = bsdf("blendbsdf", num("weight", 0.3) + red + rough("roughconductor", 0.2, word("material", "Au")))
    yield "mix", named + 'Material "mix" "string materials" [ "red" "gold" ] "float amount" 0.3', two(mixed)
    grey = 'Material "diffuse" "spectrum reflectance" [ 300 0.3 900 0.3 ]'
    yield "spectrum", grey, two(bsdf("diffuse", rgb("reflectance", "0.3,0.3,0.3")))


# A wall that faces the camera, its coordinates u to the right and v up.
WALL4 = """
AttributeBegin
{}
Shape "trianglemesh" "point3 P" [ -1.2 0.2 0  1.2 0.2 0  1.2 2.2 0  -1.2 2.2 0 ] "integer indices" [ 0 1 2 0 2 3 ]
"point2 uv" [ 0 0 1 0 1 1 0 1 ] {}
AttributeEnd
"""


def wall(material):
    """A mesh of a file: of those and their pictures both, Mitsuba turns v upside down."""
    return shape("obj", word("filename", "wall.obj") + material)


# Reliefs as pbrt has them, without what Mitsuba does where they hide themselves.
PLAIN = '<boolean name="flip_invalid_normals" value="false"/><boolean name="use_shadowing_function" value="false"/>'


def to_uv(steps):
    flip = '<scale y="-1"/><translate y="1"/>'
    return f'<transform name="to_uv">{flip}{steps}{flip}</transform>'


def texture(kind, inside, sort="spectrum"):
    return f'Texture "t" "{sort}" "{kind}" {inside}\n'


def file_of(name, more="", raw=True):
    inside = word("filename", name) + f'<boolean name="raw" value="{str(raw).lower()}"/>' + more
    return f'<texture type="bitmap" name="reflectance">{inside}</texture>'


def textures():
    """Name, what stands before the wall of pbrt, Mitsuba's material, what the wall states more."""
    shown = 'Material "diffuse" "texture reflectance" "t"'
    tiles = '"string filename" "tiles.exr"'
    yield "imagemap", texture("imagemap", tiles) + shown, two(bsdf("diffuse", file_of("tiles.exr"))), ""
    srgb = texture("imagemap", '"string filename" "tiles.png"') + shown
    yield "imagemap_srgb", srgb, two(bsdf("diffuse", file_of("tiles.png", raw=False))), ""
    linear = texture("imagemap", '"string filename" "tiles.png" "string encoding" "linear"') + shown
    yield "imagemap_linear", linear, two(bsdf("diffuse", file_of("tiles.png"))), ""
    gamma = texture("imagemap", '"string filename" "tiles.png" "string encoding" "gamma 2"') + shown
    yield "imagemap_gamma", gamma, two(bsdf("diffuse", file_of("squared.exr"))), ""
    ignored = texture("imagemap", tiles + ' "string encoding" "gamma 2"') + shown
    yield "imagemap_gamma_exr", ignored, two(bsdf("diffuse", file_of("tiles.exr"))), ""
    turned = texture("imagemap", tiles + ' "bool invert" true "float scale" 0.5') + shown
    yield "imagemap_invert", turned, two(bsdf("diffuse", file_of("inverted.exr"))), ""
    placed = '"float uscale" 3 "float vscale" 2 "float udelta" 0.25 "float vdelta" 0.1'
    moved = to_uv('<scale x="3" y="2"/><translate x="0.25" y="0.1"/>')
    yield "imagemap_placed", texture("imagemap", tiles + placed) + shown, two(bsdf("diffuse", file_of("tiles.exr", moved))), ""
    clamped = texture("imagemap", tiles + placed + ' "string wrap" "clamp"') + shown
    yield "imagemap_clamp", clamped, two(bsdf("diffuse", file_of("tiles.exr", moved + word("wrap_mode", "clamp")))), ""
    nearest = texture("imagemap", tiles + ' "string filter" "point"') + shown
    yield "imagemap_point", nearest, two(bsdf("diffuse", file_of("tiles.exr", word("filter_type", "nearest")))), ""
    board = texture("checkerboard", '"rgb tex1" [ 0.8 0.1 0.1 ] "rgb tex2" [ 0.1 0.1 0.7 ] "float uscale" 8 "float vscale" 4') + shown
    colors = rgb("color1", "0.8,0.1,0.1") + rgb("color0", "0.1,0.1,0.7")  # v is upside down, of four rows
    to_cells = '<transform name="to_uv"><scale x="4" y="2"/></transform>'
    yield "checkerboard", board, two(bsdf("diffuse", f'<texture type="checkerboard" name="reflectance">{colors}{to_cells}</texture>')), ""
    scaled = 'Texture "a" "spectrum" "imagemap" ' + tiles + "\n" + texture("scale", '"texture tex" "a" "float scale" 0.5') + shown
    yield "scale", scaled, two(bsdf("diffuse", file_of("halved.exr"))), ""
    ramp = texture("bilerp", '"rgb v00" [ 0 0 0 ] "rgb v01" [ 0 0.8 0 ] "rgb v10" [ 0.8 0 0 ] "rgb v11" [ 0.8 0.8 0 ]') + shown
    yield "bilerp", ramp, two(bsdf("diffuse", file_of("ramp.exr"))), ""
    mixed = 'Texture "m" "float" "bilerp" "float v00" 0 "float v01" 0 "float v10" 1 "float v11" 1\n'
    mixed += texture("mix", '"rgb tex1" [ 0 0.8 0 ] "rgb tex2" [ 0.8 0 0 ] "texture amount" "m"') + shown
    yield "mix_texture", mixed, two(bsdf("diffuse", file_of("mixed.exr"))), ""
    pictures = 'Texture "a" "spectrum" "imagemap" "float uscale" 2 ' + tiles + "\n"
    pictures += 'Texture "b" "spectrum" "imagemap" "string filename" "ramp.exr" "float uscale" 3 "float vdelta" 0.2\n'
    pictures += 'Texture "n" "float" "imagemap" "string filename" "soft.exr" "float scale" 3\n'
    for name, stated in (
        ("scale_pictures", texture("scale", '"texture tex" "a" "texture scale" "n"')),
        ("mix_pictures", texture("mix", '"texture tex1" "a" "texture tex2" "b" "texture amount" "n"')),
        ("checkerboard_pictures", texture("checkerboard", '"texture tex1" "a" "texture tex2" "b" "float uscale" 4 "float vscale" 3')),
    ):
        yield name, pictures + stated + shown, two(bsdf("diffuse", file_of(name + ".exr"))), ""
    plane = "AttributeBegin\nTranslate 0.3 0.4 0\nRotate 20 0 0 1\nScale 2 1 1\n"
    plane += texture("imagemap", tiles + ' "string mapping" "planar" "vector3 v1" [ 1 0 0 ] "vector3 v2" [ 0 0.5 0 ]') + "AttributeEnd\n" + shown
    uv = '<translate x="-0.5" y="-0.5"/><scale x="2.4" y="2"/><translate y="1.2"/>'  # of the wall's places
    uv += '<translate x="-0.3" y="-0.4"/><rotate z="1" angle="-20"/><scale x="0.5"/><scale y="0.5"/>'
    yield "planar", plane, two(bsdf("diffuse", file_of("tiles.exr", to_uv(uv)))), ""
    half = '<float name="opacity" value="0.4"/>'
    yield "alpha", DIFFUSE4, bsdf("mask", half + GREY), '"float alpha" 0.4'
    holes = texture("imagemap", '"string filename" "grey.exr"', "float") + DIFFUSE4
    yield "alpha_picture", holes, bsdf("mask", file_of("grey.exr").replace("reflectance", "opacity") + GREY), '"texture alpha" "t"'
    relief = 'Material "diffuse" "string normalmap" "normals.exr"'
    yield "normalmap", relief, two(bsdf("normalmap", file_of("normals.exr").replace("reflectance", "normalmap") + PLAIN + bsdf("diffuse"))), ""
    bumps = texture("imagemap", '"string filename" "waves.exr" "float scale" 0.1', "float") + 'Material "diffuse" "texture displacement" "t"'
    heights = file_of("waves.exr").replace("reflectance", "height") + num("scale", 0.1) + PLAIN + bsdf("diffuse")
    yield "displacement", bumps, two(bsdf("bumpmap", heights)), ""
    scaled = 'Texture "h" "float" "imagemap" "string filename" "waves.exr"\n' + texture("scale", '"texture tex" "h" "float scale" 0.1', "float")
    yield "displacement_scaled", scaled + 'Material "diffuse" "texture displacement" "t"', two(bsdf("bumpmap", heights)), ""
    named = 'MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [ 0.8 0.1 0.1 ]\n'
    named += 'MakeNamedMaterial "metal" "string type" "conductor" "float roughness" 0.04\n'
    named += texture("imagemap", '"string filename" "grey.exr"', "float") + 'Material "mix" "string materials" [ "red" "metal" ] "texture amount" "t"'
    red = bsdf("diffuse", rgb("reflectance", "0.8,0.1,0.1"))
    weights = file_of("grey.exr").replace("reflectance", "weight")
    yield "mix_amount", named, two(bsdf("blendbsdf", weights + red + rough("roughconductor", 0.2, word("material", "Cu")))), ""
    coated = texture("imagemap", tiles) + 'Material "coateddiffuse" "texture reflectance" "t" "float thickness" 0 "integer maxdepth" 1000 "float roughness" 0.09'
    plastic = file_of("tiles.exr").replace("reflectance", "diffuse_reflectance") + '<boolean name="nonlinear" value="true"/>'
    yield "coateddiffuse_picture", coated, two(rough("roughplastic", 0.3, plastic + num("int_ior", 1.5) + num("ext_ior", 1))), ""
    frosted = texture("imagemap", '"string filename" "soft.exr"', "float") + 'Material "dielectric" "texture roughness" "t"'
    alphas = file_of("roots.exr").replace("reflectance", "alpha") + word("distribution", "ggx") + num("int_ior", 1.5) + num("ext_ior", 1)
    yield "dielectric_picture", frosted, bsdf("roughdielectric", alphas), ""
    roughness = texture("imagemap", '"string filename" "soft.exr"', "float") + 'Material "conductor" "texture roughness" "t"'
    alphas = file_of("roots.exr").replace("reflectance", "alpha") + word("material", "Cu") + word("distribution", "ggx")
    yield "roughness_picture", roughness, two(bsdf("roughconductor", alphas)), ""


SHAPES = {
    # Name: pbrt's parameters, the surface for Mitsuba.
    "sphere_part": ('"sphere" "float zmin" -0.5 "float zmax" 0.8 "float phimax" 250', turned(lambda v: np.sin(sphere_part(v)), lambda v: np.cos(sphere_part(v)), 250)),
    "cylinder": ('"cylinder" "float radius" 0.6 "float zmin" -0.4 "float zmax" 0.9 "float phimax" 200', turned(lambda v: 0.6 + 0 * v, lambda v: -0.4 + 1.3 * v, 200)),
    "disk": ('"disk" "float radius" 1 "float innerradius" 0.4 "float height" 0.2 "float phimax" 300', turned(lambda v: 1 - 0.6 * v, lambda v: 0.2 + 0 * v, 300)),
    "bilinearmesh": ('"bilinearmesh" "point3 P" [ -1 -1 0  1 -1 0.5  -1 1 0.5  1 1 -0.5 ]', bilinear),
}


def shapes():
    tiles = texture("imagemap", '"string filename" "tiles.exr"') + 'Material "diffuse" "texture reflectance" "t"\n'
    for name, (stated, place) in SHAPES.items():
        grid(name + ".obj", place)
        for turn in ("Rotate -60 1 0 0", "Rotate 100 1 0 0\nScale -1 1 1"):
            ours = f"AttributeBegin\nTranslate 0 1 0\n{turn}\n{tiles}Shape {stated}\nAttributeEnd\n"
            steps = '<rotate x="1" angle="-60"/>' if "-60" in turn else '<scale x="-1"/><rotate x="1" angle="100"/>'
            file = word("filename", name + ".obj") + world(steps + '<translate y="1"/>')
            yield name + ("_mirrored" if "Scale" in turn else ""), ours, shape("obj", file + two(bsdf("diffuse", file_of("tiles.exr"))))


def lamp4(parameters, more=""):
    return f'AttributeBegin\nTranslate 0.5 3 1.5\nMaterial "diffuse" "rgb reflectance" [ 0 0 0 ]\nAreaLightSource "diffuse" {parameters}\n{more}Shape "sphere" "float radius" 0.4\nAttributeEnd\n'


def lamp(radiance):
    where = '<point name="center" x="0.5" y="3" z="1.5"/>' + num("radius", 0.4)
    return shape("sphere", where + light("area", rgb("radiance", radiance)))


def point(intensity):
    return light("point", '<point name="position" x="1" y="3" z="2"/>' + rgb("intensity", intensity))


def blackbody(kelvins):
    """The colour of a black body with the luminance 1."""
    x = np.linspace(360, 830, 471)
    power = x**-5 / np.expm1(1.438776877e7 / (x * kelvins))
    xyz = np.array(mi.cie1931_xyz(mi.Float(x.astype(np.float32)))).reshape(3, -1) @ power
    from_xyz = np.array([[3.240479, -1.53715, -0.498535], [-0.969256, 1.875991, 0.041556], [0.055648, -0.204043, 1.057311]])
    color = from_xyz @ (xyz / xyz[1])
    return color


def times(color, factor):
    return ",".join(str(c * factor) for c in color)


def lights():
    """Name, pbrt's lights, Mitsuba's."""
    at = '"point3 from" [ 1 3 2 ]'
    yield "point", f'LightSource "point" {at} "rgb I" [ 20 18 15 ] "float scale" 1.5', point("30,27,22.5")
    yield "point_power", f'LightSource "point" {at} "float power" 300', point(times((1, 1, 1), 300 / (4 * np.pi)))
    warm = blackbody(3000)
    yield "point_blackbody", f'LightSource "point" {at} "blackbody I" 3000 "float scale" 20', point(times(warm, 20))
    yield "point_spectrum", f'LightSource "point" {at} "spectrum I" "stdillum-D65" "float scale" 20', point("20,20,20")
    moved = f'AttributeBegin\nTranslate 1 1 1\nScale 1 2 1\nLightSource "point" "point3 from" [ 0 1 1 ] "rgb I" [ 20 20 20 ]\nAttributeEnd\n'
    yield "point_moved", moved, point("20,20,20")
    down = '<vector name="direction" x="-1" y="-2" z="-0.5"/>'
    from_ = '"point3 from" [ 1 2 0.5 ] "point3 to" [ 0 0 0 ]'
    yield "distant", f'LightSource "distant" {from_} "rgb L" [ 3 3 2 ]', light("directional", down + rgb("irradiance", "3,3,2"))
    yield "distant_illuminance", f'LightSource "distant" {from_} "float illuminance" 4 "blackbody L" 3000', light("directional", down + rgb("irradiance", times(warm, 4)))
    yield "infinite_illuminance", 'LightSource "infinite" "float illuminance" 3', light("constant", rgb("radiance", times((1, 1, 1), 3 / np.pi)))
    yield "infinite_spectrum", 'LightSource "infinite" "blackbody L" 3000 "float scale" 0.5', light("constant", rgb("radiance", times(warm, 0.5)))
    up = "Rotate 30 0 1 0\nRotate -90 1 0 0\n"
    mapped = f'AttributeBegin\n{up}LightSource "infinite" "string filename" "square.exr" "float scale" 1.5\nAttributeEnd\n'
    yield "infinite_picture", mapped, light("envmap", word("filename", "round.exr") + num("scale", 1.5) + world('<rotate y="1" angle="30"/>'))
    yield "area", lamp4('"rgb L" [ 12 11 10 ]'), lamp("12,11,10")
    yield "area_power", lamp4('"rgb L" [ 1 1 1 ] "float power" 100'), lamp(times((1, 1, 1), 100 / (np.pi * 4 * np.pi * 0.16)))
    yield "area_blackbody", lamp4('"blackbody L" 3000 "float scale" 12'), lamp(times(warm, 12))
    yield "area_reversed", lamp4('"rgb L" [ 12 11 10 ]', "ReverseOrientation\n") + SKY4, shape("sphere", '<point name="center" x="0.5" y="3" z="1.5"/>' + num("radius", 0.4) + '<boolean name="flip_normals" value="true"/>' + light("area", rgb("radiance", "12,11,10"))) + SKY
    facing = 'AttributeBegin\nMaterial "diffuse" "rgb reflectance" [ 0 0 0 ]\nAreaLightSource "diffuse" "string filename" "tiles.exr" "float scale" 3{}\nShape "bilinearmesh" "point3 P" [ -1.2 0.2 0  1.2 0.2 0  -1.2 2.2 0  1.2 2.2 0 ]\nAttributeEnd\n'
    glow = file_of("tiles3.exr", word("wrap_mode", "clamp")).replace("reflectance", "radiance")
    yield "area_picture", facing.format(""), wall(light("area", glow))
    mean = np.array(mi.Bitmap("tiles.exr")).reshape(-1, 3).mean(axis=0) @ (0.2126, 0.7152, 0.0722)
    even = file_of("even.exr", word("wrap_mode", "clamp")).replace("reflectance", "radiance")
    mi.Bitmap(np.array(mi.Bitmap("tiles.exr")) * np.float32(60 / (mean * np.pi * 4.8))).write("even.exr")
    yield "area_picture_power", facing.format(' "float power" 20'), wall(light("area", even))


def cameras():
    """Name, pbrt's camera, its film, Mitsuba's view."""
    yield "lens", 'Camera "perspective" "float fov" 32 "float lensradius" 0.3 "float focaldistance" 4', "", plugins.camera("thinlens", FOV + num("aperture_radius", 0.3) + num("focus_distance", 4))
    yield "orthographic", 'Camera "orthographic" "float screenwindow" [ -2 2 -1.5 1.5 ]', "", plugins.camera("orthographic", "", '<scale x="2" y="2"/>' + plugins.LOOK)
    tall = '"float screenwindow" [ -0.5 0.5 -0.375 0.375 ]'
    yield "screenwindow", f'Camera "perspective" "float fov" 60 {tall}', "", plugins.camera(inside=num("fov", 2 * np.degrees(np.arctan(np.tan(np.radians(30)) * 0.5))))
    crop = "".join(f'<integer name="crop_{n}" value="{v}"/>' for n, v in (("offset_x", 16), ("offset_y", 12), ("width", 40), ("height", 24)))
    cropped = plugins.camera(inside=FOV, film=crop + '<rfilter type="box"/>')
    yield "cropwindow", CAMERA4, '"float cropwindow" [ 0.25 0.875 0.25 0.75 ]', cropped
    yield "pixelbounds", CAMERA4, '"integer pixelbounds" [ 16 56 12 36 ]', cropped


def media():
    """Name, pbrt's medium and ball, Mitsuba's."""
    inside = 'MediumInterface "m" ""\nMaterial "interface"'
    made = 'MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" [ 0.3 0.6 0.9 ] "rgb sigma_s" [ 1.2 0.9 0.6 ] "float g" 0.4\n'
    even = plugins.medium(rgb("albedo", "0.8,0.6,0.4") + num("sigma_t", 1.5) + '<phase type="hg"><float name="g" value="0.4"/></phase>')
    yield "homogeneous", made + ball4(inside), plugins.ball(bsdf("null") + even)
    usual = plugins.medium(num("albedo", 0.5) + num("sigma_t", 1.0))
    yield "homogeneous_defaults", 'MakeNamedMedium "m" "string type" "homogeneous" "float scale" 0.5\n' + ball4(inside), plugins.ball(bsdf("null") + usual)


def everything():
    """Names, texts for pbrt and texts for Mitsuba."""
    for name, ours, theirs in materials():
        yield name, scene4(ball4(ours)), scene3(plugins.ball(theirs))
    for name, ours, theirs, more in textures():
        yield name, scene4(WALL4.format(ours, more)), scene3(wall(theirs))
    for name, ours, theirs in shapes():
        yield name, scene4(ours), scene3(theirs)
    for name, ours, theirs in lights():
        yield name, scene4(ball4(DIFFUSE4), ours), scene3(plugins.ball(GREY), theirs)
    for name, ours, film, view in cameras():
        yield name, scene4(ball4(DIFFUSE4), camera=ours, film=film), scene3(plugins.ball(GREY), view=view)
    for name, ours, theirs in media():
        yield name, scene4(ours).replace('"integer maxdepth" 5', '"integer maxdepth" 11'), scene3(theirs, integrator="volpath")
    exposed = '"float iso" 50 "float exposuretime" 0.5'
    yield "exposure", scene4(ball4(DIFFUSE4), film=exposed), scene3(plugins.ball(GREY), shape("rectangle", world('<rotate x="1" angle="90"/><scale value="0.8"/><translate x="1" y="4" z="1"/>') + light("area", rgb("radiance", "3,2.75,2.5"))) + light("constant", rgb("radiance", "0.1,0.125,0.15")))
    copied = f'ObjectBegin "o"\nTranslate 0 0.5 0\n{DIFFUSE4}\nShape "sphere" "float radius" 0.5\nObjectEnd\n'
    copied += 'AttributeBegin\nScale 2 1.4 1\nObjectInstance "o"\nAttributeEnd\n'
    group = '<shape type="shapegroup" id="g">' + shape("sphere", num("radius", 0.5) + GREY) + "</shape>"
    place = world('<translate y="0.5"/><scale x="2" y="1.4" z="1"/>')
    stretched = group + f'<shape type="instance"><ref id="g"/>{place}</shape>'
    yield "instance", scene4(copied), scene3(stretched)


if __name__ == "__main__":
    plugins.try_all(__doc__, files.write_files, lambda: ((name, theirs, ours) for name, ours, theirs in everything()), ".pbrt")
