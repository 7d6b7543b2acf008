"""What `stromboli view` says makes the picture does make it, to the bit.

program_test.py PROGRAM
"""

import json
import os
import shlex
import struct
import subprocess
import sys
import tempfile

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
            except OSError:  # it has ended
                break
        view.process.stdout.read()
        check(view.process.wait() == 0, "the render ends well")
    subprocess.run([program, *options, "-o", "alone.png"], cwd=folder, check=True, stderr=subprocess.DEVNULL)
    check(pixels_of(read(os.path.join(folder, "watched.png"))) == pixels_of(read(os.path.join(folder, "alone.png"))),
          "watching has changed the picture")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        same_pictures(sys.argv[1], place)
        watched_render(sys.argv[1], place)
