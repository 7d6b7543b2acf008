"""scene/library/texture_chart.glb: small pictures on a board that show, each by itself, what textures and
their relatives do."""

import math

from files import Gltf
from pictures import mix, paint, smooth
from shapes import quad

NEAREST, LINEAR = 9728, 9729
CLAMP, MIRROR, REPEAT = 33071, 33648, 10497
SIDE, STEP = 0.9, 1.0  # of a tile; from tile to tile


def arrow():
    """Neither left and right nor up and down are the same; two edges are dark, two are not."""
    def at(u, v):
        stem = abs(u - 0.4) < 0.07 and 0.2 < v < 0.85
        bar = 0.24 < v < 0.42 and 0.4 < u < 0.8
        if min(u, v) < 0.06:
            return (0.12, 0.15, 0.2)
        return (0.85, 0.25, 0.1) if stem or bar else mix((0.95, 0.9, 0.75), (0.4, 0.7, 0.8), v)

    return paint(32, 32, at)


def blocks():
    colors = [(0.9, 0.2, 0.15), (0.95, 0.8, 0.2), (0.2, 0.6, 0.3), (0.15, 0.3, 0.75)]
    return paint(4, 4, lambda u, v: colors[(int(4 * u) + 2 * int(4 * v)) % 4])


def disk():
    """Alpha falls from the middle: a soft edge for blending, a sharp one where it is cut off."""
    return paint(32, 32, lambda u, v: (0.9, 0.5, 0.1, 1 - smooth(0.2, 0.48, math.hypot(u - 0.5, v - 0.5))))


def stripes():
    return paint(32, 32, lambda u, v: (0.9, 0.9, 0.9) if int((u + v) * 5) % 2 else (0.12, 0.12, 0.15))


def bumps():
    """Normals of a hemisphere in the middle: its upper half must look up."""
    def at(u, v):
        x, y = (u - 0.5) / 0.4, (0.5 - v) / 0.4
        r2 = x * x + y * y
        n = (x, y, math.sqrt(1 - r2)) if r2 < 0.9 else (0, 0, 1)
        return tuple(c * 127 / 255 + 128 / 255 for c in n)

    return paint(64, 64, at)


def spread(low, high):
    """Texture coordinates of a quad that reach from low to high on both axes."""
    return ((low, high), (high, high), (high, low), (low, low))


class Chart:
    def __init__(self, gltf):
        self.gltf = gltf

    def tile(self, column, row, name, material, uvs=spread(0, 1), colors=(), lift=0.02):
        """Rows count from the top; the chart's middle is the origin."""
        x, y = (column - 1.5) * STEP - SIDE / 2, (1 - row) * STEP - SIDE / 2
        mesh = quad((x, y, lift), (SIDE, 0, 0), (0, SIDE, 0), uvs)
        mesh.colors = list(colors)
        self.gltf.place(name, mesh, material)

    def textured(self, name, texture, transform=None, **rest):
        use = {"index": texture}
        if transform:
            self.gltf.use("KHR_texture_transform")
            use["extensions"] = {"KHR_texture_transform": transform}
        return self.gltf.material(name, pbr={"baseColorTexture": use}, **rest)


def texture_chart():
    gltf = Gltf("Wrap modes, filters, transforms, vertex colours, alpha and thin glass, each on a tile.")
    gltf.camera("camera", 0.62, (0, 0, 5.6), (0, 0, 0))
    chart = Chart(gltf)
    board = gltf.material("board", base=(0.35, 0.35, 0.37, 1))
    gltf.place("board", quad((-2.6, -1.9, 0), (5.2, 0, 0), (0, 3.8, 0)), board)

    # Row 1: the picture one and a half times beyond its edges by three wrap modes, and turned.
    for column, (name, wrap) in enumerate((("repeat", REPEAT), ("mirror", MIRROR), ("clamp", CLAMP))):
        texture = gltf.texture(arrow(), magFilter=LINEAR, wrapS=wrap, wrapT=wrap)
        chart.tile(column, 0, name, chart.textured(name, texture), spread(-0.75, 1.75))
    turned = chart.textured("transform", gltf.texture(arrow(), magFilter=LINEAR),
                            {"rotation": math.pi / 4, "scale": [1.5, 1.5], "offset": [-0.2, 0.6]})
    chart.tile(3, 0, "transform", turned)

    # Row 2: sixteen texels by both filters, colours of vertices, a normal map.
    for column, (name, kind) in enumerate((("nearest", NEAREST), ("linear", LINEAR))):
        texture = gltf.texture(blocks(), magFilter=kind, minFilter=kind)
        chart.tile(column, 1, name, chart.textured(name, texture))
    white = gltf.material("vertex colors")
    chart.tile(2, 1, "vertex colors", white,
               colors=[(255, 32, 32, 255), (32, 255, 32, 255), (32, 32, 255, 255), (255, 255, 32, 255)])
    dome = gltf.material("normal map", base=(0.6, 0.6, 0.6, 1), roughness=0.5,
                         normalTexture={"index": gltf.texture(bumps(), magFilter=LINEAR)})
    chart.tile(3, 1, "normal map", dome)

    # Row 3: over stripes, alpha that cuts and that blends, and thin glass, clear and rough.
    striped = chart.textured("stripes", gltf.texture(stripes(), magFilter=NEAREST))
    soft = gltf.texture(disk(), magFilter=LINEAR)
    thin = {"transmission": {"transmissionFactor": 1}}
    above = [chart.textured("mask", soft, alphaMode="MASK", alphaCutoff=0.5),
             chart.textured("blend", soft, alphaMode="BLEND"),
             gltf.material("tinted pane", base=(0.5, 0.85, 0.95, 1), roughness=0, extensions=thin),
             gltf.material("rough pane", base=(0.95, 0.8, 0.6, 1), roughness=0.35, extensions=thin)]
    for column, material in enumerate(above):
        chart.tile(column, 2, "stripes", striped)
        chart.tile(column, 2, gltf.document["materials"][material]["name"], material, lift=0.15)

    light = gltf.material("panel", base=(0, 0, 0, 1), emissiveFactor=[1, 1, 1],
                          extensions={"emissive_strength": {"emissiveStrength": 6}})
    gltf.place("panel", quad((-3, 2.6, 2), (6, 0, 0), (0, -0.6, 2.4)), light)
    return gltf.glb()
