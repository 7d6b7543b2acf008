#!/usr/bin/env python3
"""rooms_at_night.py FOLDER [ROOMS]: writes rooms that lamps light, for against_mitsuba.py, in Mitsuba 3's syntax.

globe is a bare room with a bulb in a globe of glass, to which globe_and_panel adds a panel with eight times its light.
closed_by_day is that room with nine panels, under a sky of which nothing comes in.
reading_room and bathroom are the bundled ones without their skies: a lamp in a shade; bulbs in globes, and a lamp at
the ceiling. With ROOMS, a folder with the rooms of other renderers (each with a mitsuba3.xml), there are also
classroom, lit by twelve lamps or by the sun alone, and living-room, lit by three bulbs. Each is FOLDER/NAME/scene.xml.
"""
import os
import re
import sys

LIBRARY = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scene", "library")
SKY = re.compile(r'<emitter type="(?:constant|directional|envmap|sunsky|sky)".*?</emitter>', re.DOTALL)
SUN = """<emitter type="directional"><vector name="direction" x="0.865804" y="-0.416766" z="0.276929"/>
  <rgb name="irradiance" value="60, 54, 42"/></emitter>"""


EVENING = f"""<emitter type="envmap"><string name="filename" value="{os.path.abspath(LIBRARY)}/evening_sky.hdr"/>
  <float name="scale" value="16"/></emitter>"""


GREY = '<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.7"/></bsdf></bsdf>'
BARE_ROOM = f"""<scene version="3.0.0">
<integrator type="path"><integer name="max_depth" value="17"/></integrator>
<sensor type="perspective"><float name="fov" value="70"/><transform name="to_world"><lookat origin="0, 1.2, 1.9" target="0, 1, 0"
  up="0, 1, 0"/></transform><film type="hdrfilm"><rfilter type="box"/></film></sensor>
<shape type="cube"><transform name="to_world"><scale x="2" y="1.25" z="2"/><translate y="1.25"/></transform>{GREY}</shape>
<shape type="cube"><transform name="to_world"><scale x="0.3" y="0.5" z="0.3"/><rotate y="1" angle="30"/><translate y="0.5"/></transform>
  {GREY}</shape>
</scene>
"""


def without_sky(path):
    """The scene of a file as text, with whole names of files, and no light but that of shapes."""
    folder = os.path.dirname(os.path.abspath(path)) + "/"
    with open(path, encoding="utf-8") as file:
        text = re.sub(r'(name="filename" value=")(?!/)', lambda m: m.group(1) + folder, file.read())
    return SKY.sub("", text)


def shining(shape, radiance):
    emitter = f'<emitter type="area"><rgb name="radiance" value="{radiance}"/></emitter>'
    return f'{shape}<bsdf type="diffuse"/>{emitter}</shape>'


def panel(x, y, z, half, radiance="12, 11, 9"):
    """Faces down."""
    place = f'<scale x="{half}" y="{half}"/><rotate x="1" angle="90"/><translate x="{x}" y="{y}" z="{z}"/>'
    return shining(f'<shape type="rectangle"><transform name="to_world">{place}</transform>', radiance)


def bulb(x, y, z, radius, radiance):
    center = f'<point name="center" x="{x}" y="{y}" z="{z}"/><float name="radius" value="{radius}"/>'
    return shining(f'<shape type="sphere">{center}', radiance)


def globe(x, y, z, radius):
    """Of glass, hollow to 0.96 of its radius."""
    shell = ""
    for size, inside, outside in ((1, 1.5, 1), (0.96, 1, 1.5)):
        shell += f'<shape type="sphere"><point name="center" x="{x}" y="{y}" z="{z}"/><float name="radius" value="{size * radius}"/>'
        shell += f'<bsdf type="dielectric"><float name="int_ior" value="{inside}"/><float name="ext_ior" value="{outside}"/></bsdf></shape>'
    return shell


def rooms(others):
    lamp = globe(-1.2, 2, -1, 0.085) + bulb(-1.2, 2, -1, 0.05, "60, 60, 60")
    yield "globe", BARE_ROOM, lamp
    yield "globe_and_panel", BARE_ROOM, lamp + panel(0.5, 2.4, 0.3, 0.25, "60, 60, 60")
    panels = "".join(panel(x, 2.4, z, 0.15) for x in (-1.2, 0, 1.2) for z in (-1.2, 0, 1.2))
    yield "closed_by_day", BARE_ROOM, panels + EVENING
    yield "reading_room_night", without_sky(os.path.join(LIBRARY, "reading_room.xml")), ""
    yield "bathroom_night", without_sky(os.path.join(LIBRARY, "bathroom.xml")), ""
    if not others:
        return
    classroom = without_sky(os.path.join(others, "classroom", "mitsuba3.xml"))
    panels = "".join(panel(x, 2.6, z, 0.25) for x in (-2.5, -0.5, 1.5) for z in (-2, 0, 2, 4))
    yield "classroom_lamps", classroom, panels
    yield "classroom_sun", classroom, SUN
    bulbs = bulb(1, 1.5, 2, 0.08, "60, 50, 40") + bulb(2.6, 2.3, 3.2, 0.08, "60, 50, 40") + bulb(0.4, 0.9, 4, 0.06, "90, 70, 50")
    yield "living-room_bulbs", without_sky(os.path.join(others, "living-room", "mitsuba3.xml")), bulbs


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    for name, scene, lights in rooms(sys.argv[2] if len(sys.argv) == 3 else None):
        folder = os.path.join(sys.argv[1], name)
        os.makedirs(folder, exist_ok=True)
        end = scene.rindex("</scene>")
        with open(os.path.join(folder, "scene.xml"), "w", encoding="utf-8") as file:
            file.write(scene[:end] + lights + scene[end:])


if __name__ == "__main__":
    main()
