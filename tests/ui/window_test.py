"""Drives a real window under Xvfb with real input events and checks the screen.

    window_test.py LUMISCOPE FOLDER

Exit code 77 (skipped) if Xvfb, xdotool, ImageMagick or python3-xlib is missing.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

from pictures import Picture, difference, truncated_glb

PROGRAM, FOLDER = sys.argv[1], pathlib.Path(sys.argv[2])
HERE = pathlib.Path(__file__).parent
PICTURE = (20, 160, 900, 660)
PATIENCE = 90  # seconds for anything; machines that build at the same time are slow

OBJ = """mtllib dropped.mtl
usemtl glow
v -1 -1 0
v 1 -1 0
v 0 1 0
f 1 2 3
"""


def skip_unless_installed():
    missing = [tool for tool in ("Xvfb", "xdotool", "import") if not shutil.which(tool)]
    try:
        import Xlib  # noqa: F401
    except ImportError:
        missing.append("python3-xlib")
    if missing:
        print("skipped: not installed: " + ", ".join(missing))
        sys.exit(77)


class Screen:
    """An X server without a monitor."""

    def __enter__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp", "-noreset"],
                                       pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as answer:
            number = answer.readline().strip()
        assert number, "Xvfb did not start"
        os.environ["DISPLAY"] = ":" + number
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()


class Window:
    """The program's window and a hand on its mouse and keyboard."""

    def __init__(self):
        shutil.rmtree(FOLDER, ignore_errors=True)
        self.captures, self.map = FOLDER / "captures", FOLDER / "ui.json"
        self.captures.mkdir(parents=True)
        environment = {**os.environ, "XDG_CONFIG_HOME": str(FOLDER / "config")}
        self.process = subprocess.Popen(
            [PROGRAM, "cornell", "--ui-map", self.map, "--captures", self.captures, "--set", "render.width=320",
             "--set", "render.height=180", "--set", "accumulate.limit=on", "--set", "accumulate.max-samples=16"],
            env=environment)
        self.id = self.until("the window to appear", self._find)
        self.tool("windowfocus", "--sync", self.id)
        self.until("the picture's label", lambda: "chip:0:buffer" in self.items())

    def _find(self):
        assert self.process.poll() is None, f"the program ended with {self.process.returncode}"
        found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "Lumiscope"], capture_output=True, text=True)
        return found.stdout.split()[0] if found.stdout.split() else None

    @staticmethod
    def until(what, condition):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            result = condition()
            if result:
                return result
            time.sleep(0.1)
        raise AssertionError("waited in vain for " + what)

    @staticmethod
    def tool(*arguments):
        subprocess.run(["xdotool", *map(str, arguments)], check=True)

    def items(self):
        try:
            return {item["name"]: item for item in json.loads(self.map.read_text())["items"]}
        except (OSError, ValueError):
            return {}

    def place(self, name, across=0.5, down=0.5):
        item = self.until(f'"{name}" on the screen', lambda: self.items().get(name))
        return round(item["x"] + across * item["width"]), round(item["y"] + down * item["height"])

    def click(self, name, across=0.5):
        self.tool("mousemove", *self.place(name, across))
        time.sleep(0.15)
        self.tool("click", 1)
        time.sleep(0.4)

    def drag(self, name, dx, button=1):
        x, y = self.place(name)
        self.tool("mousemove", x, y, "mousedown", button)
        time.sleep(0.2)
        for step in range(1, 9):
            self.tool("mousemove", x + dx * step // 8, y)
            time.sleep(0.05)
        self.tool("mouseup", button)
        time.sleep(0.4)

    def key(self, *names):
        for name in names:
            self.tool("key", name)
            time.sleep(0.25)

    def capture(self):
        """The file that F12 writes now."""
        before = set(self.captures.glob("*.png"))
        time.sleep(0.6)  # what was asked for before is drawn
        self.key("F12")
        new = self.until("a screenshot", lambda: set(self.captures.glob("*.png")) - before)
        return new.pop()

    def capture_at_rest(self, wanted=None):
        """A capture of frame `wanted`, or of the frame that stays."""
        last = self.capture()

        def rests():
            nonlocal last
            before, last = last, self.capture()
            return frame_of(last) == (frame_of(before) if wanted is None else wanted)
        if wanted is None or frame_of(last) != wanted:
            self.until(f"frame {'that stays' if wanted is None else wanted}", rests)
        return last

    def shot(self, name):
        path = FOLDER / f"{name}.png"
        subprocess.run(["import", "-window", "root", "-depth", "8", "-define", "png:color-type=2",
                        "-define", "png:compression-filter=0", path], check=True)
        return Picture(path)

    def settled_shot(self, name):
        """A picture that no longer changes: the target of samples is reached."""
        last = self.shot(name)

        def same():
            nonlocal last
            time.sleep(0.7)
            now, before = self.shot(name), last
            last = now
            return difference(now, before, PICTURE) == 0
        self.until("the picture to come to rest", same)
        return last

    def title(self):
        return subprocess.run(["xdotool", "getwindowname", self.id], capture_output=True, text=True).stdout.strip()


def frame_of(capture):
    """cornell.accumulate.image.0007.png, or ...0007-2.png"""
    return int(re.search(r"\.(\d{4,})[^.]*\.png$", capture.name).group(1))


def passed(what):
    print("passed  " + what, flush=True)


def walk_through_time(window):
    """Pause, step, step back, restart and play, each told by the frame numbers of screenshots; EXR."""
    window.click("layout:One view")
    window.click("pause-rendering")
    first = window.capture_at_rest()
    window.key("period")
    window.capture_at_rest(frame_of(first) + 1)
    window.key("comma")
    again = window.capture_at_rest(frame_of(first))
    assert Picture(again).rows == Picture(first).rows, "a step back shows the same picture"
    window.key("r")
    window.capture_at_rest(0)
    window.click("pause-rendering")
    window.click("play")
    time.sleep(1.5)
    window.click("play")
    window.click("pause-rendering")
    assert frame_of(window.capture()) > 0, "frames follow while it plays"
    window.key("ctrl+F12")
    exr = window.until("the EXR", lambda: list(window.captures.glob("*.exr")))[0]
    data = exr.read_bytes()
    for layer in (b"albedo.R", b"normal.X", b"depth.Z", b"lumiscope"):
        assert layer in data, f"{exr.name} lacks {layer}"
    window.click("pause-rendering")
    passed("pauses, steps, steps back, restarts, plays, and saves an EXR")


def walk_through(window):
    start = window.settled_shot("01-start")
    assert start.mean(PICTURE) > 8, "the scene is on the screen"
    assert "Cornell" in window.title(), window.title()
    passed("opens with a picture")

    window.key("ctrl+1")
    x, y = window.place("picture")
    window.tool("mousemove", x, y, "mousedown", 3)
    window.tool("keydown", "s")
    for step in range(10):
        window.tool("mousemove_relative", "--", -6, 0)
        time.sleep(0.06)
    window.tool("keyup", "s", "mouseup", 3)
    away = difference(start, window.settled_shot("02-flown"), PICTURE)
    assert away > 4, "the camera flew"
    window.key("alt+1")
    flown = window.settled_shot("03-back")
    # The samples are others than at the start: what is left is noise.
    assert difference(start, flown, PICTURE) < 0.5 * away, "the bookmark brings it back"
    passed("flies with keys and mouse")

    window.click("chip:0:buffer")
    window.tool("type", "normal")
    time.sleep(0.5)
    window.key("Return")
    normal = window.settled_shot("04-normal")
    assert difference(flown, normal, PICTURE) > 12, "the buffer changed"
    window.key("1")
    image = window.settled_shot("05-image")
    assert difference(flown, image, PICTURE) < 3, "key 1 shows the image again"
    passed("changes the buffer by search and by key")

    window.click("view.0.exposure", across=0.62)
    brighter = window.settled_shot("06-exposure")
    assert brighter.mean(PICTURE) > 1.2 * image.mean(PICTURE), "a click on the slider brightens the picture"
    window.click("reset:view.0.exposure")
    assert difference(window.settled_shot("07-reset"), image, PICTURE) < 3, "reset takes it back"
    passed("changes a parameter by clicking, and resets it")

    window.click("layout:Wipe")
    window.click("chip:1:buffer")
    window.tool("type", "depth")
    time.sleep(0.5)
    window.key("Return")
    before = window.items()["wipe"]["x"]
    window.drag("wipe", -220)
    time.sleep(2)  # the raw frame's depth is drawn anew with every frame: there is no rest to wait for
    wiped = window.shot("08-wiped")
    moved = window.items()["wipe"]["x"] - before
    assert abs(moved + 220) < 8, f"the wipe moved by {moved}"
    assert difference(wiped, image, (480, 200, 700, 640)) > 12, "right of the wipe is the depth"
    passed("drags the wipe")

    window.key("F12")
    saved = window.until("the screenshot", lambda: list(window.captures.glob("*.png")))
    time.sleep(0.5)
    picture = Picture(saved[0])
    assert (picture.width, picture.height) == (320, 180), "a screenshot has the rendered size"
    assert picture.texts, "a screenshot carries the state"
    passed("saves a screenshot with its state")

    walk_through_time(window)

    window.key("F1")
    assert difference(window.shot("09-help"), wiped, (250, 60, 900, 700)) > 8, "help is on the screen"
    window.key("Escape")

    dropped = FOLDER / "dropped.obj"
    dropped.write_text(OBJ)
    (FOLDER / "dropped.mtl").write_text("newmtl glow\nKd 0 0 0\nKe 1 0.2 0.1\n")
    shown = window.shot("10-dropped")
    subprocess.run([sys.executable, HERE / "xdnd_source.py", window.id, str(x), str(y), dropped], check=True)
    window.until("the dropped scene", lambda: window.title().startswith("dropped"))
    window.until("its picture", lambda: difference(window.shot("10-dropped"), shown, PICTURE) > 5)
    after = window.shot("10-dropped")
    passed("opens a dropped file")

    not_json = FOLDER / "broken.gltf"
    not_json.write_text("{ this is no glTF")
    truncated = FOLDER / "truncated.glb"
    truncated_glb(truncated)
    for broken in (not_json, truncated, FOLDER / "missing.glb"):
        subprocess.run([sys.executable, HERE / "xdnd_source.py", window.id, str(x), str(y), broken], check=True)
        window.until(f"the message about {broken.name}",
                     lambda: any(name.startswith("toast:") and broken.name in name for name in window.items()))
        assert window.title().startswith("dropped"), "a broken file leaves the scene"
        assert difference(window.shot("11-" + broken.stem), after, (20, 160, 900, 500)) < 2, "and its picture"
    passed("keeps the scene and says why when a file is broken, truncated or missing")

    window.key("ctrl+q")
    assert window.process.wait(PATIENCE) == 0, "quits with exit code 0"
    passed("quits")


if __name__ == "__main__":
    skip_unless_installed()
    bare = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    blind = subprocess.run([PROGRAM, "cornell"], env=bare, capture_output=True, text=True, timeout=60)
    assert blind.returncode == 4 and "render" in blind.stderr, f"{blind.returncode}: {blind.stderr}"
    passed("without a display: exit code 4 and what to do instead")
    with Screen():
        opened = Window()
        try:
            walk_through(opened)
        except AssertionError as error:
            print(f"FAILED  {error} (screenshots: {FOLDER})", flush=True)
            sys.exit(1)
        finally:
            if opened.process.poll() is None:
                opened.process.kill()
