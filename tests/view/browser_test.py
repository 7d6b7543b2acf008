"""The page of `stromboli view` in a headless Chromium: what it shows, and what the mouse does.

browser_test.py PROGRAM        exit code 77: there is no Chromium
"""

import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

import small_gltf
from browser import Browser
from program import Served

SCENE = ["cornell_boxes", "-r", "96", "72", "-s", "16", "-m", "3", "--exposure", "0"]
DONE = "window.stromboli && stromboli.frame && stromboli.frame.state === 'done'"


def check(condition, what):
    if not condition:
        sys.exit(f"failed: {what}")


def close(a, b, tolerance=1e-9):
    return abs(a - b) <= tolerance * max(abs(a), abs(b), 1)


# The largest difference of a byte between the canvas and the PNG that the program makes, and their sums.
DIFFERENCE = """(async () => {
  const query = new URLSearchParams({ format: 'png', view: stromboli.view, exposure: stromboli.exposure,
    denoised: stromboli.shown === 'denoised' ? 1 : 0 });
  const response = await fetch('/save?' + query, { headers: { 'X-Stromboli-Token': settings.token } });
  const bitmap = await createImageBitmap(await response.blob());
  const other = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
  other.drawImage(bitmap, 0, 0);
  const mine = context.getImageData(0, 0, canvas.width, canvas.height).data;
  const theirs = other.getImageData(0, 0, bitmap.width, bitmap.height).data;
  let most = mine.length === theirs.length ? 0 : 999, differing = 0, light = 0;
  for (let i = 0; i < mine.length; ++i) {
    most = Math.max(most, Math.abs(mine[i] - theirs[i]));
    differing += mine[i] !== theirs[i];
    light += i % 4 < 3 ? mine[i] : 0;
  }
  return [most, differing / mine.length, light / mine.length];
})()"""


def choose(page, name, value):
    page.evaluate(f"at('{name}').value = '{value}', at('{name}').dispatchEvent(new Event('input')), "
                  f"at('{name}').dispatchEvent(new Event('change')), 0")


def pixels(page):
    """Half floats have eleven digits of the binary system: a byte may be the next one here and there."""
    for view in ("standard", "filmic", "pbr-neutral", "agx"):
        for exposure in (0, 2.5):
            choose(page, "view", view)
            choose(page, "exposure", exposure)
            page.wait(f"stromboli.view === '{view}' && stromboli.exposure === {exposure}")
            most, differing, light = page.evaluate(DIFFERENCE)
            check(most <= 1 and differing < 0.15 and light > 10,
                  f"{view}, {exposure} EV: {most} is the largest difference, {differing:.2%} differ, light {light}")
    choose(page, "view", "standard")
    choose(page, "exposure", 0)
    choose(page, "shown", "denoised")
    page.wait("stromboli.frame.shown === 'denoised'")
    most, differing, _ = page.evaluate(DIFFERENCE)
    check(most <= 1 and differing < 0.15, f"denoised: {most}, {differing:.2%}")
    for shown in ("albedo", "normal", "depth", "noise", "samples"):
        choose(page, "shown", shown)
        page.wait(f"stromboli.frame.shown === '{shown}'")
        check(page.evaluate("new Set(context.getImageData(0, 0, 96, 72).data).size > 2"), shown)
    choose(page, "shown", "picture")
    page.wait("stromboli.frame.shown === 'picture'")


def pose_after(page, act):
    """The poses before and after an act, when the picture of the latter is finished."""
    before = page.evaluate("({ ...stromboli.frame.pose, epoch: stromboli.frame.epoch })")
    act()
    page.wait(f"{DONE} && stromboli.frame.epoch > {before['epoch']} && !wanted && !sending && !dragging && "
              "JSON.stringify(stromboli.frame.pose) === JSON.stringify(stromboli.pose)")
    return before, page.evaluate("stromboli.frame.pose")


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def mouse(page):
    box = page.evaluate("(({ left, top, width, height }) => [left, top, width, height])"
                        "(canvas.getBoundingClientRect())")
    middle = (box[0] + box[2] / 2, box[1] + box[3] / 2)
    height = box[3]

    # An orbit of a quarter of the height: the view turns by pi / 4, at the same distance of the same point.
    before, after = pose_after(page, lambda: page.drag(middle, (middle[0] + height / 4, middle[1])))
    d, e = minus(before["from"], before["at"]), minus(after["from"], after["at"])
    check(all(close(x, y) for x, y in zip(before["at"], after["at"])), "an orbit keeps what is looked at")
    check(close(math.hypot(*d), math.hypot(*e)), "an orbit keeps the distance")
    turn = math.atan2(e[0], e[2]) - math.atan2(d[0], d[2])
    check(close((turn + math.pi / 4 + math.pi) % (2 * math.pi), math.pi, 1e-6), f"an orbit turns by pi / 4, not {turn}")

    # A pan by the height of the picture's tenth moves both points by as much of the view's height.
    before, after = pose_after(page, lambda: page.drag(middle, (middle[0], middle[1] + height / 10), modifiers=8))
    moved = minus(after["from"], before["from"])
    unit = 2 * math.tan(math.radians(before["fov"]) / 2) * math.hypot(*minus(before["from"], before["at"]))
    check(all(close(x, y, 1e-6) for x, y in zip(moved, minus(after["at"], before["at"]))), "a pan moves both alike")
    check(close(math.hypot(*moved), unit / 10, 1e-6), f"a pan of {math.hypot(*moved)}, not {unit / 10}")

    before, after = pose_after(page, lambda: page.mouse("mouseWheel", *middle, deltaX=0, deltaY=100))
    ratio = math.hypot(*minus(after["from"], after["at"])) / math.hypot(*minus(before["from"], before["at"]))
    check(close(ratio, math.exp(100 / 500)), f"the wheel changes the distance by {ratio}")

    # A click focuses on what is there: the depth of that pixel.
    pose_after(page, lambda: page.evaluate("at('aperture').value = 50, "
                                           "at('aperture').dispatchEvent(new Event('change')), 0"))
    page.wait("!probing")
    page.evaluate("stromboli.probe = null, 0")
    page.mouse("mouseMoved", *middle)
    depth = page.wait("stromboli.probe && stromboli.probe.depth")
    page.evaluate("at('focus').click(), 0")
    before, after = pose_after(page, lambda: page.mouse("mousePressed", *middle, button="left", clickCount=1))
    check(close(after["focus"], depth) and close(after["aperture"], 0.05), str(after))
    page.mouse("mouseReleased", *middle, button="left", clickCount=1)


def light_and_scene(browser, program):
    """Sliders of the sun and the environment; the scene's variants and time."""
    small = ["-r", "48", "36", "-s", "4", "-m", "2", "--exposure", "0"]
    with Served(program, "view", "cornell_boxes", *small, "--sun", "90,40") as view:
        page = browser.open(view.address)
        page.wait(DONE)
        check(page.evaluate("!at('light-tools').hidden && at('turn').parentElement.hidden && at('scene-tools').hidden"),
              "a sun has two sliders")
        page.evaluate("stromboli.frame = { ...stromboli.frame, state: 'loading', paused: true, biased: true }, describe(), 0")
        check(page.evaluate("at('pause').getAttribute('aria-pressed') === 'true' && "
                            "at('status').textContent.includes('biased: ')"), "a pause shows while a scene is loaded")
        choose(page, "elevation", 12.34)
        page.wait(f"{DONE} && stromboli.frame.sun[1] === 12.3 && stromboli.frame.sun[0] === 90")
        choose(page, "azimuth", 270)
        page.wait(f"{DONE} && stromboli.frame.sun[0] === 270 && stromboli.frame.sun[1] === 12.3")
        page.evaluate("at('command').click(), 0")
        page.wait("at('command-text').textContent.includes('--sun 270,12.3,3')")
        page.close()
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "small.gltf")
        small_gltf.write(file)
        with Served(program, "view", file, *small, "--env", "evening_sky") as view:
            page = browser.open(view.address)
            page.wait(DONE)
            color = "[...context.getImageData(canvas.width / 2, canvas.height / 2, 1, 1).data]"
            check(page.evaluate("[...at('camera').options].map((o) => o.text).join()") == "(choose),front",
                  "cameras of the file have their names")
            choose(page, "turn", 90)
            page.wait(f"{DONE} && stromboli.frame.turn === 90")
            check(page.evaluate("at('azimuth').parentElement.hidden && !at('scene-tools').hidden"), "the tools")
            check(page.evaluate("[...at('variant').options].map((o) => o.text).join()") == "of the file,red one,blue",
                  "the variants have their names")
            choose(page, "variant", 1)
            page.wait(f"{DONE} && stromboli.frame.variant === 'blue'")
            r, _, b, _ = page.evaluate(color)
            check(b > 2 * r, f"the square is blue: {r} {b}")
            choose(page, "seconds", 2)
            page.wait(f"{DONE} && stromboli.frame.atSeconds === 2")
            away = page.evaluate(color)
            check(away != [r, _, b, 255], "the square has moved away")
            page.evaluate("at('at-rest').click(), 0")
            page.wait(f"{DONE} && stromboli.frame.atSeconds === null")
            check(page.evaluate("stromboli.frame.turn") == 90, "the light stays turned")
            page.close()


def reference(browser, program):
    """A picture to compare with: its place beside the other one, the difference, and what `compare` says of them."""
    options = ["cornell_boxes", "-s", "4", "-m", "2"]
    with tempfile.TemporaryDirectory() as folder:
        def made(name, *more):
            file = os.path.join(folder, name)
            subprocess.run([program, "render", *options, "-r", "48", "36", *more, "-o", file], check=True,
                           stderr=subprocess.DEVNULL)
            return file
        same, other = made("same.exr", "--guiding", "off"), made("other.exr", "--seed", "5")
        both = "[canvas, at('other')].map((c) => [...c.getContext('2d').getImageData(0, 0, 48, 36).data].join())"
        for file in (same, other):
            with Served(program, "view", *options, "--exposure", "0", "--reference", file) as view:
                page = browser.open(view.address)
                page.wait(f"{DONE} && stromboli.reference && !at('other').hidden")
                check(page.evaluate("canvas.width === 48 && canvas.height === 36"), "the size is the reference's")
                difference = page.evaluate("stromboli.frame.difference")
                saved = os.path.join(folder, "saved.exr")
                with open(saved, "wb") as out:
                    out.write(view.ask("save?format=exr"))
                report = json.loads(subprocess.run([program, "compare", file, saved, "--json", "-"],
                                                   stdout=subprocess.PIPE).stdout)
                check(close(difference["relMse"], report["relMse"]) and close(difference["mse"], report["mse"])
                      and close(difference["ssim"], report["ssim"]), f"{difference} {report}")
                check((difference["relMse"] == 0) == (file == same), str(difference))
                check(page.evaluate("at('difference').textContent.startsWith('relMSE ')"), "the metrics are shown")
                for view_, exposure in (("standard", 1.5), ("agx", -1)):
                    choose(page, "view", view_)
                    choose(page, "exposure", exposure)
                    pictures = page.evaluate(both)
                    check((pictures[0] == pictures[1]) == (file == same), f"both at {exposure} EV by {view_}")
                # The divider is dragged, and the camera stays.
                epoch = page.evaluate("stromboli.frame.epoch")
                left, top, width, height = page.evaluate(
                    "(({ left, top, width, height }) => [left, top, width, height])(canvas.getBoundingClientRect())")
                page.drag((left + width / 2, top + height / 2), (left + width / 4, top + height / 2))
                check(close(page.evaluate("stromboli.divider"), 0.25, 0.01), "the divider was dragged")
                check("75%" in page.evaluate("at('other').style.clipPath"), "the picture is right of it")
                check(page.evaluate("stromboli.frame.epoch") == epoch, "the camera stays")
                choose(page, "compared", "difference")
                light = page.evaluate("context.getImageData(0, 0, 48, 36).data.reduce((s, v, i) => i % 4 < 3 ? s + v : s, 0)")
                check((light == 0) == (file == same) and page.evaluate("at('other').hidden"), f"the difference: {light}")
                choose(page, "compared", "none")
                check(page.evaluate("at('other').hidden && at('divider').hidden"), "nothing is shown beside it")
                # The metrics follow the picture: the camera is another one then.
                page.evaluate("moveTo(dollied(stromboli.pose, 1.5), false), 0")
                page.wait(f"{DONE} && stromboli.frame.epoch > {epoch}")
                check(page.evaluate("stromboli.frame.difference.relMse") > 0, "the metrics follow the picture")
                page.close()


def two_browsers(browser, view, page):
    """Both see what one of them does."""
    other = browser.open(view.address, alone=True)
    other.wait(DONE)
    other.evaluate("moveTo(dollied(stromboli.pose, 2), false), 0")
    other.wait(f"{DONE} && stromboli.frame.epoch > {page.evaluate('stromboli.frame.epoch')}")
    epoch = other.evaluate("stromboli.frame.epoch")
    page.wait(f"{DONE} && stromboli.frame.epoch === {epoch}")
    sums = [p.evaluate("context.getImageData(0, 0, 96, 72).data.reduce((a, b) => a + b, 0)") for p in (page, other)]
    check(sums[0] == sums[1], f"two browsers see {sums}")
    other.close()


def reconnects(program, view, page):
    """The program is ended, and begun again at the same port: the page goes on by itself."""
    page.evaluate("window.isTheOldOne = true, 0")
    check(view.end() == 130, "Ctrl-C ends it")
    page.wait("stromboli.reconnects > 0")
    with Served(program, "view", *SCENE, "--port", str(view.port)) as again:
        page.wait(f"!window.isTheOldOne && {DONE}")
        check(again.port == view.port, "the same port")


if __name__ == "__main__":
    if not shutil.which("chromium"):
        print("skipped: needs the package chromium")
        sys.exit(77)
    with Served(sys.argv[1], "view", *SCENE) as view, Browser() as browser:
        page = browser.open(view.address)
        page.wait(DONE)
        pixels(page)
        mouse(page)
        light_and_scene(browser, sys.argv[1])
        reference(browser, sys.argv[1])
        two_browsers(browser, view, page)
        reconnects(sys.argv[1], view, page)
