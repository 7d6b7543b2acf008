"""Pictures of surfaces. In all of them v points down; those that repeat do so without a seam."""

import math
import random

from files import png
from pictures import mix, paint, smooth


class Noise:
    """Smooth noise in [0, 1] that repeats after the periods."""

    def __init__(self, columns, rows, seed):
        dice = random.Random(seed)
        self.columns, self.rows = columns, rows
        self.lattice = [[dice.random() for _ in range(columns)] for _ in range(rows)]

    def __call__(self, u, v):
        x, y = u * self.columns, v * self.rows
        i, j = math.floor(x), math.floor(y)
        x, y = x - i, y - j
        x, y = x * x * (3 - 2 * x), y * y * (3 - 2 * y)
        i, k = i % self.columns, (i + 1) % self.columns
        upper, lower = self.lattice[j % self.rows], self.lattice[(j + 1) % self.rows]
        a, b = upper[i], lower[i]
        a += (upper[k] - a) * x
        return a + (b + (lower[k] - b) * x - a) * y


def relief(size, height, strength):
    """The normal map of a height: at(u, v) in shares of the picture's side."""
    rows = [[height((x + 0.5) / size, (y + 0.5) / size) for x in range(size)] for y in range(size)]
    texels = []
    for y in range(size):
        above, row, below = rows[y - 1], rows[y], rows[(y + 1) % size]
        for x in range(size):
            n = ((row[x - 1] - row[(x + 1) % size]) * strength * size / 2,
                 (below[x] - above[x]) * strength * size / 2, 1.0)
            length = math.sqrt(n[0] * n[0] + n[1] * n[1] + 1)
            texels.append(tuple(2 * int((c / length * 127 + 128) / 2) for c in n))
    return png(size, size, texels)


def floor_boards(light, dark, seed, size=384, rows=6):
    """Boards along u, two in a row, with ends that are shifted from row to row."""
    dice = random.Random(seed)
    grain, fibres = Noise(6, 48, seed + 1), Noise(8, 160, seed + 2)
    shades = [[dice.random() for _ in range(2)] for _ in range(rows)]
    ends = [dice.random() for _ in range(rows)]
    slips = [dice.random() for _ in range(rows)]

    def at(u, v):
        row = int(v * rows)
        along = (u + ends[row]) % 1
        board = int(2 * along)
        across = v * rows % 1
        seam = max(1 - smooth(0.0, 0.04, min(across, 1 - across)),
                   1 - smooth(0.0, 0.006,
                              min(2 * along % 1, 1 - 2 * along % 1) / 2))
        bend = grain(u + 0.31 * board, v + slips[row] * 3)
        rings = 0.5 + 0.5 * math.sin(14 * bend + 9 * across + 5 * board + 7 * row)
        color = mix(light, dark, 0.45 * rings * bend + 0.35 * fibres(u, v) + 0.32 * shades[row][board])
        return mix(color, (0.05, 0.03, 0.02), 0.85 * seam)

    return paint(size, size, at, 5)


def rug(size=320):
    """A border of diamonds about a field with a medallion: v is the short side."""
    red, blue, cream, gold = (0.60, 0.15, 0.13), (0.13, 0.19, 0.34), (0.85, 0.77, 0.62), (0.74, 0.52, 0.24)
    wear = Noise(24, 24, 41)

    def pattern(u, v):
        x, y = abs(u - 0.5) * 1.5, abs(v - 0.5)
        edge = min(0.75 - x, 0.5 - y)
        if edge < 0.02:
            return blue
        if edge < 0.035 or 0.125 < edge < 0.14:
            return gold
        if edge < 0.125:
            along = (v if 0.75 - x < 0.5 - y else 1.5 * u) * 13
            a, b = abs(along % 1 - 0.5), abs(edge - 0.08) / 0.09
            return cream if a + b < 0.22 else red if a + b < 0.42 else blue
        middle = x * 0.75 + y
        if middle < 0.33:
            ring = int(middle * 30)
            petal = 0.5 + 0.5 * math.cos(8 * math.atan2(y, x))
            return (gold, red, cream, blue, gold, blue, blue, cream, red,
                    gold)[ring % 10] if middle + 0.05 * petal < 0.31 else gold
        a, b = (18 * u) % 1 - 0.5, (12 * v) % 1 - 0.5
        flower = abs(a) + abs(b)
        return cream if flower < 0.13 else gold if flower < 0.24 and abs(abs(a) - abs(b)) < 0.1 else red

    def at(u, v):
        color = pattern(u, v)
        thread = 0.86 + 0.14 * ((int(u * size) + int(v * size)) % 2)
        worn = 0.8 + 0.3 * wear(u, v)
        return tuple(c * thread * worn for c in color)

    return paint(size, size * 2 // 3, at, 6)


SPINES = 16


def spines(size=256):
    """Backs of books beside each other: cloth or leather, bands and titles of gold."""
    dice = random.Random(5)
    cloths = ((0.30, 0.05, 0.05), (0.07, 0.13, 0.24), (0.08, 0.19, 0.11), (0.36, 0.24, 0.12), (0.62, 0.54, 0.40),
              (0.16, 0.08, 0.05), (0.45, 0.14, 0.05), (0.10, 0.10, 0.11), (0.19, 0.27, 0.30), (0.50, 0.37, 0.10),
              (0.33, 0.33, 0.31), (0.22, 0.06, 0.14))
    books = [(cloths[k % len(cloths)], dice.choice((1, 2, 2, 3)), dice.uniform(0.08, 0.3), dice.random() < 0.6,
              [dice.random() for _ in range(40)]) for k in range(SPINES)]
    dirt = Noise(64, 16, 6)

    def at(u, v):
        k = min(int(u * SPINES), SPINES - 1)
        cloth, bands, label, gilt, letters = books[k]
        x = u * SPINES - k
        ink = (0.75, 0.56, 0.22) if gilt else tuple(min(1.0, 0.15 + 1.6 * c) for c in cloth)
        color = tuple(c * (0.75 + 0.4 * dirt(u, v)) for c in cloth)
        for band in range(bands + 1):
            if abs(v - (0.06 + 0.88 * band / bands)) < 0.008:
                color = ink
        title = v - 0.12
        if 0 < title < label and 0.22 < x < 0.78:
            row, place = int(title / 0.028), int(x * 9)
            if title % 0.028 < 0.016 and letters[(row * 7 + place) % 40] < 0.72:
                color = ink
        return tuple(c * (0.55 + 0.45 * math.sin(math.pi * min(max(x, 0.04), 0.96)) ** 0.5) for c in color)

    return paint(size, size, at, 6)


def landscape(seed, size=128):
    """A painted view: hills behind hills under a sky."""
    ridges = [Noise(5 + 2 * k, 1, seed + k) for k in range(4)]
    strokes = Noise(48, 24, seed + 9)
    hills = ((0.42, 0.49, 0.58), (0.33, 0.42, 0.42), (0.24, 0.33, 0.20), (0.36, 0.30, 0.12))

    def at(u, v):
        color = mix((0.36, 0.50, 0.68), (0.92, 0.78, 0.58), v * 1.9)
        for k, (ridge, hill) in enumerate(zip(ridges, hills)):
            top = 0.36 + 0.15 * k + 0.2 * (ridge(u, 0.2) - 0.5)
            if v > top:
                color = mix(hill, tuple(0.55 * c for c in hill), (v - top) * 2.5)
        return tuple(c * (0.82 + 0.36 * strokes(u, v)) for c in color)

    return paint(size, size * 3 // 4, at, 5)


def wallpaper(ground, figure, size=192):
    """Stripes with a row of leaves between them."""
    paper = Noise(64, 64, 71)

    def at(u, v):
        x = (2 * u) % 1
        y = (3 * v + 0.5 * int(2 * u)) % 1
        a = abs(x - 0.5)
        leaf = a < 0.2 * math.sin(
            math.pi * min(1.0, y * 1.35))**1.3 * (0.75 + 0.25 * math.cos(38 * y)) and y < 0.74 and a > 0.012
        line = abs(a - 0.42) < 0.012 or abs(a - 0.46) < 0.006
        color = figure if leaf or line else ground
        return tuple(c * (0.92 + 0.12 * paper(u, v)) for c in color)

    return paint(size, size, at, 6)


def tile_joint(u, v, count, width):
    """1 in the joints of square tiles, 0 on them, and which tile it is."""
    x, y = u * count, v * count
    a, b = x % 1, y % 1
    return 1 - smooth(0.3 * width, width, min(a, 1 - a, b, 1 - b)), (int(x) % count) * count + int(y) % count


def tiles(colors, joint, count, width, seed, size=256):
    dice = random.Random(seed)
    picks = [(dice.choice(colors), dice.uniform(0.9, 1.06)) for _ in range(count * count)]
    cloud = Noise(24, 24, seed)

    def at(u, v):
        gap, k = tile_joint(u, v, count, width)
        color, shade = picks[k]
        return mix(tuple(c * shade * (0.93 + 0.12 * cloud(u, v)) for c in color), joint, gap)

    return paint(size, size, at, 4)


def tile_relief(count, width, seed, size=256):
    """Joints, and glaze that is a little uneven; each tile leans a bit."""
    dice = random.Random(seed)
    leans = [(dice.uniform(-1, 1), dice.uniform(-1, 1)) for _ in range(count * count)]
    waves = Noise(3 * count, 3 * count, seed)

    def height(u, v):
        gap, k = tile_joint(u, v, count, 2 * width)
        lean = leans[k]
        tilt = lean[0] * (u * count % 1 - 0.5) + lean[1] * (v * count % 1 - 0.5)
        return (0.0011 * tilt + 0.0009 * waves(u, v)) * (1 - gap) - 0.006 * gap

    return relief(size, height, 1.0)


def stone(light, dark, seed, size=256):
    """Limestone: clouds, pores."""
    large, middle, fine = Noise(5, 5, seed), Noise(21, 21, seed + 1), Noise(96, 96, seed + 2)

    def at(u, v):
        t = 0.5 * large(u, v) + 0.3 * middle(u, v) + 0.35 * fine(u, v)
        pore = smooth(0.84, 0.93, fine(u + 0.37, v)) * 0.3
        return mix(mix(light, dark, t), tuple(0.5 * c for c in dark), pore)

    return paint(size, size, at, 5)


def ashlar(light, dark, seed, size=256):
    """Blocks of stone in courses, for walls."""
    dice = random.Random(seed)
    shades = [dice.random() for _ in range(64)]
    grain = Noise(64, 64, seed + 1)
    large = Noise(6, 6, seed + 2)

    def at(u, v):
        row = int(v * 6)
        x = (3 * u + 0.5 * (row % 2)) % 3
        a, b = x % 1, v * 6 % 1
        gap = 1 - smooth(0.006, 0.02, min(a, 1 - a, b / 2, (1 - b) / 2))
        color = mix(light, dark, 0.35 * grain(u, v) + 0.3 * large(u, v) + 0.35 * shades[row * 3 + int(x)])
        return mix(color, tuple(0.45 * c for c in dark), gap)

    return paint(size, size, at, 5)


def banner(field, charge, seed, size=128):
    """Cloth of one colour with a border, a star and bars; twice as high as wide."""
    threads = Noise(64, 128, seed)

    def at(u, v):
        x, y = u - 0.5, (v - 0.3) * 2
        turn, far = math.atan2(y, x), math.hypot(x, y)
        star = far < 0.17 + 0.1 * abs(math.cos(4 * turn)) ** 3 and far > 0.07
        border = 0.04 < min(u, 1 - u) < 0.075
        bars = v > 0.62 and (v - 0.62) * 12 % 1 < 0.42 and 0.16 < u < 0.84
        color = charge if star or border or bars else field
        return tuple(c * (0.82 + 0.3 * threads(u, v)) for c in color)

    return paint(size, 2 * size, at, 6)


def _twig(u, v):
    """A twig of eight pairs of leaflets that grows along u: its colour, and whether there is any."""
    y = abs(v - 0.5) * 2
    inside, across = y < 0.035 and u < 0.9, 0.0
    for k in range(8):
        x = u - (0.06 + 0.115 * k) - 0.2 * y
        reach = 0.98 * math.sin(math.pi * (0.12 + 0.8 * (k + 1) / 9)) ** 0.7
        if 0 < y < reach and abs(x) < 0.048 * math.sin(math.pi * y / reach) ** 0.6:
            inside, across = True, abs(x) / 0.048
    return mix((0.30, 0.46, 0.20), (0.52, 0.66, 0.32), 0.4 * (1 - across) + 0.4 * u), inside


def twig_color(size=128):
    return paint(size, size // 2, lambda u, v: _twig(u, v)[0], 6)


def twig_opacity(size=128):
    return paint(size, size // 2, lambda u, v: (float(_twig(u, v)[1]),) * 3)
