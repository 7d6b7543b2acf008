"""A headless Chromium that is driven through its debugging pipe, without packages.

    with Browser() as browser:
        page = browser.open("http://127.0.0.1:8080/")
        page.wait("document.title !== ''")
        page.evaluate("1 + 1")

Chromium speaks JSON with NUL after each message, over the file descriptors 3 (to it) and 4 (from it).
"""

import json
import os
import select
import shutil
import subprocess
import tempfile
import time


class Browser:
    """Ends with the browser gone and its profile removed."""

    LONGEST = 120  # seconds for what has to come; tests wait for conditions, and this only ends what hangs

    def __init__(self, program="chromium"):
        self.program = program
        self.replies, self.number, self.buffer = {}, 0, b""

    def __enter__(self):
        self.profile = tempfile.mkdtemp(prefix="stromboli-browser-")
        to_child, self.to = os.pipe()
        self.come, from_child = os.pipe()

        def place_pipes():  # both are copied out of the way first: one may have the other's number
            a, b = os.dup(to_child), os.dup(from_child)
            os.dup2(a, 3)
            os.dup2(b, 4)

        # No sandbox, because tests may run as root; the page is our own.
        self.process = subprocess.Popen(
            [self.program, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-sync",
             "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1", "--window-size=1200,800",
             f"--user-data-dir={self.profile}", "--remote-debugging-pipe", "about:blank"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            close_fds=False, preexec_fn=place_pipes)
        os.close(to_child)
        os.close(from_child)
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        os.close(self.to)
        os.close(self.come)
        shutil.rmtree(self.profile, ignore_errors=True)

    def call(self, method, session=None, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + self.LONGEST
        while self.number not in self.replies:
            self._read(end, method)
        reply = self.replies.pop(self.number)
        if "error" in reply:
            raise RuntimeError(f"{method}: {reply['error']['message']}")
        return reply["result"]

    def _read(self, end, what):
        if not select.select([self.come], [], [], max(end - time.monotonic(), 0))[0]:
            raise TimeoutError(what)
        data = os.read(self.come, 1 << 16)
        if not data:
            raise EOFError("the browser has ended")
        *messages, self.buffer = (self.buffer + data).split(b"\0")
        for message in map(json.loads, messages):
            if "id" in message:
                self.replies[message["id"]] = message

    def open(self, address, alone=False):
        """A new page; alone: it shares nothing with others, as in another browser."""
        context = {"browserContextId": self.call("Target.createBrowserContext")["browserContextId"]} if alone else {}
        target = self.call("Target.createTarget", url=address, **context)["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        return Page(self, target, session)


class Page:
    def __init__(self, browser, target, session):
        self.browser, self.target, self.session = browser, target, session

    def call(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def evaluate(self, expression):
        """The value of a JavaScript expression, which may be a promise."""
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"].get("exception", {}).get("description", expression))
        return result["result"].get("value")

    def wait(self, condition):
        """Until the expression is true; what throws (a page that is being loaded) is not."""
        end = time.monotonic() + self.browser.LONGEST
        while True:
            try:
                value = self.evaluate(condition)
            except RuntimeError:
                value = None
            if value:
                return value
            if time.monotonic() > end:
                raise TimeoutError(condition)
            time.sleep(0.02)

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def drag(self, start, end, steps=8, modifiers=0):
        self.mouse("mousePressed", *start, button="left", buttons=1, clickCount=1, modifiers=modifiers)
        for i in range(1, steps + 1):
            t = i / steps
            self.mouse("mouseMoved", *((1 - t) * a + t * b for a, b in zip(start, end)), button="left", buttons=1,
                       modifiers=modifiers)
        self.mouse("mouseReleased", *end, button="left", buttons=0, clickCount=1, modifiers=modifiers)

    def picture(self, file):
        """Writes a PNG of what is on the screen."""
        import base64
        with open(file, "wb") as out:
            out.write(base64.b64decode(self.call("Page.captureScreenshot")["data"]))

    def close(self):
        self.browser.call("Target.closeTarget", targetId=self.target)
