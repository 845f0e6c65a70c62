"""Drives `lumiscope view --offscreen` with scripts and checks what the pictures show.

    offscreen_test.py LUMISCOPE FOLDER
"""
import base64
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys

from pictures import Picture, difference, truncated_glb

PROGRAM, FOLDER = sys.argv[1], pathlib.Path(sys.argv[2])
os.environ["XDG_CACHE_HOME"] = str(FOLDER / "cache")
SMALL = ["--set", "render.width=320", "--set", "render.height=180", "--set", "accumulate.limit=on",
         "--set", "accumulate.max-samples=4"]
PICTURE = (20, 160, 900, 660)  # inside the picture area at 1280x800, clear of labels and colour bars


class Skipped(Exception):
    """What a test needs is not here."""


def view(name, script, scene="cornell", options=SMALL, code=0):
    out = FOLDER / name
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    played = []
    if script is not None:
        (out / "script.txt").write_text(script)
        played = ["--script", out / "script.txt"]
    run = subprocess.run([PROGRAM, "view", scene, "--offscreen", "--json", "--out", out, *played, *options],
                         capture_output=True, text=True, timeout=400)
    assert run.returncode == code, f"{name}: exit code {run.returncode}, expected {code}\n{run.stderr}"
    return out, json.loads(run.stdout) if code == 0 else run.stderr


def test_buffers_and_wipe():
    out, report = view("buffers", """
wait-load
wait-spp 4
shot image
key b
text normal
key Enter
wait-shown
shot normal
key 1
wait-shown
click layout:Wipe
click chip:1:module
click module:accumulate
click chip:1:buffer
text normal
click buffer:normal
wait-shown
wait-spp 4
shot wipe
drag wipe -200 0
shot wiped
click layout:Side by side
wait-shown
shot sides
""")
    image, normal, wipe, wiped = (Picture(out / f"{n}.png") for n in ("image", "normal", "wipe", "wiped"))
    assert difference(image, normal, PICTURE) > 15, "another buffer must look different"
    left, right = (20, 160, 440, 660), (490, 160, 900, 660)
    assert difference(wipe, image, left) < 4, "left of the wipe is the image"
    assert difference(wipe, normal, right) < 4, "right of the wipe are the normals"
    assert difference(wiped, normal, (300, 160, 440, 660)) < 4, "the wipe followed the pointer"
    sides = Picture(out / "sides.png")
    assert difference(sides, wipe, PICTURE) > 5, "side by side is another layout"
    assert report["errors"] == [], report["errors"]
    assert report["ui_ms"]["p99"] < 8, report["ui_ms"]


def test_exposure_parameters_and_undo():
    out, _ = view("exposure", """
wait-load
wait-spp 4
key tab
shot plain
key ]
key ]
key ]
key ]
wait-shown
shot brighter
key ctrl+z
key ctrl+z
key ctrl+z
key ctrl+z
wait-shown
shot undone
key tab
drag view.0.exposure 30 0
wait-shown
shot dragged
click reset:view.0.exposure
wait-shown
key tab
shot reset
""")
    shots = {n: Picture(out / f"{n}.png") for n in ("plain", "brighter", "undone", "dragged", "reset")}
    whole = (40, 40, 1240, 760)
    assert shots["brighter"].mean(whole) > 1.15 * shots["plain"].mean(whole), "four quarter stops are a stop"
    assert difference(shots["undone"], shots["plain"], whole) == 0, "undo goes back to the same picture"
    assert difference(shots["reset"], shots["plain"], whole) == 0, "reset goes back to the same picture"
    assert shots["dragged"].mean(PICTURE) > shots["plain"].mean(PICTURE), "the slider brightens"


def test_overlays_zoom_and_files():
    truncated = FOLDER / "truncated.glb"
    FOLDER.mkdir(parents=True, exist_ok=True)
    truncated_glb(truncated)
    out, report = view("overlays", f"""
wait-load
wait-spp 4
shot before
key F1
shot help
dump-ui help
key Esc
mouse 470 420
wheel 17
shot zoom
key f
key c
wait-message Camera copied
key F12
wait-message Saved
drop /nowhere/missing.gltf
wait-message missing.gltf
drop {truncated}
wait-message truncated.glb
pause 5
shot error
size 640 480
shot small
size 3840 2160
scale 2
shot large
""")
    before, help_page = Picture(out / "before.png"), Picture(out / "help.png")
    assert difference(before, help_page, (250, 60, 900, 700)) > 8, "help covers the picture"
    items = {item["name"] for item in json.loads((out / "help.json").read_text())["items"]}
    assert "help-overlay" in items, sorted(items)
    zoom = Picture(out / "zoom.png")
    assert difference(before, zoom, PICTURE) > 3, "the wheel zooms"
    saved = [p for p in out.glob("cornell.accumulate.image.*.png")]
    assert len(saved) == 1, saved
    picture = Picture(saved[0])
    assert (picture.width, picture.height) == (320, 180), (picture.width, picture.height)
    assert picture.texts, "a screenshot carries the state"
    error = Picture(out / "error.png")
    assert difference(before, error, (20, 160, 900, 640)) < 4, "a broken file leaves the scene"
    for name in ("missing.gltf", "truncated.glb"):
        assert any(name in text for text in report["errors"]), report["errors"]
    small, large = Picture(out / "small.png"), Picture(out / "large.png")
    assert (small.width, small.height, large.width, large.height) == (640, 480, 3840, 2160)
    assert small.mean((0, 60, 350, 450)) > 3 and large.mean((0, 200, 2800, 2000), 17) > 10, "the picture shows at any size"


def test_long_names_of_files():
    FOLDER.mkdir(parents=True, exist_ok=True)
    name = "long " + 100000 * "x"
    refused, shown = FOLDER / "refused.gltf", FOLDER / "named.gltf"
    refused.write_text(json.dumps({"asset": {"version": "2.0"}, "extensionsRequired": [name]}))
    corners = "data:application/octet-stream;base64," + base64.b64encode(
        struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)).decode()
    shown.write_text(json.dumps({
        "asset": {"version": "2.0"}, "extensionsUsed": [name], "scene": 0, "scenes": [{"nodes": [0], "name": name}],
        "nodes": [{"mesh": 0, "name": name}], "materials": [{"name": name}],
        "meshes": [{"name": name, "primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": corners, "byteLength": 36}]}))
    out, report = view("long", f"""
wait-load
wait-spp 1
drop {refused}
wait-message refused.gltf
pause 3
shot refused
drop {shown}
wait-message named.gltf
wait-load
wait-spp 1
pause 3
shot shown
""")
    assert max(len(text) for text in report["errors"]) < 5000, [len(text) for text in report["errors"]]


def test_time_steps_and_buffers():
    out, report = view("time", """
wait-load
wait-shown
key ctrl+space
pause 2
key r
wait-frame 0
key .
wait-frame 1
key .
wait-frame 2
key tab
shot second
key ,
wait-frame 1
shot first
key .
wait-frame 2
shot second-again
key space
key .
wait-frame 3
key .
wait-frame 4
key ctrl+f12
wait-message Saved
key r
wait-frame 0
shot restarted
""", scene="parade",
                       options=["--set", "render.width=160", "--set", "render.height=90", "--module", "none", "--set", "render.spp=2"])
    whole = (40, 40, 1240, 760)
    first, second, again, restarted = (Picture(out / f"{n}.png") for n in ("first", "second", "second-again", "restarted"))
    assert difference(first, second, whole) > 1, "each frame has samples of its own"
    assert difference(second, again, whole) == 0, "a step forward after a step back draws the same frame"
    assert difference(restarted, second, whole) > 1, "the beginning has other samples"
    exr = list(out.glob("parade.none.image.*.exr"))
    assert len(exr) == 1, exr
    data = exr[0].read_bytes()
    for layer in (b"albedo.R", b"normal.X", b"motion.X", b"objectId", b"directDiffuse.R", b"lumiscope"):
        assert layer in data, layer
    assert report["errors"] == [], report["errors"]


def test_frames_are_shot_one_by_one():
    options = ["--set", "render.width=64", "--set", "render.height=36", "--module", "none", "--fps", "30", "--frames", "2..5",
               "--warm-up", "1", "--buffers", "depth,normal", "--half"]
    out, report = view("frames", None, scene="parade", options=options)
    names = [f"parade.{n:04}.{kind}" for n in (2, 3, 4) for kind in ("png", "exr")]
    assert [pathlib.Path(f).name for f in report["files"]] == names, report["files"]
    subprocess.run([PROGRAM, "render", "parade", *options[:8], "--frames", "1..5", "--buffers", "depth,normal", "--half", "--quiet",
                    "--out", out / "render.%04d.exr"], check=True)
    for n in (2, 3, 4):
        shown, rendered = (out / f"parade.{n:04}.exr").read_bytes(), (out / f"render.{n:04}.exr").read_bytes()
        assert shown[-4096:] == rendered[-4096:], f"frame {n} is that of render"
    _, text = view("frames-mistake", "wait-load\n", options=["--frames", "3"], code=2)
    assert "--frames" in text, text


def test_channels_are_called_by_their_letters():
    out, _ = view("channels", """
wait-load
wait-spp 4
click view.0.channel
dump-ui colours
click view.0.channel:G
wait-shown
key tab
shot green
key tab
key b
text depth
key Enter
wait-shown
dump-ui depth
""")
    names = lambda file: {item["name"] for item in json.loads((out / file).read_text())["items"]}
    assert {f"view.0.channel:{c}" for c in ("All", "R", "G", "B")} <= names("colours.json")
    assert "view.0.channel" not in names("depth.json"), "one channel leaves no choice"
    green = Picture(out / "green.png")
    assert all(r == g == b for r, g, b in (green.pixel(x, 400) for x in range(100, 1180, 20))), "one channel is grey"


def test_the_light_of_the_signals():
    out, _ = view("signals", """
wait-load
wait-spp 4
click signals
wait-signals
shot good
dump-ui good
click close-signals
dump-ui closed
""")
    names = lambda file: {item["name"] for item in json.loads((out / file).read_text())["items"]}
    assert {"signals-drawer", "check-signals", "check-scenes"} <= names("good.json"), names("good.json")
    assert "signals-drawer" not in names("closed.json")
    light = [i for i in json.loads((out / "good.json").read_text())["items"] if i["name"] == "signals"][0]
    r, g, b = Picture(out / "good.png").pixel(round(light["x"] + 10), round(light["y"] + light["height"] / 2))
    assert g > 150 and r < 140, (r, g, b)


def test_metrics_against_a_reference():
    out, report = view("measure", """
wait-load
wait-spp 4
shot picture
click tab:Measure
click reference-samples:256
click make-reference
wait-metrics
dump-ui measured
key m
wait-metrics
shot map
key m
key g
wait-metrics
shot reference
key F12
wait-message Saved
key ]
key ]
key ]
key ]
pause 2
wait-metrics
shot brighter
click tab:View
key ctrl+m
click close-messages
dump-ui closed
""", options=["--set", "render.width=64", "--set", "render.height=36", "--set", "accumulate.limit=on", "--set",
              "accumulate.max-samples=4"])
    names = lambda file: {item["name"] for item in json.loads((out / file).read_text())["items"]}
    assert {"metric:rmse:0", "metric:ssim:0", "error-map", "clear-reference"} <= names("measured.json"), names("measured.json")
    picture, error, reference = (Picture(out / f"{n}.png") for n in ("picture", "map", "reference"))
    assert difference(picture, error, PICTURE) > 10, "the error map is another picture"
    assert 1 < difference(picture, reference, PICTURE) < 60, "the reference is the same thing with less noise"
    brighter = Picture(out / "brighter.png")
    assert brighter.mean(PICTURE) > reference.mean(PICTURE) + 10, "the reference is shown at the view's exposure"
    assert list(out.glob("cornell.*.reference.*.png")), "F12 saves what the view shows"
    assert "close-messages" not in names("closed.json"), "the drawer's buttons have the mouse"
    assert report["errors"] == [], report["errors"]


def test_flying_changes_the_picture_and_bookmarks_bring_it_back():
    out, _ = view("fly", """
wait-load
wait-spp 4
key tab
shot start
key ctrl+1
hold w
pause 40
lift w
mouse 600 400
press right
mouse 500 380
release right
wait-shown
wait-spp 4
shot flown
key alt+1
wait-shown
wait-spp 4
shot back
""")
    start, flown, back = (Picture(out / f"{n}.png") for n in ("start", "flown", "back"))
    whole = (40, 40, 1240, 700)
    assert difference(start, flown, whole) > 4, "the camera moved"
    # The samples are others than at the start: what is left is noise.
    assert difference(start, back, whole) < 0.5 * difference(start, flown, whole), "the bookmark brings the view back"


def test_same_script_gives_same_bytes():
    script = "wait-load\nwait-spp 4\nkey tab\npause 2\nshot picture\n"
    first, _ = view("bytes-1", script)
    second, _ = view("bytes-2", script)
    assert (first / "picture.png").read_bytes() == (second / "picture.png").read_bytes()


def test_ui_thread_stays_quick_while_sponza_renders():
    assets = pathlib.Path(os.environ.get("LUMISCOPE_ASSETS", pathlib.Path(__file__).parents[3] / "shared" / "assets"))
    sponza = assets / "gltf" / "Sponza" / "Sponza.gltf"
    if not sponza.exists():
        raise Skipped("no " + str(sponza))
    _, report = view("sponza", """
wait-load
mouse 500 400
wait-frames 2
click tab:Scene
click section:Materials
pause 100
click tab:Render
pause 100
click tab:Profile
click tab:View
hold w
pause 60
lift w
wait-frames 2
shot sponza
""", scene=str(sponza), options=[])
    print(f"        Sponza: first image after {report['first_image_s']:.1f} s, UI thread {report['ui_ms']}")
    assert report["ui_ms"]["p99"] < 8, report["ui_ms"]


def test_a_pinned_pixel_tells_what_made_it():
    out, _ = view("lineage", """
wait-load
set view.0.module svgf
wait-frames 4
mouse 400 400
press left
release left
wait-frames 2
dump-lineage pinned
shot pinned
""")
    lineage = json.loads((out / "pinned.json").read_text())["svgf"]
    stages = {}
    for row in lineage["rows"]:
        stages[row["stage"]] = stages.get(row["stage"], 0) + row["weight"]
    expected = {"history"} | {f"{light}, level {n}" for light in ("direct", "indirect") for n in range(1, 6)}
    assert set(stages) == expected, stages
    assert all(abs(sum - 1) < 1e-4 for sum in stages.values()), stages
    assert {"verdict", "at"} <= set(lineage["rows"][0]), lineage["rows"][0]


def test_mistakes_are_named():
    _, text = view("mistake-1", "wait-load\nshoot a\n", code=3)
    assert "script.txt:2" in text and "shot" in text, text
    _, text = view("mistake-2", "wait-load\nclick tab:Vieww\n", code=3)
    assert "tab:View" in text, text
    _, text = view("mistake-3", "wait-load\n", scene=str(FOLDER / "none.gltf"), code=3)
    assert "none.gltf" in text, text


if __name__ == "__main__":
    failures = 0
    for name, test in list(globals().items()):
        if not name.startswith("test_"):
            continue
        try:
            test()
            print(f"passed  {name}", flush=True)
        except Skipped as reason:
            print(f"skipped {name}: {reason}", flush=True)
        except AssertionError as error:
            failures += 1
            print(f"FAILED  {name}: {error}", flush=True)
    sys.exit(1 if failures else 0)
