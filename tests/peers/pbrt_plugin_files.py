"""What the scenes of pbrt_plugins.py name: meshes, pictures and maps of light."""
import mitsuba as mi
import mitsuba_plugins as plugins
import numpy as np


def grid(name, place, columns=128, rows=64):
    """A file of the surface `place(u, v)`, with normals, for Mitsuba."""
    u, v = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1))
    points = np.stack(np.broadcast_arrays(*place(u, v)), axis=-1).reshape(-1, 3)
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).reshape(-1)
    with open(name, "w", encoding="utf-8") as out:
        for x, y, z in points:
            out.write(f"v {x} {y} {z}\n")
        for s, t in zip(u.reshape(-1), v.reshape(-1)):
            out.write(f"vt {s} {t}\n")
        for i in first + 1:
            a, b, c, d = i, i + 1, i + columns + 2, i + columns + 1
            out.write(f"f {a}/{a} {b}/{b} {c}/{c}\nf {a}/{a} {c}/{c} {d}/{d}\n")


def turned(radius, height, most=360):
    def place(u, v):
        phi = np.radians(most) * u
        return radius(v) * np.cos(phi), radius(v) * np.sin(phi), height(v)

    return place


def sphere_part(v):
    return np.arccos(-0.5) + (np.arccos(0.8) - np.arccos(-0.5)) * v


def bilinear(u, v):
    a, b, c, d = (np.array(p)[:, None, None] for p in ((-1, -1, 0), (1, -1, 0.5), (-1, 1, 0.5), (1, 1, -0.5)))
    return (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * c + u * d)


def looked_up(picture, s, t):
    """A bilinear lookup of a picture that is repeated, t upwards."""
    rows, columns = picture.shape[:2]
    x, y = s * columns - 0.5, (1 - t) * rows - 0.5
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    a, b = (x - i)[..., None], (y - j)[..., None]

    def texel(column, row):
        return picture[row % rows, column % columns]

    return (1 - b) * ((1 - a) * texel(i, j) + a * texel(i + 1, j)) + b * ((1 - a) * texel(i, j + 1) + a * texel(i + 1, j + 1))


def write_mixtures():
    """What textures of textures are, as pictures."""
    x = (np.arange(1024) + 0.5) / 1024
    u, v = np.meshgrid(x, x[::-1])
    tiles, ramp, soft = (np.array(mi.Bitmap(name + ".exr")) for name in ("tiles", "ramp", "soft"))
    one, two_, share = looked_up(tiles, 2 * u, v), looked_up(ramp, 3 * u, v + 0.2), 3 * looked_up(soft, u, v)
    odd = ((np.floor(4 * u) + np.floor(3 * v)) % 2)[..., None]
    for name, value in (("scale", one * share), ("mix", one + share * (two_ - one)), ("checkerboard", np.where(odd, two_, one))):
        mi.Bitmap(value.astype(np.float32)).write(name + "_pictures.exr")


def equal_area(x, y):
    """The direction of a place in pbrt-v4's square maps (Clarberg 2008), z up."""
    p, q = 2 * x - 1, 2 * y - 1
    beyond = 1 - (np.abs(p) + np.abs(q))
    r = 1 - np.abs(beyond)
    phi = np.where(r == 0, np.pi / 4, ((np.abs(q) - np.abs(p)) / np.where(r == 0, 1, r) + 1) * np.pi / 4)
    z = np.copysign(1 - r * r, beyond)
    across = r * np.sqrt(np.maximum(2 - r * r, 0))
    return np.copysign(across * np.cos(phi), p), np.copysign(across * np.sin(phi), q), z


def sky_of(x, y, z):
    """Radiance from a direction, z up."""
    base = np.stack([0.3 + 0.2 * z, 0.4 + 0 * z, 0.5 + 0.1 * x], axis=-1)
    sun = np.exp(20 * (0.5 * x + 0.4 * y + 0.768 * z - 1))
    return (base + sun[..., None] * np.array([8, 7, 5])).astype(np.float32)


def write_files():
    """What the scenes name, in the current folder."""
    plugins.write_files()
    tiles = np.array(mi.Bitmap("tiles.exr"))
    bytes_ = np.round(255 * tiles).astype(np.uint8)
    mi.Bitmap(bytes_).write("tiles.png")
    mi.Bitmap((bytes_ / 255.0).astype(np.float32) ** 2).write("squared.exr")
    mi.Bitmap(1 - tiles / 2).write("inverted.exr")
    mi.Bitmap(tiles / 2).write("halved.exr")
    mi.Bitmap(tiles * 3).write("tiles3.exr")
    grey = tiles[..., :1].repeat(3, axis=-1)
    mi.Bitmap(grey).write("grey.exr")
    grid("wall.obj", lambda u, v: (2.4 * u - 1.2, 0.2 + 2 * v, 0 * u), 2, 2)
    x = (np.arange(256, dtype=np.float32) + 0.5) / 256
    u, v = np.meshgrid(x, x[::-1])
    mi.Bitmap(np.stack([0.8 * u, 0.8 * v, 0 * u], axis=-1)).write("ramp.exr")
    mi.Bitmap(np.stack([0.8 * u, 0.8 * (1 - u), 0 * u], axis=-1)).write("mixed.exr")
    mi.Bitmap((0.5 + 0.5 * np.sin(6 * np.pi * u) * np.cos(4 * np.pi * v))[..., None].repeat(3, axis=-1).astype(np.float32)).write("waves.exr")
    soft = (0.01 + 0.3 * u * v)[..., None].repeat(3, axis=-1)
    mi.Bitmap(soft).write("soft.exr")
    mi.Bitmap(np.sqrt(soft)).write("roots.exr")
    write_mixtures()
    s = (np.arange(256) + 0.5) / 256
    p, q = np.meshgrid(s, s)
    mi.Bitmap(sky_of(*equal_area(p, q))).write("square.exr")
    # Mitsuba's maps have y up, and u from -z over -x.
    phi, theta = np.meshgrid(2 * np.pi * (np.arange(512) + 0.5) / 512, np.pi * (np.arange(256) + 0.5) / 256)
    dx, dy, dz = np.sin(phi) * np.sin(theta), np.cos(theta), -np.cos(phi) * np.sin(theta)
    mi.Bitmap(sky_of(dx, -dz, dy)).write("round.exr")
