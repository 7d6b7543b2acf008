"""Computed pictures: what the scenes' surfaces show, and a sky."""

import math

from files import hdr, png


def _hash(x, y, seed):
    """A fixed number in [0, 1) for each place: integers alone, the same on every machine."""
    h = (x * 0x9E3779B1 ^ y * 0x85EBCA6B ^ seed * 0xC2B2AE35) & 0xFFFFFFFF
    for factor in (0x7FEB352D, 0x846CA68B):
        h = ((h ^ h >> 16) * factor) & 0xFFFFFFFF
    return (h ^ h >> 16) / 2**32


def noise(x, y, period_x, period_y, seed):
    """Value noise in [0, 1], smooth, that repeats after the periods."""
    i, j = math.floor(x), math.floor(y)
    fx, fy = (t * t * (3 - 2 * t) for t in (x - i, y - j))
    a, b, c, d = (_hash((i + k) % period_x, (j + m) % period_y, seed) for m in (0, 1) for k in (0, 1))
    return (a + (b - a) * fx) * (1 - fy) + (c + (d - c) * fx) * fy


def mix(a, b, t):
    t = min(max(t, 0.0), 1.0)
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def smooth(low, high, x):
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)


def texel(color, step=1):
    """Bytes of a colour in [0, 1]; a coarse step makes few colours, and so a small file."""
    return tuple(min(255, max(0, step * round(c * 255 / step))) for c in color)


def paint(width, height, at, step=1):
    """The picture of at(u, v), v downwards."""
    return png(width, height, [texel(at((x + 0.5) / width, (y + 0.5) / height), step)
                               for y in range(height) for x in range(width)])


class Planks:
    """Four oiled planks along u, which repeat."""

    COUNT = 4

    def __init__(self, size):
        self.size = size

    def grain(self, u, v):
        """0 (early wood) to 1 (late wood)."""
        plank = int(v * self.COUNT) % self.COUNT
        bend = noise(3 * u, 8 * v, 3, 8, 10 + plank)
        rings = 0.5 + 0.5 * math.sin(2 * math.pi * (5 * (v * self.COUNT % 1) + 2.2 * bend + 0.37 * plank))
        fibres = noise(12 * u, 128 * v, 12, 128, 20 + plank)
        return 0.6 * rings + 0.4 * fibres

    def groove(self, v):
        """1 between planks."""
        across = v * self.COUNT % 1
        return 1 - smooth(0.0, 0.035, min(across, 1 - across))

    def color(self):
        def at(u, v):
            plank = int(v * self.COUNT) % self.COUNT
            color = mix((0.60, 0.42, 0.27), (0.39, 0.24, 0.14), self.grain(u, v))
            color = mix(color, (0.52, 0.38, 0.27), 0.5 * _hash(plank, 0, 3))
            return mix(color, (0.08, 0.05, 0.03), self.groove(v))

        return paint(self.size, self.size, at, 6)

    def normal(self):
        def height(u, v):
            return 0.0012 * self.grain(u, v) - 0.006 * self.groove(v)

        def at(u, v):
            # Differences over a texel; v points down in the picture, and the map's y up.
            h = 0.5 / self.size
            slope_u = (height(u + h, v) - height(u - h, v)) / (2 * h)
            slope_v = (height(u, v + h) - height(u, v - h)) / (2 * h)
            n = (-slope_u, slope_v, 1.0)
            length = math.sqrt(sum(x * x for x in n))
            return tuple(x / length * 127 / 255 + 128 / 255 for x in n)

        return paint(self.size, self.size, at, 2)

    def roughness(self):
        """Late wood takes more oil and is smoother; blue, metal, is 0."""
        return paint(self.size, self.size, lambda u, v: (0, 0.62 - 0.22 * self.grain(u, v), 0), 8)


def stripes():
    """The lighthouse's paint: v = 0 at its top. Red and white, a door, three windows."""
    white, red, dark = (0.90, 0.88, 0.83), (0.72, 0.06, 0.05), (0.05, 0.06, 0.09)

    def at(u, v):
        if v < 0.18:
            return red if v < 0.02 else white  # the gallery
        if abs(u - 0.06) < 0.045 and v > 0.86 or any(abs(u - 0.06) < 0.02 and abs(v - w) < 0.022
                                                       for w in (0.35, 0.51, 0.68)):
            return dark
        return red if int((v - 0.18) / 0.1367) % 2 == 0 else white

    return paint(128, 256, at)


def leaf():
    """A leaf that grows to the right, with what is not leaf cut away (alpha 0)."""
    def at(u, v):
        across = abs(v - 0.5) * 2
        half_width = 0.86 * math.sin(math.pi * min(1.0, u * 0.98 + 0.01) ** 0.75) ** 0.9
        teeth = 0.05 * abs((u * 11) % 1 - 0.5)
        inside = across < half_width - teeth or (across < 0.05 and u < 0.1)
        vein = max(1 - smooth(0.0, 0.05, across),
                   0.7 * (1 - smooth(0.0, 0.12, abs((u * 7 - across * 2.2) % 1 - 0.5) * 2)) * (1 - across))
        green = mix((0.16, 0.33, 0.09), (0.28, 0.46, 0.13), noise(6 * u, 6 * v, 7, 7, 5))
        color = mix(green, (0.52, 0.62, 0.30), vein)
        return (*color, 1.0 if inside else 0.0)

    return paint(96, 64, at, 5)


def weave():
    """A cloth's threads, over and under."""
    def at(u, v):
        a, b = int(u * 8), int(v * 8)
        along = (u * 8 % 1) if (a + b) % 2 else (v * 8 % 1)
        shade = 0.72 + 0.28 * math.sin(math.pi * along)
        return (0.10 * shade, 0.22 * shade, 0.45 * shade)

    return paint(32, 32, at, 2)


def evening_sky():
    """An equirectangular picture of 256 x 128: a low sun on the left of -z, the sky, a dark sea."""
    width, height = 256, 128
    azimuth, elevation = math.radians(-52), math.radians(17)  # from -z towards +x; above the horizon
    sun = (math.cos(elevation) * math.sin(azimuth), math.sin(elevation), -math.cos(elevation) * math.cos(azimuth))

    def sky(d):
        up = d[1]
        toward = sum(a * b for a, b in zip(d, sun))
        color = mix((0.95, 0.55, 0.34), (0.42, 0.47, 0.66), up / 0.28)
        color = mix(color, (0.10, 0.19, 0.42), (up - 0.15) / 0.85)
        glow = max(toward, 0.0)
        warm = 0.9 * glow**6 + 2.5 * glow**60
        color = tuple(c + warm * w for c, w in zip(color, (1.0, 0.55, 0.22)))
        # Long thin clouds above the horizon, lit from below.
        around = math.atan2(d[0], -d[2]) / (2 * math.pi) + 0.5
        cloud = noise(24 * around, 40 * up, 24, 64, 7) * 0.65 + noise(64 * around, 90 * up, 64, 128, 8) * 0.35
        cloud = smooth(0.52, 0.75, cloud) * smooth(0.03, 0.12, up) * (1 - smooth(0.3, 0.55, up))
        return mix(color, (1.05 + warm, 0.62 + 0.5 * warm, 0.52 + 0.2 * warm), 0.7 * cloud)

    radiance = []
    for y in range(height):
        theta = math.pi * (y + 0.5) / height
        for x in range(width):
            phi = 2 * math.pi * ((x + 0.5) / width - 0.5)
            d = (math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi))
            if d[1] >= 0:
                color = sky(d)
                angle = math.degrees(math.acos(min(1.0, sum(a * b for a, b in zip(d, sun)))))
                disk = 1 - smooth(2.6, 4.0, angle)
                color = tuple(c + disk * s for c, s in zip(color, (260, 165, 85)))
            else:
                # The sea mirrors the sky the less, the steeper it is seen.
                mirrored = sky((d[0], -d[1], d[2]))
                part = 0.06 + 0.6 * (1 + d[1]) ** 6
                color = tuple(0.02 * w + part * m for w, m in zip((0.3, 0.6, 1.0), mirrored))
            radiance.append(color)
    return hdr(width, height, radiance)
