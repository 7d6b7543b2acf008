"""scene/library/still_life.glb: a table with a lighthouse, a bottle with a twig, a glass ball, a brass bowl
on a cloth; the lighthouse's lamp and a panel out of view shine. Made for --env evening_sky."""

import math

from files import Gltf
from pictures import Planks, leaf, stripes, weave
from shapes import Mesh, arc, box, grid, lathe, quad, tube

LINEAR_MIPMAP, REPEAT = 9987, 10497


def table(gltf):
    planks = Planks(256)
    sampler = {"magFilter": 9729, "minFilter": LINEAR_MIPMAP, "wrapS": REPEAT, "wrapT": REPEAT}
    wood = gltf.material("oiled planks", pbr={
        "baseColorTexture": {"index": gltf.texture(planks.color(), **sampler)},
        "metallicRoughnessTexture": {"index": gltf.texture(planks.roughness(), **sampler)}},
        normalTexture={"index": gltf.texture(planks.normal(), **sampler)})
    gltf.place("table", box((-0.75, -0.045, -0.42), (0.75, 0, 0.42), (1.5, 1.5)), wood)


def lighthouse(gltf):
    paint = gltf.material("varnished paint", roughness=0.55, extensions={
        "clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.04}},
        pbr={"baseColorTexture": {"index": gltf.texture(stripes())}})
    roof = gltf.material("red paint", base=(0.45, 0.012, 0.01, 1), roughness=0.5, extensions={
        "clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.04}})
    lamp = gltf.material("lamp", base=(0, 0, 0, 1), emissiveFactor=[1, 0.72, 0.36],
                         extensions={"emissive_strength": {"emissiveStrength": 7}})
    at = {"translation": [-0.26, 0, -0.06]}
    # The picture's v follows the line: 0.18 of it is the gallery.
    tower = [(0.078 - 0.031 * (h / 0.27) ** 0.7, h) for h in (0, 0.03, 0.06, 0.1, 0.15, 0.2, 0.27)]
    gallery = [(0.047, 0.27), (0.063, 0.275), (0.063, 0.275), (0.063, 0.286), (0.063, 0.286), (0.028, 0.286)]
    gltf.place("tower", lathe(tower + gallery, 40), paint, **at)
    gltf.place("lamp", lathe([(0.027, 0.286), (0.027, 0.328)], 24, textured=False), lamp, **at)
    hat = [(0, 0.326), (0.044, 0.326), (0.044, 0.326), (0.006, 0.366), (0.006, 0.366)]
    ball = arc((0, 0.374), 0.01, -60, 90, 8)
    gltf.place("roof", lathe(hat[:-1], 32, textured=False).append(lathe(ball, 16, textured=False)), roof, **at)


def glass(name, gltf, color, distance):
    return gltf.material(name, roughness=0, extensions={
        "transmission": {"transmissionFactor": 1}, "ior": {"ior": 1.5},
        "volume": {"thicknessFactor": 0.01, "attenuationColor": color, "attenuationDistance": distance}})


def bottle(gltf):
    """A hollow one: the line goes up outside, over the rim, and down inside."""
    green = glass("green glass", gltf, [0.25, 0.66, 0.42], 0.012)
    outside = ([(0, 0.001), (0.04, 0.001)] + arc((0.044, 0.009), 0.008, -90, 0, 4)[1:]
               + arc((0.012, 0.12), 0.04, 0, 55, 6) + arc((0.0565, 0.1835), 0.0375, 235, 180, 5)
               + [(0.019, 0.225)] + arc((0.017, 0.2285), 0.0035, -30, 160, 5))
    inside = [(0.0135, 0.2285), (0.0135, 0.19)] + arc((0.011, 0.118), 0.036, 55, 0, 6) + \
             [(0.047, 0.03)] + arc((0.035, 0.019), 0.012, 0, -90, 4) + [(0, 0.007)]
    gltf.place("bottle", lathe(outside + inside, 44, textured=False), green, translation=[0.07, 0, -0.13])


def twig(gltf):
    bark = gltf.material("bark", base=(0.13, 0.075, 0.035, 1), roughness=0.9)
    leaves = gltf.material("leaves", roughness=0.55, alphaMode="MASK", alphaCutoff=0.5, doubleSided=True,
                           pbr={"baseColorTexture": {"index": gltf.texture(leaf())}})

    def stem(t):
        return (0.012 - 0.02 * t + 0.085 * t * t, 0.012 + 0.40 * t, -0.006 + 0.03 * t * t)

    at = {"translation": [0.07, 0, -0.13]}
    gltf.place("stem", tube([stem(k / 14) for k in range(15)], 0.0022, 7), bark, **at)
    foliage = Mesh()
    for k in range(9):
        foot = stem(0.56 + 0.055 * k)
        turn = 2.4 * k + 0.4
        size = 0.105 - 0.005 * k
        rise = 0.25 + 0.09 * k

        def surface(u, v, turn=turn, size=size, rise=rise):
            out = size * u
            side = size * 0.55 * (v - 0.5)
            up = rise * out - 4.5 * out * out + 6 * side * side
            return (out * math.cos(turn) - side * math.sin(turn), up, -out * math.sin(turn) - side * math.cos(turn))

        foliage.append(grid(6, 2, surface).moved(*foot))
    gltf.place("leaves", foliage, leaves, **at)


def ball(gltf):
    amber = glass("amber glass", gltf, [0.95, 0.50, 0.12], 0.06)
    gltf.place("ball", lathe(arc((0, 0.0655), 0.065, -90, 90, 20), 40, textured=False), amber,
               translation=[-0.07, 0, 0.15])


def bowl(gltf):
    """Brushed on a lathe: u, and so the tangents, run around."""
    brass = gltf.material("brushed brass", base=(0.91, 0.66, 0.33, 1), metallic=1, roughness=0.32, extensions={
        "anisotropy": {"anisotropyStrength": 0.85, "anisotropyRotation": 0}})
    outside = [(0, 0), (0.05, 0), (0.05, 0)] + [(0.05 + 0.065 * math.sin(math.radians(a)),
                                                 0.085 * (1 - math.cos(math.radians(a)))) for a in range(8, 81, 9)]
    rim = outside[-1]
    inside = [(rim[0] - 0.003, rim[1] + 0.001)] + [(0.047 + 0.065 * math.sin(math.radians(a)),
                                                    0.003 + 0.085 * (1 - math.cos(math.radians(a))))
                                                   for a in range(80, 7, -9)] + [(0.047, 0.003), (0, 0.003)]
    gltf.place("bowl", lathe(outside + inside, 48), brass, translation=[0.27, 0.0085, 0.07])


def cloth(gltf):
    """A runner that hangs over the front edge. Its sheen is what velvet has at grazing angles."""
    gltf.use("KHR_texture_transform")
    threads = {"index": gltf.texture(weave()),
               "extensions": {"KHR_texture_transform": {"scale": [10, 14], "rotation": 0.03}}}
    velvet = gltf.material("velvet", roughness=0.9, pbr={"baseColorTexture": threads}, doubleSided=True, extensions={
        "sheen": {"sheenColorFactor": [0.55, 0.62, 0.9], "sheenRoughnessFactor": 0.35}})
    edge, hang, bend = 0.42, 0.16, 0.012
    flat = 0.50
    around = bend * math.pi / 2

    def surface(u, v):
        s = v * (flat + around + hang)  # along the cloth, from the back
        x = 0.10 + 0.36 * u
        wave = math.sin(13 * u + 1.1 * math.sin(4 * v)) + 0.5 * math.sin(29 * u + 2)
        if s < flat:
            y, z, fold = 0.004, edge - flat + s, 0.0012
            y += fold * (1 + wave / 1.5) * (0.3 + 0.7 * s / flat)
            return (x, y, z)
        if s < flat + around:
            a = (s - flat) / bend
            lift = 0.004 + 0.0012 * (1 + wave / 1.5)
            return (x, -bend + (bend + lift) * math.cos(a), edge + (bend + lift) * math.sin(a))
        down = s - flat - around
        out = bend + 0.004 + 0.0012 * (1 + wave / 1.5) + 0.09 * down * (1 + wave / 1.5)
        return (x + 0.05 * down * math.sin(13 * u), -bend - down, edge + out)

    # Rows: few where it is flat, more where it bends. v grows towards the viewer, so du x dv is down:
    # the columns run from right to left to have it up.
    gltf.place("cloth", grid(36, 30, lambda u, v: surface(1 - u, v)), velvet)


def panel(gltf):
    light = gltf.material("panel", base=(0, 0, 0, 1), emissiveFactor=[1, 0.86, 0.7],
                          extensions={"emissive_strength": {"emissiveStrength": 14}})
    gltf.place("panel", quad((0.75, 0.55, 0.75), (-0.12, 0.30, 0.0), (-0.30, 0, 0.22)), light)


def still_life():
    gltf = Gltf("A table with a lighthouse, a bottle, a glass ball and a brass bowl on a cloth: textures and "
                "layered materials.")
    gltf.camera("camera", 0.50, (0.06, 0.47, 1.32), (0.03, 0.135, 0.0))
    for part in (table, lighthouse, bottle, twig, ball, bowl, cloth, panel):
        part(gltf)
    return gltf.glb()
