"""What `stromboli view` says makes the picture does make it, to the bit.

program_test.py PROGRAM
"""

import http.client
import json
import os
import shlex
import struct
import subprocess
import sys
import tempfile
import urllib.error

import small_gltf
from program import Served


def pixels_of(png):
    """The bytes of the pixels of a PNG as they are kept: equal ones are of equal pixels."""
    data, at, pixels = png, 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind in (b"IHDR", b"IDAT"):
            pixels += data[at + 8:at + 8 + length]
        at += 12 + length
    return pixels


def read(path):
    with open(path, "rb") as file:
        return file.read()


def check(condition, what):
    if not condition:
        sys.exit(f"failed: {what}")


def run_command(program, command, folder, output=None):
    words = shlex.split(command)
    check(words[:2] == ["stromboli", "render"], command)
    if output:
        words[words.index("-o") + 1] = output
    subprocess.run([program, *words[1:]], cwd=folder, check=True, stderr=subprocess.DEVNULL)
    return os.path.join(folder, words[words.index("-o") + 1])


def same_pictures(program, folder):
    options = ["cornell_boxes", "-r", "64", "48", "-s", "24", "-m", "4", "--fov", "35", "--exposure", "0.25"]
    with Served(program, "view", *options) as view:
        epoch = view.finished()[0]["epoch"]

        # The view that it began with: --fov belongs to it, --exposure to the page.
        command = view.ask("command?view=standard&exposure=0").decode()
        check("--fov 35" in command and "--exposure" not in command, command)
        check(pixels_of(read(run_command(program, command, folder))) ==
              pixels_of(view.ask("save?format=png")), "the view that it began with: " + command)

        # One that nobody would type.
        view.look((1 / 3, 0.1 + 0.2, -14 / 3), (0.125, 1.0000000000000002, 0), 29.999999999999996)
        epoch = view.finished(epoch)[0]["epoch"]
        for question, denoised in (("view=agx&exposure=-0.7", False), ("view=standard&exposure=auto", True)):
            question += f"&denoised={int(denoised)}"
            command = view.ask("command?" + question).decode()
            check(pixels_of(read(run_command(program, command, folder))) ==
                  pixels_of(view.ask("save?format=png&" + question)), command)

        # Radiance, to the bit: the error is exactly zero.
        saved = os.path.join(folder, "saved.exr")
        with open(saved, "wb") as file:
            file.write(view.ask("save?format=exr"))
        command = view.ask("command").decode()
        made = run_command(program, command, folder, "made.exr")
        report = subprocess.run([program, "compare", saved, made, "--json", "-"], cwd=folder,
                                stdout=subprocess.PIPE).stdout
        check(json.loads(report)["relMse"] == 0, "the radiance: " + report.decode())

        # A camera of the file, by its number.
        view.steer(camera=0, moving=0)
        view.finished(epoch)
        command = view.ask("command").decode()
        check("--camera 1" in command and "--look-from" not in command, command)
        check(pixels_of(read(run_command(program, command, folder))) == pixels_of(view.ask("save?format=png")),
              command)
        check(view.end() == 130, "Ctrl-C ends it")


def steered(view, question, folder, program, until, **what):
    """The page's picture after a change of what is seen, and the command's; returns what the frame says."""
    view.steer(**what, moving=0)
    text = view.frame()[0]
    while not (text["state"] == "done" and until(text)):
        text = view.frame(text["number"])[0]
    command = view.ask("command?" + question).decode()
    check(pixels_of(read(run_command(program, command, folder))) ==
          pixels_of(view.ask("save?format=png&" + question)), command)
    return text, command


def same_light(program, folder):
    """An environment that turns, and a sun that is moved."""
    options = ["cornell_boxes", "-r", "64", "48", "-s", "8", "-m", "3"]
    with Served(program, "view", *options, "--env", "evening_sky", "--env-rotate", "20") as view:
        text, _ = view.finished()
        check(text["turn"] == 20 and text["sun"] is None, str(text))
        view.steer(azimuth=10, elevation=20)  # there is no sun
        text, command = steered(view, "view=agx", folder, program, lambda t: t["turn"] == -77.7, turn=-77.7)
        check("--env-rotate -77.7" in command and "--sun" not in command, command)
        text, command = steered(view, "view=agx", folder, program, lambda t: t["turn"] == 0, turn=0)
        check("--env-rotate" not in command, command)
    with Served(program, "view", *options, "--sun", "135,40") as view:
        text, _ = view.finished()
        check(text["turn"] is None and text["sun"] == [135, 40], str(text))
        for azimuth, elevation in ((-20.3, 40), (200, 7.5)):
            text, command = steered(view, "view=agx&exposure=auto", folder, program,
                                    lambda t: t["sun"] == [azimuth, elevation], azimuth=azimuth, elevation=elevation)
            check(f"--sun {azimuth},{elevation}" in command, command)


def same_scenes(program, folder):
    """Sets of materials, and moments of an animation; the camera stays where it was steered to."""
    file = os.path.join(folder, "small.gltf")
    small_gltf.write(file)
    options = [file, "-r", "48", "36", "-s", "8", "--env", "1"]
    with Served(program, "view", *options) as view:
        text, _ = view.finished()
        check(text["variants"] == ["red one", "blue"] and text["variant"] == "" and text["animationSeconds"] == 2
              and text["atSeconds"] is None, str(text))
        text, command = steered(view, "", folder, program, lambda t: t["variant"] == "red one", variant=0)
        check("--variant 'red one'" in command and "--at" not in command, command)
        view.look((0.5, 0.25, 4), (0.5, 0, 0), 50)
        text, command = steered(view, "", folder, program, lambda t: t["atSeconds"] == 1.25 and t["isStated"],
                                seconds=1.25)
        check("--at 1.25" in command and "--look-from 0.5 0.25 4" in command, command)
        check(text["pose"]["from"] == [0.5, 0.25, 4] and text["pose"]["fov"] == 50, str(text["pose"]))
        view.steer(variant=1)
        text, command = steered(view, "", folder, program,
                                lambda t: t["atSeconds"] is None and t["variant"] == "blue", seconds=-1)
        check("--at" not in command and "--variant blue" in command, command)
        # What cannot be read is said, and what was there stays.
        os.rename(file, file + ".away")
        view.steer(variant=-1)
        text = view.frame()[0]
        while not text["problem"]:
            text = view.frame(text["number"])[0]
        check("small.gltf" in text["problem"] and text["variant"] == "blue", str(text))


def references_of_another_size(program, folder):
    """Are an error that says both sizes; no request names a file."""
    file = os.path.join(folder, "reference.exr")
    subprocess.run([program, "render", "cornell_boxes", "-r", "20", "10", "-s", "1", "-o", file], check=True,
                   stderr=subprocess.DEVNULL)
    for options, code, words in ((["-r", "32", "24", "--reference", file], 1, ("20 x 10", "32 x 24")),
                                 (["--reference", file + ".not"], 1, ("reference.exr.not",))):
        done = subprocess.run([program, "view", "cornell_boxes", *options], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True)
        check(done.returncode == code and all(word in done.stderr for word in words), done.stderr)
    with Served(program, "view", "cornell_boxes", "-r", "8", "6", "-s", "1") as view:
        try:
            view.ask("reference?file=" + file)
            check(False, "a file was named by the page")
        except urllib.error.HTTPError as error:
            check(error.code == 404, str(error))


def watched_render(program, folder):
    """A page shows a render that goes on, and the file has the bytes of one that nobody has watched."""
    options = ["render", "cornell_boxes", "-r", "64", "48", "-s", "1000", "--even"]
    with Served(program, *options, "-o", "watched.png", "--watch", "0", folder=folder) as view:
        text, data = view.frame()
        check(text["readOnly"] and text["width"] == 64 and any(data), str(text))
        try:
            view.steer(paused=1)
            check(False, "a watched render was steered")
        except OSError:
            pass
        while text["state"] != "done":
            try:
                text = view.frame(text["number"])[0]
            except (OSError, http.client.HTTPException):  # it has ended, perhaps in the middle of an answer
                break
        view.process.stdout.read()
        check(view.process.wait() == 0, "the render ends well")
    subprocess.run([program, *options, "-o", "alone.png"], cwd=folder, check=True, stderr=subprocess.DEVNULL)
    check(pixels_of(read(os.path.join(folder, "watched.png"))) == pixels_of(read(os.path.join(folder, "alone.png"))),
          "watching has changed the picture")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        same_pictures(sys.argv[1], place)
        same_light(sys.argv[1], place)
        same_scenes(sys.argv[1], place)
        references_of_another_size(sys.argv[1], place)
        watched_render(sys.argv[1], place)
