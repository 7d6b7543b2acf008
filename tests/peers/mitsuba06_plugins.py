#!/usr/bin/env python3
"""mitsuba06_plugins.py PROGRAM [NAME...]: small scenes of Mitsuba 0.6 by this program, and their equivalents by Mitsuba 3.

Mitsuba 0.6 itself is at hand nowhere. What its manual says of a name, a default or a meaning is stated here in the syntax of
Mitsuba 3 by hand, with pictures and meshes made for it where the two differ: so this file holds the rules of 0.6 a second
time. Shown is what mitsuba_plugins.py shows, with the same limits. Needs Mitsuba's Python module; by hand.
"""
import mitsuba as mi
import mitsuba_plugins as plugins
import numpy as np
from mitsuba06_plugin_files import write_files
from mitsuba_plugins import FLOOR, LAMP, LOOK, SKY, ball, bsdf, light, medium, num, rgb, shape, word, world

LOOK6 = LOOK.replace("lookat", "lookAt")


def flag(name, value):
    return f'<boolean name="{name}" value="{value}"/>'


def whole(name, value):
    return f'<integer name="{name}" value="{value}"/>'


def point(name, x, y, z):
    return f'<point name="{name}" x="{x}" y="{y}" z="{z}"/>'


def old(text):
    """The parts that both have, by their names in 0.6."""
    return text.replace("to_world", "toWorld").replace("max_depth", "maxDepth").replace("lookat", "lookAt")


def to_uv(inside):
    return f'<transform name="to_uv">{inside}</transform>'


def texture(kind, name, inside):
    return f'<texture type="{kind}" name="{name}">{inside}</texture>'


def picture(name, inside="", file="tiles.exr"):
    return texture("bitmap", name, word("filename", file) + inside)


def scene6(body, lights=LAMP + SKY, view=None, integrator="path"):
    depth = 12 if integrator == "volpath" else 6
    head = f'<integrator type="{integrator}">{whole("maxDepth", depth)}</integrator>'
    sight = view or old(plugins.camera())
    return f'<scene version="0.6.0">{head}{sight}{old(FLOOR)}{old(lights)}{body}</scene>'


def camera6(kind="perspective", inside=num("fov", 40), look=LOOK6, film='<rfilter type="box"/>'):
    return old(plugins.camera(kind, inside, look, film))


RED = bsdf("diffuse", rgb("reflectance", "0.8,0.1,0.1"))
DIFFUSE = bsdf("diffuse")
LINEAR3 = '<boolean name="raw" value="true"/>'
# What this program shows otherwise.
plugins.KNOWN |= {
    "point_pairs": "the CIE's curves are fits here, of 1 %",
    "wrap_zero": "replaced, which is said",
    "wrap_one": "replaced, which is said",
}
SHADOWLESS = flag("flip_invalid_normals", "false") + flag("use_shadowing_function", "false")


def materials():
    """Name, the material of 0.6, that of 3."""
    yield "diffuse", DIFFUSE, DIFFUSE
    for name, value in (("srgb", '<srgb name="reflectance" value="#cc8040"/>'), ("srgb_numbers", '<srgb name="reflectance" value="0.8, 0.502, 0.251"/>')):
        yield name, bsdf("diffuse", value), bsdf("diffuse", rgb("reflectance", "0.6038,0.2159,0.0513"))
    yield "rgb_hex", bsdf("diffuse", rgb("reflectance", "#cc8040")), bsdf("diffuse", rgb("reflectance", "0.8,0.502,0.251"))
    intent = '<spectrum name="reflectance" intent="reflectance" value="0.3"/>'
    yield "spectrum_number", bsdf("diffuse", intent), bsdf("diffuse", rgb("reflectance", "0.3"))
    yield "dielectric", bsdf("dielectric", word("intIOR", "water") + word("extIOR", "air")), bsdf("dielectric", num("int_ior", 1.333) + num("ext_ior", 1.000277))
    tinted = rgb("specularTransmittance", "0.9,0.7,0.5") + rgb("specularReflectance", "0.5,0.7,0.9") + num("intIOR", 1.4)
    yield "dielectric_tinted", bsdf("dielectric", tinted), bsdf("dielectric", rgb("specular_transmittance", "0.9,0.7,0.5") + rgb("specular_reflectance", "0.5,0.7,0.9") + num("int_ior", 1.4))
    yield "dielectric_defaults", bsdf("dielectric"), bsdf("dielectric", num("int_ior", 1.5046) + num("ext_ior", 1.000277))
    yield "thindielectric", bsdf("thindielectric", num("intIOR", 1.6)), bsdf("thindielectric", num("int_ior", 1.6))
    yield "roughdielectric", bsdf("roughdielectric", num("alpha", 0.3)), bsdf("roughdielectric", word("distribution", "beckmann") + num("alpha", 0.3))
    yield "roughdielectric_defaults", bsdf("roughdielectric", word("distribution", "GGX")), bsdf("roughdielectric", word("distribution", "ggx") + num("alpha", 0.1))
    copper = word("material", "Cu")
    outside = bsdf("conductor", rgb("eta", "0.2004,0.9238,1.1019") + rgb("k", "3.9118,2.4522,2.1416"))
    yield "conductor_defaults", bsdf("conductor"), outside
    yield "conductor_ext", bsdf("conductor", word("material", "Au") + num("extEta", 1.33)), bsdf("conductor", rgb("eta", "0.10761,0.28192,1.08457") + rgb("k", "2.99486,1.79377,1.20542"))
    yield "conductor_none", bsdf("conductor", word("material", "none") + rgb("specularReflectance", "0.9,0.6,0.3")), bsdf("conductor", word("material", "none") + rgb("specular_reflectance", "0.9,0.6,0.3"))
    yield "conductor_palik", bsdf("conductor", word("material", "Na_palik")), bsdf("conductor", rgb("eta", "0.0603,0.0561,0.062") + rgb("k", "3.1793,2.1125,1.5791"))
    yield "roughconductor_defaults", bsdf("roughconductor"), bsdf("roughconductor", copper + word("distribution", "beckmann") + num("alpha", 0.1))
    axes = num("alphaU", 0.1) + num("alphaV", 0.4) + word("material", "Al") + word("distribution", "ggx") + flag("sampleVisible", "false")
    yield "roughconductor_axes", bsdf("roughconductor", axes), bsdf("roughconductor", word("material", "Al") + word("distribution", "ggx") + num("alpha_u", 0.1) + num("alpha_v", 0.4))
    yield "roughconductor_picture", bsdf("roughconductor", copper + picture("alpha", "", "colored.exr")), bsdf("roughconductor", copper + picture("alpha", LINEAR3, "averages.exr"))
    yield "plastic", bsdf("plastic", rgb("diffuseReflectance", "0.1,0.3,0.6")), bsdf("plastic", rgb("diffuse_reflectance", "0.1,0.3,0.6") + num("int_ior", 1.49) + flag("nonlinear", "false"))
    yield "plastic_nonlinear", bsdf("plastic", rgb("diffuseReflectance", "0.1,0.3,0.6") + flag("nonlinear", "true") + num("intIOR", 1.9)), bsdf("plastic", rgb("diffuse_reflectance", "0.1,0.3,0.6") + num("int_ior", 1.9) + flag("nonlinear", "true"))
    yield "plastic_weight", bsdf("plastic", rgb("specularReflectance", "0.5") + num("specularSamplingWeight", 0.7)), bsdf("plastic", rgb("specular_reflectance", "0.5"))
    yield "roughplastic", bsdf("roughplastic", num("alpha", 0.3) + rgb("diffuseReflectance", "0.1,0.3,0.6")), bsdf("roughplastic", word("distribution", "beckmann") + num("alpha", 0.3) + rgb("diffuse_reflectance", "0.1,0.3,0.6") + num("int_ior", 1.49))
    yield "roughplastic_nonlinear", bsdf("roughplastic", word("distribution", "ggx") + rgb("diffuseReflectance", "0.1,0.3,0.6") + flag("nonlinear", "true")), bsdf("roughplastic", word("distribution", "ggx") + num("alpha", 0.1) + rgb("diffuse_reflectance", "0.1,0.3,0.6") + flag("nonlinear", "true"))
    rough = bsdf("roughconductor", num("alpha", 0.2) + copper)
    yield "blend", bsdf("blendbsdf", num("weight", 0.3) + RED + rough), bsdf("blendbsdf", num("weight", 0.3) + RED + rough)
    yield "blend_picture", bsdf("blendbsdf", picture("weight", "", "colored.exr") + RED + rough), bsdf("blendbsdf", picture("weight", LINEAR3, "averages.exr") + RED + rough)
    blue = bsdf("diffuse", rgb("reflectance", "0.1,0.2,0.7"))
    yield "mixture", bsdf("mixturebsdf", word("weights", "0.2, 0.3, 0.5") + RED + rough + blue), bsdf("blendbsdf", num("weight", 0.5) + bsdf("blendbsdf", num("weight", 0.6) + RED + rough) + blue)
    yield "mixture_half", bsdf("mixturebsdf", word("weights", "0.2, 0.3") + RED + blue), bsdf("diffuse", rgb("reflectance", "0.19,0.08,0.23"))
    yield "mixture_more", bsdf("mixturebsdf", word("weights", "1 1") + RED + blue), bsdf("diffuse", rgb("reflectance", "0.45,0.15,0.4"))
    two = bsdf("twosided", DIFFUSE)
    yield "mask", bsdf("mask", rgb("opacity", "0.3") + two), bsdf("mask", num("opacity", 0.3) + two)
    yield "mask_defaults", bsdf("mask", two), bsdf("mask", num("opacity", 0.5) + two)
    yield "mask_channel", bsdf("mask", picture("opacity", word("channel", "g"), "colored.exr") + two), bsdf("mask", picture("opacity", LINEAR3, "greens.exr") + two)
    yield "twosided", bsdf("twosided", RED + bsdf("plastic")), bsdf("twosided", RED + bsdf("plastic"))
    lost = 1 - mi.fresnel_diffuse_reflectance(1.000277 / 1.5046)
    base = rgb("diffuse_reflectance", ",".join(str(c * float(lost[0])) for c in (0.8, 0.1, 0.1)))
    yield "coating", bsdf("coating", RED), bsdf("plastic", num("int_ior", 1.5046) + base)
    waves = picture("", "", "waves.exr").replace(' name=""', "")
    heights = picture("height", LINEAR3, "waves.exr") + SHADOWLESS
    yield "bumpmap", bsdf("bumpmap", texture("scale", "", num("scale", 0.2) + waves).replace(' name=""', "") + DIFFUSE), bsdf("bumpmap", heights + num("scale", 0.2) + DIFFUSE)
    yield "bump", bsdf("bump", waves + bsdf("roughplastic")), bsdf("bumpmap", heights + bsdf("roughplastic"))
    yield "normalmap", bsdf("normalmap", picture("normals", "", "normals.exr").replace(' name="normals"', "") + DIFFUSE), bsdf("normalmap", picture("normalmap", LINEAR3, "normals.exr") + SHADOWLESS + DIFFUSE)


def textures():
    """Name, the bsdf of 0.6 on a wall, that of 3."""
    many = num("uscale", 3) + num("vscale", 2) + num("uoffset", 0.1) + num("voffset", 0.3)
    moved = to_uv('<scale x="3" y="2"/><translate x="0.1" y="0.3"/>')
    yield "bitmap", picture("reflectance", many), picture("reflectance", moved)
    yield "bitmap_uvscale", picture("reflectance", num("uvscale", 2) + word("filterType", "nearest")), picture("reflectance", to_uv('<scale value="2"/>') + word("filter_type", "nearest"))
    wide = num("uvscale", 3)
    for mode in ("mirror", "clamp"):
        yield "wrap_" + mode, picture("reflectance", wide + word("wrapMode", mode)), picture("reflectance", to_uv('<scale value="3"/>') + word("wrap_mode", mode))
    yield "wrap_each", picture("reflectance", wide + word("wrapModeU", "mirror") + word("wrapModeV", "repeat")), picture("reflectance", to_uv('<scale x="1.5" y="3"/>'), "mirrored.exr")
    yield "wrap_zero", picture("reflectance", wide + word("wrapMode", "zero")), picture("reflectance", "", "zeros.exr")
    yield "wrap_one", picture("reflectance", wide + word("wrapMode", "one")), picture("reflectance", "", "ones.exr")
    for kind in ("trilinear", "ewa"):
        yield "filter_" + kind, picture("reflectance", word("filterType", kind) + num("maxAnisotropy", 10)), picture("reflectance")
    yield "gamma_usual", picture("reflectance", "", "tiles.png"), picture("reflectance", "", "tiles.png")
    yield "gamma_srgb", picture("reflectance", num("gamma", -1), "tiles.png"), picture("reflectance", "", "tiles.png")
    yield "gamma_one", picture("reflectance", num("gamma", 1), "tiles.png"), picture("reflectance", LINEAR3, "tiles.png")
    yield "gamma_22", picture("reflectance", num("gamma", 2.2), "tiles.png"), picture("reflectance", "", "gamma22.exr")
    yield "gamma_18", picture("reflectance", num("gamma", 1.8), "tiles.png"), picture("reflectance", "", "gamma18.exr")
    yield "channel", picture("reflectance", word("channel", "g"), "colored.exr"), picture("reflectance", "", "greens.exr")
    board3 = '<transform name="to_uv"><scale x="4" y="2"/></transform>'
    yield "checkerboard", texture("checkerboard", "reflectance", num("uscale", 4) + num("vscale", 2)), texture("checkerboard", "reflectance", board3 + rgb("color0", 0.4) + rgb("color1", 0.2))
    colors = rgb("color0", "0.7,0.1,0.1") + rgb("color1", "0.1,0.1,0.7")
    yield "checkerboard_colors", texture("checkerboard", "reflectance", colors + num("uoffset", 0.2)), texture("checkerboard", "reflectance", colors + to_uv('<translate x="0.2"/>'))
    yield "gridtexture", texture("gridtexture", "reflectance", num("uvscale", 3) + num("lineWidth", 0.1)), picture("reflectance", to_uv('<scale value="3"/>') + word("filter_type", "nearest"), "grid.exr")
    yield "scale", texture("scale", "reflectance", num("scale", 0.5) + picture("inner").replace(' name="inner"', "")), picture("reflectance", "", "halved.exr")
    yield "scale_color", texture("scale", "reflectance", '<spectrum name="scale" value="0.5,0.25,1"/>' + picture("inner").replace(' name="inner"', "")), picture("reflectance", "", "tinted.exr")
    lines = rgb("edgeColor", "0.9,0.1,0.1") + rgb("interiorColor", "0.2,0.4,0.6") + num("lineWidth", 0.001)
    yield "wireframe", texture("wireframe", "reflectance", lines), rgb("reflectance", "0.2,0.4,0.6")


def wall(material, to="to_world"):
    steps = '<scale x="1.2" y="1"/><translate y="1.2"/>'
    return shape("rectangle", f'<transform name="{to}">{steps}</transform>' + bsdf("twosided", material))


def both(kind, inside, steps, material, more=""):
    """A shape for 0.6 and for 3, whose parameters have one name."""
    return shape(kind, inside + old(world(steps)) + material), shape(kind, inside + more + world(steps) + material)


def planck(kelvins, scale):
    """The colour of a black body, in W / (m^2 sr nm)."""
    nm = np.linspace(360, 830, 471)
    power = 1.191042972e29 * scale / nm**5 / np.expm1(1.438776877e7 / (nm * kelvins)) * 1e-9
    xyz = np.array(mi.cie1931_xyz(mi.Float(nm.astype(np.float32)))).reshape(3, -1)
    from_xyz = np.array([[3.240479, -1.53715, -0.498535], [-0.969256, 1.875991, 0.041556], [0.055648, -0.204043, 1.057311]])
    return ",".join(map(str, from_xyz @ (xyz @ power) / xyz[1].sum()))


def shapes():
    """Name, the shape of 0.6, that of 3."""
    textured = bsdf("twosided", bsdf("diffuse", picture("reflectance")))
    turned = '<scale value="0.7"/><rotate y="1" angle="30"/><translate y="0.8"/>'
    yield "cube", *both("cube", "", turned, textured)
    where = point("center", 0.1, 0.2, 0.1) + num("radius", 0.8)
    yield "sphere", *both("sphere", where, '<rotate x="1" angle="40"/><translate y="0.8"/>', textured)
    yield "sphere_flipped", shape("sphere", point("center", 0, 1, 0) + flag("flipNormals", "true") + DIFFUSE), shape("sphere", point("center", 0, 1, 0) + flag("flip_normals", "true") + DIFFUSE)
    tall = point("p0", 0, 0.4, 0) + point("p1", 0, 1.6, 0) + num("radius", 0.5)
    yield "cylinder_up", shape("cylinder", tall + textured), shape("cylinder", tall + textured)
    lying = point("p0", -1, 0.8, 0) + point("p1", 1, 0.8, 0) + num("radius", 0.5)
    # The frame about x begins at -y in 0.6.
    same = shape("cylinder", point("p0", 0, 0, 0) + point("p1", 0, 0, 2) + num("radius", 0.5) + world('<matrix value="0 0 1 -1  -1 0 0 0.8  0 -1 0 0  0 0 0 1"/>') + textured)
    yield "cylinder_lying", shape("cylinder", lying + textured), same
    yield "cylinder_scaled", *both("cylinder", "", '<scale x="0.6" y="0.6" z="1.2"/><rotate x="1" angle="-70"/><translate y="0.4"/>', textured)
    yield "disk", *both("disk", "", '<rotate x="1" angle="-30"/><translate y="1"/>', textured)
    flipped = world('<rotate y="1" angle="180"/><translate y="1"/>') + DIFFUSE
    yield "rectangle_flipped", shape("rectangle", flag("flipNormals", "true") + old(flipped)), shape("rectangle", flag("flip_normals", "true") + flipped)
    mesh = word("filename", "wall.obj")
    yield "obj", *both("obj", mesh, '<rotate x="1" angle="-20"/>', textured)
    yield "obj_unflipped", shape("obj", mesh + flag("flipTexCoords", "false") + textured), shape("obj", mesh + flag("flip_tex_coords", "false") + textured)
    yield "obj_flat", shape("obj", word("filename", "ball.obj") + flag("faceNormals", "true") + DIFFUSE), shape("obj", word("filename", "ball.obj") + flag("face_normals", "true") + DIFFUSE)
    painted = bsdf("twosided", bsdf("diffuse", texture("vertexcolors", "reflectance", "")))
    theirs = bsdf("twosided", bsdf("diffuse", texture("mesh_attribute", "reflectance", word("name", "vertex_color"))))
    for kind, decoded in (("bytes", "decoded"), ("floats", "decoded")):
        yield "colors_" + kind, shape("ply", word("filename", kind + ".ply") + painted), shape("ply", word("filename", decoded + ".ply") + theirs)
        yield f"colors_{kind}_linear", shape("ply", word("filename", kind + ".ply") + flag("srgb", "false") + painted), shape("ply", word("filename", "linear.ply") + theirs)
    group = '<shape type="shapegroup" id="g">' + shape("sphere", num("radius", 0.5) + RED) + '</shape><shape type="instance"><ref id="g"/>'
    place = world('<scale x="2" y="1" z="1"/><rotate z="1" angle="20"/><translate y="0.9"/>') + "</shape>"
    yield "instance", group + old(place), group + place
    yield "heightfield", shape("heightfield", word("filename", "heights.exr") + num("scale", 0.5) + old(world('<rotate x="1" angle="-80"/><translate y="0.7"/>')) + DIFFUSE), shape("obj", word("filename", "heights.obj") + world('<rotate x="1" angle="-80"/><translate y="0.7"/>') + DIFFUSE)


def lights():
    """Name, the lights of 0.6, those of 3."""
    at = point("position", 1, 3, 2)
    yield "point", light("point", at + rgb("intensity", "20,18,15") + num("samplingWeight", 2)), light("point", at + rgb("intensity", "20,18,15"))
    moved = light("point", old(world('<translate x="1" y="3" z="2"/>')) + '<spectrum name="intensity" value="20"/>')
    yield "point_spectrum", moved, light("point", at + rgb("intensity", "20"))
    pairs = '<spectrum name="intensity" value="{}"/>'
    yield "point_pairs", light("point", at + pairs.format("400:10, 500:40, 600:20, 700:5")), light("point", at + pairs.format("400:10,500:40,600:20,700:5"))
    yield "point_blackbody", light("point", at + '<blackbody name="intensity" temperature="3000K" scale="0.03"/>'), light("point", at + rgb("intensity", planck(3000, 0.03)))
    look = world('<lookat origin="2,4,2" target="0,0.5,0" up="0,1,0"/>')
    yield "spot", light("spot", old(look) + rgb("intensity", "60,50,40") + num("cutoffAngle", 20) + num("beamWidth", 12)), light("spot", look + rgb("intensity", "60,50,40") + num("cutoff_angle", 20) + num("beam_width", 12))
    yield "spot_defaults", light("spot", old(look) + rgb("intensity", "60")), light("spot", look + rgb("intensity", "60") + num("cutoff_angle", 20) + num("beam_width", 15))
    yield "spot_picture", light("spot", old(look) + rgb("intensity", "60") + picture("texture")), light("spot", look + rgb("intensity", "60") + picture("texture", LINEAR3))
    down = '<vector name="direction" x="-1" y="-2" z="-0.5"/>'
    yield "directional", light("directional", down + rgb("irradiance", "3,3,2")), light("directional", down + rgb("irradiance", "3,3,2"))
    yield "constant", light("constant", '<spectrum name="radiance" value="0.7"/>'), light("constant", rgb("radiance", "0.7"))
    yield "envmap", light("envmap", word("filename", "round6.exr") + num("scale", 1.5) + old(world('<rotate y="1" angle="70"/>'))), light("envmap", word("filename", "round.exr") + num("scale", 1.5) + world('<rotate y="1" angle="70"/>'))
    yield "envmap_png", light("envmap", word("filename", "sky.png")), light("envmap", word("filename", "sky_decoded.exr"))
    yield "envmap_gamma", light("envmap", word("filename", "sky.png") + num("gamma", 1)), light("envmap", word("filename", "sky_raw.exr"))
    sun = '<vector name="{}" x="0.4" y="0.6" z="0.5"/>'
    upright = world('<rotate x="1" angle="-90"/>')
    bare = '<rgb name="albedo" value="0.2"/>'
    yield "sky", light("sky", num("turbidity", 4) + num("scale", 2) + sun.format("sunDirection")), light("sunsky", num("turbidity", 4) + num("sun_scale", 0) + num("sky_scale", 2) + sun.format("sun_direction") + upright + bare)
    lamp = "<shape type=\"rectangle\">" + world('<rotate x="1" angle="90"/><scale value="0.8"/><translate x="1" y="4" z="1"/>')
    glow = '<blackbody name="radiance" temperature="3000" scale="0.02"/>'
    glow3 = rgb("radiance", planck(3000, 0.02))
    yield "area_blackbody", old(lamp) + light("area", glow) + "</shape>", lamp + light("area", glow3) + "</shape>"
    yield "area_defaults", old(lamp) + light("area", "") + "</shape>" + SKY, lamp + light("area", rgb("radiance", 1)) + "</shape>" + SKY
    beam = light("collimated", old(look) + num("power", 100))
    yield "collimated", SKY + beam, SKY


def cameras():
    """Name, the camera of 0.6, that of 3."""
    plain = plugins.camera
    yield "focal_length", camera6(inside=word("focalLength", "35mm")), plain(inside=word("focal_length", "35mm"))
    yield "focal_length_default", camera6(inside=""), plain(inside=word("focal_length", "50mm"))
    for axis in ("y", "diagonal", "smaller", "larger"):
        yield "fov_" + axis, camera6(inside=num("fov", 36) + word("fovAxis", axis)), plain(inside=num("fov", 36) + word("fov_axis", axis))
    clip = num("nearClip", 5.4) + num("farClip", 7), num("near_clip", 5.4) + num("far_clip", 7)
    yield "clip", camera6(inside=num("fov", 40) + clip[0]), plain(inside=num("fov", 40) + clip[1])
    yield "thinlens", camera6("thinlens", num("fov", 40) + num("apertureRadius", 0.3) + num("focusDistance", 4)), plain("thinlens", num("fov", 40) + num("aperture_radius", 0.3) + num("focus_distance", 4))
    wide = '<scale x="2" y="2"/>'
    yield "orthographic", camera6("orthographic", "", wide + LOOK6), plain("orthographic", "", wide + LOOK)
    yield "telecentric", camera6("telecentric", num("apertureRadius", 0.0001) + num("focusDistance", 5), wide + LOOK6), plain("orthographic", "", wide + LOOK)
    names = ("OffsetX", "offset_x", 16), ("OffsetY", "offset_y", 12), ("Width", "width", 40), ("Height", "height", 24)
    crop6, crop3 = ("".join(whole(f"crop{'' if i == 0 else '_'}{n[i]}", n[2]) for n in names) for i in (0, 1))
    box = '<rfilter type="box"/>'
    yield "crop", camera6(film=crop6 + box), plain(film=crop3 + box)
    for name, more6, more3 in (
        ("gaussian", num("stddev", 0.8), num("stddev", 0.8)), ("tent", "", ""), ("catmullrom", "", ""),
        ("mitchell", num("B", 0.1) + num("C", 0.6), num("A", 0.1).replace('"A"', '"B"') + num("C", 0.6)), ("lanczos", whole("lobes", 4), whole("lobes", 4)),
    ):
        yield "filter_" + name, camera6(film=f'<rfilter type="{name}">{more6}</rfilter>'), plain(film=f'<rfilter type="{name}">{more3}</rfilter>')
    yield "filter_default", camera6(film=""), plain(film='<rfilter type="gaussian"><float name="stddev" value="0.5"/></rfilter>')
    yield "ldrfilm", camera6().replace("hdrfilm", "ldrfilm"), plain()
    mirrored = '<scale x="-1"/>'
    yield "mirrored", camera6(look=mirrored + LOOK6), plain(look=mirrored + LOOK)


def media():
    """Name, a ball of 0.6, that of 3."""
    null = bsdf("null")
    hg = '<phase type="hg">{}</phase>'
    parts = rgb("sigmaS", "1.2,0.9,0.6") + rgb("sigmaA", "0.3,0.6,0.9")
    whole3 = rgb("albedo", "0.8,0.6,0.4") + num("sigma_t", 1.5)
    yield "sigma_s_a", ball(medium(parts + hg.format(num("g", 0.4)))), ball(null + medium(whole3 + hg.format(num("g", 0.4))))
    yield "sigma_t_albedo", ball(medium(rgb("sigmaT", "0.5") + rgb("albedo", "0.8,0.6,0.4") + num("scale", 3))), ball(null + medium(whole3))
    yield "hg_default", ball(medium(parts + hg.format(""))), ball(null + medium(whole3 + hg.format(num("g", 0.8))))
    milk = rgb("albedo", "0.99963,0.99971,0.99945") + rgb("sigma_t", "0.637775,0.8031,0.946") + num("scale", 4)
    yield "material", ball(medium(word("material", "Wholemilk"))), ball(null + medium(milk))
    grid = '<volume type="gridvolume" name="{}">' + word("filename", "grid.vol") + "{}</volume>"
    # Values are at the corners of cells in 0.6, in the middles in 3: 8 of them, and 7 cells.
    place = '<scale value="{0}"/><translate x="-{1}" y="{2}" z="-{1}"/>'
    cube = world('<translate y="1.1"/>')
    smoke = grid.format("density", old(world(place.format(2, 1, 0.1)))) + num("scale", 3)
    white = '<volume type="constvolume" name="albedo"><float name="value" value="0.8"/></volume>'
    smoke3 = grid.format("sigma_t", world(place.format(16 / 7, 8 / 7, 0.1 - 1 / 7))) + num("scale", 3) + num("albedo", 0.8)
    inside = '<medium type="heterogeneous" name="interior">{}</medium>'
    yield "heterogeneous", shape("cube", old(cube) + inside.format(smoke + white)), shape("cube", cube + null + inside.format(smoke3))
    glass = bsdf("dielectric", num("{}", 1.3))
    yield "in_glass", ball(glass.format("intIOR") + medium(parts)), ball(glass.format("int_ior") + medium(whole3))


def documents():
    """What the file itself has: name, what is in the scene of 0.6, what in that of 3."""
    where = point("center", 0, 1, 0)
    red = '<bsdf type="diffuse" id="red"><rgb name="reflectance" value="0.8,0.1,0.1"/></bsdf>'
    yield "ref", red + shape("sphere", where + '<ref name="bsdf" id="red"/>'), ball(RED)
    yield "alias", red + '<alias id="red" as="other"/>' + shape("sphere", where + '<ref id="other"/>'), ball(RED)
    yield "default", '<default name="size" value="0.6"/>' + shape("sphere", where + num("radius", "$size") + RED), shape("sphere", where + num("radius", 0.6) + RED)
    yield "include", '<include filename="part.xml"/>', ball(RED)
    yield "no_bsdf", shape("sphere", where), ball(DIFFUSE)
    steps = '<rotate z="1" angle="30"/><scale x="1" y="0.4" z="0.7"/><translate x="0.2" y="1"/><matrix value="1 0.2 0 0  0 1 0 0  0 0.1 1 0  0 0 0 1"/>'
    yield "transforms", shape("cube", old(world(steps)) + DIFFUSE), shape("cube", world(steps) + DIFFUSE)


def everything():
    """Names, texts of 0.6 and of 3."""
    for name, ours, theirs in materials():
        yield name, scene6(ball(ours)), plugins.scene(ball(theirs))
    for name, ours, theirs in textures():
        yield name, scene6(wall(bsdf("diffuse", ours), "toWorld")), plugins.scene(wall(bsdf("diffuse", theirs)))
    for name, ours, theirs in shapes():
        yield name, scene6(ours), plugins.scene(theirs)
    for name, ours, theirs in lights():
        yield name, scene6(ball(DIFFUSE), ours), plugins.scene(ball(DIFFUSE), theirs)
    for name, ours, theirs in cameras():
        yield name, scene6(ball(RED), view=ours), plugins.scene(ball(RED), view=theirs)
    for name, ours, theirs in media():
        yield "medium_" + name, scene6(ours, integrator="volpath"), plugins.scene(theirs, integrator="volpath")
    for name, ours, theirs in documents():
        yield name, scene6(ours), plugins.scene(theirs)


if __name__ == "__main__":
    plugins.try_all(__doc__, write_files, lambda: ((name, theirs, ours) for name, ours, theirs in everything()), "_06.xml")
