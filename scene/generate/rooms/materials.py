"""Materials as Mitsuba's bsdfs."""


def rgb(name, color):
    return f'<rgb name="{name}" value="{", ".join(f"{c:g}" for c in color)}"/>'


def number(name, value):
    return f'<float name="{name}" value="{value:g}"/>'


def bitmap(name, file, raw=False):
    as_is = '<boolean name="raw" value="true"/>' if raw else ""
    return f'<texture type="bitmap" name="{name}"><string name="filename" value="{file}"/>{as_is}</texture>'


def color(name, value):
    """A colour, or a picture's file."""
    return bitmap(name, value) if isinstance(value, str) else rgb(name, value)


def bsdf(kind, *content):
    return f'<bsdf type="{kind}">{"".join(content)}</bsdf>'


def both_sides(inner):
    return bsdf("twosided", inner)


def diffuse(reflectance):
    return both_sides(bsdf("diffuse", color("reflectance", reflectance)))


def varnished(reflectance, alpha, relief=None):
    """A rough coat over a colour, with the normal map of a file."""
    inner = bsdf("roughplastic", color("diffuse_reflectance", reflectance), number("alpha", alpha))
    return both_sides(bsdf("normalmap", bitmap("normalmap", relief, True), inner) if relief else inner)


def glazed(reflectance):
    return both_sides(bsdf("plastic", color("diffuse_reflectance", reflectance)))


def principled(base, **numbers):
    return both_sides(bsdf("principled", color("base_color", base),
                           *(number(name, value) for name, value in numbers.items())))


def translucent(base, share, roughness=0.8):
    """A cloth or paper through which a share of the light comes, diffuse."""
    return bsdf("principledthin", color("base_color", base), number("roughness", roughness),
                number("diff_trans", 2 * share), number("eta", 1.3))


def metal(name, alpha=0.0):
    kind = "roughconductor" if alpha else "conductor"
    return both_sides(bsdf(kind, f'<string name="material" value="{name}"/>', number("alpha", alpha) if alpha else ""))


def brass(alpha):
    """Yellow brass, by its index for red, green and blue."""
    return both_sides(
        bsdf("roughconductor", rgb("eta", (0.45, 0.55, 1.1)), rgb("k", (3.7, 2.9, 1.95)), number("alpha", alpha)))


def mirror():
    return both_sides(bsdf("conductor", '<string name="material" value="Ag"/>'))


def glass(ior=1.5, alpha=0.0):
    return bsdf("roughdielectric" if alpha else "dielectric", number("int_ior", ior), number("ext_ior", 1),
                number("alpha", alpha) if alpha else "")


def thin_glass():
    return bsdf("thindielectric", number("int_ior", 1.5), number("ext_ior", 1))


def cut_out(opacity, inner):
    """What the alpha of a picture leaves."""
    return bsdf("mask", bitmap("opacity", opacity, True), inner)


def ball_lamp(center, radius, radiance):
    x, y, z = center
    return (f'<shape type="sphere"><point name="center" x="{x:g}" y="{y:g}" z="{z:g}"/>{number("radius", radius)}'
            f'<emitter type="area">{rgb("radiance", radiance)}</emitter></shape>')


def sky(file, turn, scale):
    return (f'<emitter type="envmap"><string name="filename" value="{file}"/>{number("scale", scale)}'
            f'<transform name="to_world"><rotate y="1" angle="{turn:g}"/></transform></emitter>')


def sun_and_sky(direction, scale):
    """Hosek and Wilkie's, for a sun in this direction; the model's own z is up."""
    x, y, z = direction
    return (f'<emitter type="sunsky">{number("turbidity", 3)}'
            f'<vector name="sun_direction" x="{x:g}" y="{y:g}" z="{z:g}"/>{number("sun_scale", scale)}'
            f'{number("sky_scale", scale)}'
            '<transform name="to_world"><rotate x="1" angle="-90"/></transform></emitter>')


def panel_lamp(center, half, turn_x, radiance):
    """A rectangle in the plane of x and y that shines to +z, turned about x."""
    x, y, z = center
    return (f'<shape type="rectangle"><transform name="to_world"><scale x="{half[0]:g}" y="{half[1]:g}"/>'
            f'<rotate x="1" angle="{turn_x:g}"/><translate x="{x:g}" y="{y:g}" z="{z:g}"/></transform>'
            f'<emitter type="area">{rgb("radiance", radiance)}</emitter></shape>')
