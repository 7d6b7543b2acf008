"""`stromboli view` (and render --watch) as a program that is started, asked by HTTP, and ended with Ctrl-C."""

import json
import re
import signal
import struct
import subprocess
import urllib.request


class Served:
    """A program that prints or says the address it serves at."""

    def __init__(self, program, *arguments, folder=None):
        # Ctrl-C is ignored by what a shell has started in the background, and by all that this starts.
        def heed_ctrl_c():
            signal.signal(signal.SIGINT, signal.SIG_DFL)

        self.process = subprocess.Popen([program, *arguments], cwd=folder, text=True, stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, preexec_fn=heed_ctrl_c)
        self.said = []
        for line in self.process.stdout:
            self.said.append(line)
            found = re.search(r"http://127\.0\.0\.1:(\d+)/", line)
            if found:
                self.address, self.port = found.group(0), int(found.group(1))
                break
        else:
            raise RuntimeError("".join(self.said))
        with urllib.request.urlopen(self.address) as page:
            self.token = re.search(r'"token":"([0-9a-f]+)"', page.read().decode()).group(1)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.stdout.close()
        self.process.wait()

    def end(self):
        """The exit code after Ctrl-C."""
        self.process.send_signal(signal.SIGINT)
        return self.process.wait()

    def ask(self, path, method="GET"):
        request = urllib.request.Request(self.address + path, method=method,
                                         headers={"X-Stromboli-Token": self.token})
        with urllib.request.urlopen(request) as response:
            return response.read()

    def steer(self, **what):
        self.ask("steer?" + "&".join(f"{name}={value}" for name, value in what.items()), "POST")

    def look(self, origin, at, fov=40, moving=0):
        axes = {f"{name}{axis}": v for name, point in (("from", origin), ("at", at)) for axis, v in zip("xyz", point)}
        self.steer(**axes, fov=fov, moving=moving)

    def frame(self, after=0, shown="picture"):
        """What the next frame says of itself, and its bytes."""
        while True:
            data = self.ask(f"frame?shown={shown}&after={after}")
            if data:
                length = struct.unpack("<I", data[:4])[0]
                return json.loads(data[4:4 + length]), data[4 + length:]

    def finished(self, epoch=0):
        after = 0
        while True:
            text, data = self.frame(after)
            if text["state"] == "done" and text["epoch"] > epoch:
                return text, data
            after = text["number"]
