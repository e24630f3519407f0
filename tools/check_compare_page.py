#!/usr/bin/env python3
"""Opens the page of `sheen compare --html` in Chromium and uses it, as a person at a desk and one with a phone would.

Renders three small pictures, compares them, and checks at 1280 x 900 with a mouse and a keyboard, and at 390 x 844 with
a finger: nothing fails in the script; the canvases hold the pictures; slider, exposure, error map and the choice of the
image, of its layer and, of folders, of the picture do what they say; nothing is wider than the window; a finger can
still scroll the page.

Usage: tools/check_compare_page.py [--sheen PROGRAM] [--keep FOLDER]      about 30 seconds
Needs Chromium (`chromium`, or the program named by CHROMIUM) and nothing beyond Python's library: it talks to the
browser through a pair of pipes. Prints "skipped" and exits with 77 where there is no Chromium, else with 0 or 1.
"""

import argparse
import base64
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
failures = []


class Browser:
    """A headless Chromium with one page, driven by the DevTools protocol over file descriptors 3 and 4."""

    def __init__(self, program, folder):
        to_browser, self.write = os.pipe()
        self.read, from_browser = os.pipe()

        def descriptors():
            a, b = os.dup(to_browser), os.dup(from_browser)  # either may be 3 or 4 itself
            os.dup2(a, 3)
            os.dup2(b, 4)

        arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--remote-debugging-pipe",
                     f"--user-data-dir={folder}", "about:blank"]
        self.process = subprocess.Popen([program, *arguments], preexec_fn=descriptors, close_fds=False,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.buffer, self.number, self.session, self.events = b"", 0, None, []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(domain + ".enable")

    def message(self):
        while b"\0" not in self.buffer:
            more = os.read(self.read, 1 << 20)
            if not more:
                raise RuntimeError("the browser has ended")
            self.buffer += more
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def call(self, method, **parameters):
        self.number += 1
        request = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            request["sessionId"] = self.session
        os.write(self.write, json.dumps(request).encode() + b"\0")
        while True:
            answer = self.message()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self.events.append(answer)

    def open(self, path, width, height, phone):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=2 if phone else 1,
                  mobile=phone)
        self.call("Emulation.setTouchEmulationEnabled", enabled=phone)
        self.events.clear()
        self.call("Page.navigate", url=path.as_uri())
        for _ in range(100):
            if self.value("document.readyState === 'complete' && document.getElementById('under').width !== 300"):
                break
            time.sleep(0.05)

    def value(self, script):
        answer = self.call("Runtime.evaluate", expression=script, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{script}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def complaints(self):
        """What the page's script or the browser had to say."""
        bad = []
        for event in self.events:
            if event.get("method") == "Runtime.exceptionThrown":
                bad.append(event["params"]["exceptionDetails"]["exception"]["description"])
            elif event.get("method") == "Log.entryAdded" and event["params"]["entry"]["level"] == "error":
                bad.append(event["params"]["entry"]["text"])
        return bad

    def box(self, name):
        return self.value(f"(() => {{ const b = document.getElementById('{name}').getBoundingClientRect();"
                          "return [b.left, b.top, b.width, b.height]; })()")

    def mouse(self, x, y):
        self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)

    def finger(self, *points):
        """Puts a finger down, moves it through the points, lifts it."""
        for i, (x, y) in enumerate(points):
            self.call("Input.dispatchTouchEvent", type="touchMove" if i else "touchStart", touchPoints=[{"x": x, "y": y}])
            time.sleep(0.02)
        self.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
        time.sleep(0.2)

    def key(self, name, code):
        for kind in ("rawKeyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=name, code=name, windowsVirtualKeyCode=code)

    def picture(self, path):
        path.write_bytes(base64.b64decode(self.call("Page.captureScreenshot", captureBeyondViewport=False)["data"]))

    def close(self):
        self.process.terminate()
        self.process.wait(10)


def check(what, holds, seen=""):
    print(f"  {'ok  ' if holds else 'FAIL'} {what}{f': {seen}' if not holds else ''}")
    if not holds:
        failures.append(what)


# The mean difference, in steps of 1 / 255, of a canvas from a picture of the chosen section; the mean of a canvas.
DIFFERENCE = """((canvas, role) => {
  const image = section.querySelector('img.' + role);
  const copy = new OffscreenCanvas(image.naturalWidth, image.naturalHeight).getContext('2d');
  copy.drawImage(image, 0, 0);
  const a = $(canvas).getContext('2d').getImageData(0, 0, image.naturalWidth, image.naturalHeight).data;
  const b = copy.getImageData(0, 0, image.naturalWidth, image.naturalHeight).data;
  return a.reduce((sum, x, i) => sum + Math.abs(x - b[i]), 0) / a.length;
})"""
MEAN = """(() => { const c = $('under'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
  return d.reduce((sum, x) => sum + x, 0) / d.length; })()"""
RIGHT, DOWN = ("ArrowRight", 39), ("ArrowDown", 40)


def check_width(b):
    wide = b.value("document.documentElement.scrollWidth")
    check("nothing is wider than the window", wide <= b.value("window.innerWidth"), wide)


def check_page(b):
    check("the script has no errors", not b.complaints(), b.complaints())
    check("the viewer is there", b.value("!$('viewer').hidden"))
    check("there is no choice of one picture", b.value("$('several').offsetHeight") == 0)
    check("there is no choice of one layer", b.value("$('reference-layers').offsetHeight + $('image-layers').offsetHeight"
                                                     " + $('legends').offsetHeight") == 0)
    # A Radiance file keeps 8 bits of the largest channel, which is up to some steps in a darker one, .1 in the mean.
    for canvas, role in (("over", "reference"), ("under", "image")):
        off = b.value(f"{DIFFERENCE}('{canvas}', '{role}')")
        check(f"the {role} is drawn as its PNG", off <= 0.3, off)
    left, _, width, _ = b.box("stage")
    window = b.value("window.innerWidth")
    check("the stage is in the window", left >= 0 and left + width <= window, (left, width))
    check_width(b)
    check("controls are high enough for a finger", b.value(
        "Math.min(...[...document.querySelectorAll('#controls select, #controls input')]"
        ".filter(e => e.offsetParent)"
        ".map(e => e.getBoundingClientRect().height))") >= 24)


def check_keys(b):
    b.value("$('slider').focus()")
    before = b.value("+$('slider').value")
    b.key(*RIGHT)
    check("a key moves the slider", b.value("+$('slider').value") > before)
    check("the line follows", b.value("$('over').style.clipPath").startswith(f"inset(0px {99.9 - before:.4g}")
          or abs(b.value("100 - parseFloat($('over').style.clipPath.split(' ')[1])") - before - 0.1) < 0.05,
          b.value("$('over').style.clipPath"))
    dark = b.value(MEAN)
    b.value("$('exposure').focus()")
    for _ in range(10):
        b.key(*RIGHT)
    check("keys raise the exposure", abs(b.value("+$('exposure').value") - 1) < 1e-6 and b.value(MEAN) > 1.1 * dark,
          (b.value("$('exposure').value"), dark, b.value(MEAN)))
    check("its value is shown", b.value("$('stops').value") == "1.0", b.value("$('stops').value"))
    b.value("$('view').focus()")
    b.key(*DOWN)
    check("a key shows the error map", b.value("$('view').value") == "error"
          and b.value(f"{DIFFERENCE}('under', 'error')") == 0)
    b.value("$('which').focus()")
    b.key(*DOWN)
    check("a key shows the next image", b.value("$('which').selectedIndex") == 1
          and b.value(f"{DIFFERENCE}('under', 'error')") == 0)


def check_choice(b):
    """The page of two folders with two pictures each."""
    check("the script has no errors", not b.complaints(), b.complaints())
    check("pictures are there to choose from",
          b.value("!$('several').hidden && [...$('picture').options].map(o => o.text).join()") == "box,round")
    check("images are those of one picture", b.value("$('which').options.length") == 2)
    b.value("$('which').focus()")
    b.key(*DOWN)
    shown = b.value("$('which').value")
    b.value("$('picture').focus()")
    b.key(*DOWN)
    check("a key shows the next picture", b.value("section.dataset.picture") == "round",
          b.value("section.dataset.picture"))
    check("the image stays that of the operand",
          b.value("section.dataset.image") == shown == b.value("$('which').value"))
    for canvas, role in (("over", "reference"), ("under", "image")):
        off = b.value(f"{DIFFERENCE}('{canvas}', '{role}')")
        check(f"its {role} is drawn, in its size", off <= 0.3 and b.value(f"$('{canvas}').height") == 120,
              (off, b.value(f"$('{canvas}').height")))
    check_width(b)


# The colour of a pixel in the middle of a canvas' row, 0 on top to 1.
PIXEL = """((canvas, row) => { const c = $(canvas);
  return [...c.getContext('2d').getImageData(c.width >> 1, row * (c.height - 1), 1, 1).data].slice(0, 3).join(); })"""
LAYERS = ("colour,accuracy (V),depth (Z),normal.X,normal.Y,normal.Z,transport (RGB)", "colour,depth (Z)")


def check_layers(b):
    """The page of a reference with depth and an image with more, and one without layers."""
    check("the script has no errors", not b.complaints(), b.complaints())
    for role, expected in zip(("image", "reference"), LAYERS):
        seen = b.value(f"[...$('{role}-layer').options].map(o => o.text).join()")
        check(f"layers of the {role} are there to choose from", seen == expected, seen)
    color = b.value(f"{PIXEL}('under', 0.5)")
    b.value("$('image-layer').focus()")
    b.key(*DOWN)
    check("a key shows the accuracy", b.value("$('image-legend').innerText.replace(/\\s+/g, ' ')")
          == "image: accuracy (V) 0 0.25 a of the records, smaller is finer", b.value("$('image-legend').innerText"))
    check("one value everywhere is the scale's upper end", b.value(f"{PIXEL}('under', 0.5)") == "252,253,191",
          b.value(f"{PIXEL}('under', 0.5)"))
    check("the reference keeps its colour", b.value("$('reference-layer').value === '' && $('reference-legend').hidden"))
    check("its exposure can be set", b.value("$('brightness').offsetHeight") > 0)
    b.key(*DOWN)
    texts = b.value("[...$('legends').children].map(e => e.innerText.replace(/\\s+/g, ' ').replace(/^\\w+: /, ''))")
    check("the reference follows to the depth, on the same scale",
          b.value("$('reference-layer').value") == "depth.Z" and len(texts) == 2 and texts[0] == texts[1]
          and texts[0].startswith("depth (Z) ") and texts[0].endswith(" m distance of the first surface"), texts)
    check("which spans both", b.value("range('image').join() === range('reference').join()"
                                      " && range('image').join() !== [chosen('image').dataset.min,"
                                      " chosen('image').dataset.max].join()"), b.value("roles.map(range).join()"))
    check("data have no exposure", b.value("$('brightness').offsetHeight") == 0)
    # What the value of one byte should look like, from the legend's ends and the element's.
    value = b.value("""(() => { const l = chosen('image'), copy = new OffscreenCanvas(l.naturalWidth, l.naturalHeight)
      .getContext('2d'); copy.drawImage(l, 0, 0);
      const q = copy.getImageData(l.naturalWidth >> 1, 0.5 * (l.naturalHeight - 1), 1, 1).data[0];
      return +l.dataset.min + (q - 1) / 254 * (l.dataset.max - l.dataset.min); })()""")
    low, high = b.value("range('image')")
    at = 4 * (value - low) / (high - low)
    ramp = [(0, 0, 4), (81, 18, 124), (183, 55, 121), (252, 137, 97), (252, 253, 191)]
    i = min(3, int(at))
    expected = [p + (at - i) * (q - p) for p, q in zip(ramp[i], ramp[i + 1])]
    got = [int(x) for x in b.value(f"{PIXEL}('under', 0.5)").split(",")]
    check("a depth has the colour of its value", max(abs(x - y) for x, y in zip(got, expected)) <= 1, (got, expected))
    check_width(b)
    b.value("$('image-layer').value = 'transport'; $('image-layer').dispatchEvent(new Event('input'))")
    b.value("$('exposure').value = 0; $('exposure').dispatchEvent(new Event('input'))")
    check("transport is drawn as a colour", b.value(f"{PIXEL}('under', 0.5)") == "0,255,0"
          and b.value("$('image-legend').innerText").find("green: irradiance records") > 0, b.value(f"{PIXEL}('under', 0.5)"))
    check("the reference stays where it has no such layer", b.value("$('reference-layer').value") == "depth.Z")
    b.value("$('which').focus()")
    b.key(*DOWN)
    check("an image without layers shows its colour", b.value("$('image-layers').offsetHeight") == 0
          and b.value("$('image-layer').value") == "" and b.value(f"{PIXEL}('under', 0.5)") == color,
          (b.value(f"{PIXEL}('under', 0.5)"), color))
    check("the reference's layer stays", b.value("$('reference-layer').value") == "depth.Z")


def check_mouse(b):
    left, top, width, height = b.box("stage")
    for share in (0.25, 0.8):
        b.mouse(left + share * width, top + 0.5 * height)
        got = b.value("+$('slider').value")
        check(f"the mouse moves the slider to {100 * share:.0f} %", abs(got - 100 * share) < 1, got)
    line = b.box("line")
    check("the line is under the mouse", abs(line[0] + 1 - left - 0.8 * width) < 2, line)


def check_finger(b):
    b.value("$('stage').scrollIntoView({block: 'start'})")
    left, top, width, height = b.box("stage")
    y = top + 0.5 * height
    b.finger((left + 0.3 * width, y))
    got = b.value("+$('slider').value")
    check("a tap moves the slider", abs(got - 30) < 2, got)
    b.finger(*((left + x * width, y) for x in (0.3, 0.4, 0.55, 0.7)))
    got = b.value("+$('slider').value")
    check("a finger drags the slider", abs(got - 70) < 2, got)
    before = b.value("window.scrollY")
    b.finger(*((left + 0.5 * width, y - d) for d in (0, 15, 40, 80, 120)))
    check("a finger on the picture scrolls the page", b.value("window.scrollY") > before + 50,
          (before, b.value("window.scrollY")))


QUALITIES = {"reference": 64, "noisy": 2, "better": 16}  # samples a pixel


def compare(sheen, page, operands):
    subprocess.run([sheen, "compare", *operands, "--html", page], check=True, stdout=subprocess.DEVNULL)
    return page


def render(sheen, scene, path, *words):
    subprocess.run([sheen, "render", ROOT / "scenes" / f"{scene}.xml", "--progress", "none", "-o", path, *words],
                   check=True)
    return path


def make_layers_page(sheen, folder):
    """A page of pictures with layers and one without: a diffuse box, whose transport is green. One sample of the
    reference's depth sees nearer and farther than the mean of four."""
    size, cached = ("--size", "240x160"), ("--accuracy", "0.25", "--spp", "4", "--gather-rays", "256")
    return compare(sheen, folder / "layers.html", [
        render(sheen, "furnace", folder / "depth.exr", *size, "--integrator", "path", "--spp", "1", "--aov", "depth"),
        render(sheen, "furnace", folder / "layers.exr", *size, *cached, "--aov", "depth,normal,accuracy,transport"),
        render(sheen, "furnace", folder / "plain.exr", *size, *cached)])


def make_pages(sheen, folder):
    """A page of two images, one of two folders with two pictures each, of another size, and one with layers."""
    for seed, (quality, spp) in enumerate(QUALITIES.items()):
        (folder / quality).mkdir(exist_ok=True)
        for scene, size, path in (("cornell-box", "360x240", f"{quality}.exr"),
                                  ("cornell-box", "180x160", f"{quality}/box.exr"),
                                  ("furnace", "180x120", f"{quality}/round.exr")):
            render(sheen, scene, folder / path, "--integrator", "path", "--size", size, "--spp", str(spp), "--seed",
                   str(seed))
    return (compare(sheen, folder / "page.html", [folder / f"{q}.exr" for q in QUALITIES]),
            compare(sheen, folder / "pictures.html", [folder / q for q in QUALITIES]), make_layers_page(sheen, folder))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sheen", default=ROOT / "build" / "release" / "bin" / "sheen")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the page and pictures of it")
    options = parser.parse_args()
    chromium = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")
    if not chromium:
        print("check_compare_page: skipped: no Chromium (apt-get install chromium)")
        return 77
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(options.keep or temporary).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        page, pictures, layers = make_pages(options.sheen, folder)
        browser = Browser(chromium, pathlib.Path(temporary) / "profile")
        try:
            for name, width, height, phone in (("desk", 1280, 900, False), ("phone", 390, 844, True)):
                print(f"{name}, {width} x {height}")
                browser.open(page, width, height, phone)
                browser.picture(folder / f"{name}.png")
                check_page(browser)
                (check_finger if phone else check_mouse)(browser)
                browser.picture(folder / f"{name}-moved.png")
                check_keys(browser)
                browser.picture(folder / f"{name}-error.png")
                browser.open(pictures, width, height, phone)
                check_choice(browser)
                browser.picture(folder / f"{name}-pictures.png")
                browser.open(layers, width, height, phone)
                check_layers(browser)
                browser.picture(folder / f"{name}-layers.png")
        finally:
            browser.close()
    print(f"check_compare_page: {len(failures)} of the above failed" if failures else "check_compare_page: all holds")
    return 1 if failures else 0


sys.exit(main())
