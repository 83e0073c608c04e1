# SPDX-License-Identifier: Apache-2.0
"""A page of `shoal web` as a phone shows it, through headless Chromium.

usage: phone_page.py URL OUTPUT.png [--width 390] [--height 844] [--dark]

Writes a picture of the whole page and fails if anything outside of a box that scrolls is wider than
the screen. Chromium's own window cannot be narrower than 500 pixels, so the size is set through its
debugging pipe. Needs chromium and Python's standard library.
"""

import argparse
import base64
import json
import os
import subprocess
import sys
import tempfile
import time

# Elements that reach beyond the screen, each with its text.
TOO_WIDE = """(() => {
  const width = document.documentElement.clientWidth;
  const scrolls = (element) => {
    for (let box = element.parentElement; box && box !== document.body; box = box.parentElement) {
      if (getComputedStyle(box).overflowX !== "visible") return true;
    }
    return false;
  };
  return [...document.querySelectorAll("body *")]
    .filter((element) => element.getBoundingClientRect().width > 0 &&
                         element.getBoundingClientRect().right > width + 0.5 && !scrolls(element))
    .map((element) => element.tagName + " " + element.textContent.trim().slice(0, 60));
})()"""


class Browser:
    """Chromium with its debugging pipe: JSON messages that end with a zero byte."""

    def __init__(self, profile):
        inward, self._write = os.pipe()
        self._read, outward = os.pipe()
        sandbox = ["--no-sandbox"] if os.geteuid() == 0 else []

        def place():  # Chromium reads from 3 and writes to 4
            first, second = os.dup(inward), os.dup(outward)
            os.dup2(first, 3)
            os.dup2(second, 4)

        self._process = subprocess.Popen(
            ["chromium", "--headless=new", *sandbox, "--disable-gpu", "--hide-scrollbars",
             "--remote-debugging-pipe", f"--user-data-dir={profile}", "about:blank"],
            preexec_fn=place, close_fds=False, stderr=subprocess.DEVNULL)
        os.close(inward)
        os.close(outward)
        self._buffer, self._calls, self._session = b"", 0, None
        self._session = self.call("Target.attachToTarget", targetId=self._page(), flatten=True)[
            "sessionId"]

    def _page(self):
        for _ in range(100):
            for target in self.call("Target.getTargets")["targetInfos"]:
                if target["type"] == "page":
                    return target["targetId"]
            time.sleep(0.1)
        sys.exit("chromium opened no page")

    def call(self, method, **parameters):
        self._calls += 1
        message = {"id": self._calls, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self._buffer:
                part = os.read(self._read, 1 << 20)
                if not part:
                    sys.exit("chromium ended")
                self._buffer += part
            text, self._buffer = self._buffer.split(b"\0", 1)
            answer = json.loads(text)
            if answer.get("id") == self._calls:
                if "error" in answer:
                    sys.exit(f"{method}: {answer['error']['message']}")
                return answer["result"]

    def close(self):
        self._process.terminate()
        self._process.wait()


def look(browser, options):
    browser.call("Emulation.setDeviceMetricsOverride", width=options.width, height=options.height,
                 deviceScaleFactor=2, mobile=True)
    if options.dark:
        browser.call("Emulation.setEmulatedMedia",
                     features=[{"name": "prefers-color-scheme", "value": "dark"}])
    browser.call("Page.navigate", url=options.url)
    time.sleep(6)  # the page asks for its curves once it is there
    too_wide = browser.call("Runtime.evaluate", expression=TOO_WIDE, returnByValue=True)
    height = browser.call("Page.getLayoutMetrics")["cssContentSize"]["height"]
    picture = browser.call(
        "Page.captureScreenshot", captureBeyondViewport=True,
        clip={"x": 0, "y": 0, "width": options.width, "height": height, "scale": 1})
    with open(options.output, "wb") as file:
        file.write(base64.b64decode(picture["data"]))
    return too_wide["result"]["value"]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("url")
    parser.add_argument("output")
    parser.add_argument("--width", type=int, default=390)
    parser.add_argument("--height", type=int, default=844)
    parser.add_argument("--dark", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(profile)
        try:
            too_wide = look(browser, options)
        finally:
            browser.close()
    if too_wide:
        sys.exit("wider than the screen:\n" + "\n".join(too_wide))
    print(f"{options.output}: nothing is wider than {options.width} pixels")


if __name__ == "__main__":
    main()
