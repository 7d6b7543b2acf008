"""What the scenes of mitsuba06_plugins.py name: pictures, meshes, and what textures of 0.6 are as pictures of Mitsuba 3."""
import mitsuba as mi
import mitsuba_plugins as plugins
import numpy as np
from pbrt_plugin_files import grid, looked_up


def decoded(x):
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def exr(name, values):
    mi.Bitmap(np.ascontiguousarray(values, dtype=np.float32)).write(name + ".exr")


def colored_ply(name, colors, kind):
    """A wall of four corners."""
    corners = (-1.2, 0.2, 0), (1.2, 0.2, 0), (1.2, 2.2, 0), (-1.2, 2.2, 0)
    names = ("red", "green", "blue") if kind == "uchar" else ("r", "g", "b")
    with open(name + ".ply", "w", encoding="utf-8") as out:
        out.write("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n")
        out.write("".join(f"property {kind} {n}\n" for n in names))
        out.write("element face 2\nproperty list uchar int vertex_indices\nend_header\n")
        for corner, color in zip(corners, colors):
            out.write(" ".join(map(str, (*corner, *color))) + "\n")
        out.write("3 0 1 2\n3 0 2 3\n")


def write_meshes():
    colors = np.array([[200, 60, 20], [30, 180, 90], [120, 120, 240], [250, 220, 40]])
    colored_ply("bytes", colors, "uchar")
    colored_ply("floats", colors / 255, "float")
    colored_ply("linear", colors / 255, "float")
    colored_ply("decoded", decoded(colors / 255), "float")
    grid("wall.obj", lambda u, v: (2.4 * u - 1.2, 0.2 + 2 * v, 0 * u), 2, 2)
    grid("ball.obj", lambda u, v: (np.sin(np.pi * v) * np.cos(2 * np.pi * u), 1 - np.cos(np.pi * v), -np.sin(np.pi * v) * np.sin(2 * np.pi * u)), 12, 6)
    # A field of heights has its first row at y = -1.
    heights = 0.5 + 0.5 * np.sin(np.arange(33) / 5)[None, :] * np.cos(np.arange(17) / 3)[:, None]
    exr("heights", heights[..., None].repeat(3, axis=-1))

    def place(u, v):
        return 2 * u - 1, 2 * v - 1, 0.5 * heights[np.round(v * 16).astype(int), np.round(u * 32).astype(int)]

    grid("heights.obj", place, 32, 16)


def write_files():
    plugins.write_files()
    tiles = np.array(mi.Bitmap("tiles.exr"))
    bytes_ = np.round(255 * tiles).astype(np.uint8)
    mi.Bitmap(bytes_).write("tiles.png")
    for name, gamma in (("gamma22", 2.2), ("gamma18", 1.8)):
        exr(name, (bytes_ / 255.0) ** gamma)
    exr("halved", tiles / 2)
    exr("tinted", tiles * (0.5, 0.25, 1))
    exr("mirrored", np.concatenate([tiles, tiles[:, ::-1]], axis=1))
    colored = 0.05 + 0.6 * tiles * (1, 0.6, 0.2)
    exr("colored", colored)
    exr("averages", colored.mean(axis=-1, keepdims=True).repeat(3, axis=-1))
    exr("greens", colored[..., 1:2].repeat(3, axis=-1))
    x = (np.arange(1024) + 0.5) / 1024
    u, v = np.meshgrid(x, x[::-1])
    for name, outside in (("zeros", 0), ("ones", 1)):
        framed = np.pad(tiles, ((16, 16), (16, 16), (0, 0)), constant_values=outside)
        exr(name, looked_up(framed, (3 * u + 2) / 5, 1 - (3 * (1 - v) + 2) / 5))
    lines = np.minimum(np.minimum(u, 1 - u), np.minimum(v, 1 - v)) < 0.1
    exr("grid", np.where(lines, 0.4, 0.2)[..., None].repeat(3, axis=-1))
    exr("waves", (0.5 + 0.5 * np.sin(6 * np.pi * u) * np.cos(4 * np.pi * v))[..., None].repeat(3, axis=-1)[::4, ::4])
    # Mitsuba 0.6 has the middles of rows where 3 has the rows themselves.
    for name, theta in (("round6", (np.arange(256) + 0.5) / 256), ("round", np.arange(513) / 512)):
        phi, theta = np.meshgrid(2 * np.pi * (np.arange(512) + 0.5) / 512, np.pi * theta)
        d = np.sin(phi) * np.sin(theta), np.cos(theta), -np.cos(phi) * np.sin(theta)
        bright = np.exp(20 * (0.4 * d[0] + 0.768 * d[1] + 0.5 * d[2] - 1))
        exr(name, np.stack([0.3 + 0.2 * d[1] + 8 * bright, 0.4 + 7 * bright, 0.5 + 0.1 * d[0] + 5 * bright], axis=-1))
    ramp = np.round(255 * np.stack([0.2 + 0.6 * v, 0.7 - 0.4 * u, 0.5 + 0 * u], axis=-1)[::16, ::16]).astype(np.uint8)
    ramp = ramp[:, np.r_[0:64, 63:-1:-1]]
    mi.Bitmap(ramp).write("sky.png")
    rows = np.clip((np.arange(257) / 256) * 64 - 0.5, 0, 63)
    low = np.minimum(rows.astype(int), 62)
    for name, values in (("sky_decoded", decoded(ramp / 255)), ("sky_raw", ramp / 255)):
        share = (rows - low)[:, None, None]
        exr(name, (1 - share) * values[low] + share * values[low + 1])
    write_meshes()
    with open("part.xml", "w", encoding="utf-8") as out:
        out.write('<scene version="0.6.0"><shape type="sphere"><point name="center" x="0" y="1" z="0"/><bsdf type="diffuse">')
        out.write('<rgb name="reflectance" value="0.8,0.1,0.1"/></bsdf></shape></scene>')
