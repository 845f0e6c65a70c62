"""render --frames: series and videos that go on after an interruption, and cameras that follow a path."""
import json
import os
import shutil
import signal
import subprocess
import time
import unittest

from lumiscope import CommandTest, PROGRAM, TINY, main

WALK = ["walk.json", *TINY, "--fps", 30, "--spp", 2]
SCENE = """{"version": 1,
 "assets": {"ball": {"sphere": {"radius": 0.5}}, "floor": {"rectangle": {"size": [6, 6]}}},
 "instances": [{"asset": "floor"}, {"asset": "ball", "keys": [{"time": 0, "translate": [-1, 0.5, 0]},
                                                              {"time": 2, "translate": [1, 0.5, 0]}]}],
 "environment": {"constant": [1, 0.9, 0.8]},
 "cameras": {"main": {"eye": [0, 1, 4], "look-at": [0, 0.5, 0],
                      "keys": [{"time": 0, "eye": [0, 1, 4]}, {"time": 2, "eye": [1, 1.5, 4]}]}}}"""


class Sequence(CommandTest):
    def setUp(self):
        super().setUp()
        (self.folder / "walk.json").write_text(SCENE)

    def files(self):
        return [name for name in super().files() if name != "walk.json"]

    def wait_for(self, name):
        begun = time.time()
        while not (self.folder / name).exists():
            self.assertLess(time.time() - begun, 60, f"{name} never came")
            time.sleep(0.01)

    def render(self, *arguments):
        return self.good("render", *WALK, *arguments, "--json").json

    def series(self, pattern, count):
        return [self.bytes(pattern % frame) for frame in range(count)]

    def check_resume(self, module, missing):
        self.render("--module", module, "--frames", 6, "--out", f"{module}.%d.exr", "--out", f"{module}.%d.png")
        whole = self.series(module + ".%d.exr", 6) + self.series(module + ".%d.png", 6)
        for frame in missing:
            (self.folder / f"{module}.{frame}.exr").unlink()
        result = self.render("--module", module, "--frames", 6, "--out", f"{module}.%d.exr", "--out", f"{module}.%d.png")
        self.assertEqual(result["files"], [f"{module}.{frame}.exr" for frame in missing])
        self.assertEqual(self.series(module + ".%d.exr", 6) + self.series(module + ".%d.png", 6), whole)
        return result

    def test_a_series_goes_on(self):
        self.assertEqual(self.check_resume("none", [4, 5])["frames_kept"], 4)
        result = self.check_resume("accumulate", [2, 5])
        self.assertEqual(result["frames_kept"], 2)
        again = self.render("--module", "none", "--frames", 6, "--out", "none.%d.exr")
        self.assertEqual((again["frames"], again["frames_kept"], again["files"]), (0, 6, []))
        longer = self.render("--module", "none", "--frames", 8, "--out", "none.%d.exr")
        self.assertEqual((longer["frames_kept"], longer["files"]), (6, ["none.6.exr", "none.7.exr"]))

    def test_history_is_made_again(self):
        common = ["cornell", *TINY, "--quiet", "--out", "h.%d.exr"]
        self.good("render", *common, "--frames", 6)
        whole = self.series("h.%d.exr", 6)
        (self.folder / "h.4.exr").unlink()
        (self.folder / "h.5.exr").unlink()
        self.good("render", *common, "--frames", 6)
        self.assertEqual(self.series("h.%d.exr", 6), whole)

    def test_other_frames_are_never_overwritten(self):
        self.render("--module", "none", "--frames", 3, "--out", "a.%d.exr")
        whole = self.series("a.%d.exr", 3)
        self.refused(2, ["a.0.exr", "another image"], "render", *WALK, "--module", "none", "--frames", 3, "--seed", 1, "--out", "a.%d.exr")
        self.refused(2, ["a.0.exr"], "render", *WALK, "--module", "none", "--frames", 3, "--half", "--out", "a.%d.exr")
        self.assertEqual(self.series("a.%d.exr", 3), whole)
        (self.folder / "a.1.exr").write_bytes(whole[1][:-50])
        self.refused(3, ["a.1.exr"], "render", *WALK, "--module", "none", "--frames", 3, "--out", "a.%d.exr")
        (self.folder / "b.1.png").write_bytes(b"somebody else's")
        self.assertEqual(self.run_program("render", *WALK, "--frames", 3, "--out", "b.%d.png").code, 3)
        self.assertEqual(self.bytes("b.1.png"), b"somebody else's")
        # The state is right, the pixels are not: found out where it goes on from there.
        data = bytearray(whole[2])
        other = self.folder / "a.2.exr"
        self.good("render", *WALK, "--module", "none", "--frames", "2..3", "--seed", 9, "--quiet", "--out", "c.%d.exr")
        state = data[:data.index(b"worldToCamera")]
        foreign = self.bytes("c.2.exr")
        other.write_bytes(bytes(state) + foreign[foreign.index(b"worldToCamera"):])
        (self.folder / "a.1.exr").write_bytes(whole[1])
        self.assertIn(self.run_program("render", *WALK, "--module", "none", "--frames", 4, "--out", "a.%d.exr").code, (2, 3))

    def test_a_frame_that_cannot_be_read_is_named(self):
        self.render("--module", "none", "--frames", 4, "--out", "a.%d.exr")
        (self.folder / "a.2.exr").write_bytes(b"")
        self.refused(3, ["a.2.exr"], "render", *WALK, "--module", "none", "--frames", 4, "--out", "a.%d.exr")
        self.render("--module", "none", "--frames", "2..4", "--out", "b.%d.exr")
        # A frame whose history began elsewhere is another image, though its time is the same.
        self.refused(2, ["b.2.exr", "another image"], "render", *WALK, "--module", "none", "--frames", 4, "--out", "b.%d.exr")

    def test_killed_at_any_moment(self):
        command = [PROGRAM, "render", *map(str, WALK), "--module", "none", "--frames", "40", "--quiet", "--out"]
        subprocess.run([*command, "w.%02d.png"], cwd=self.folder, check=True)
        whole = self.series("w.%02d.png", 40)
        for wait in (0.1, 0.2, 0.3):
            process = subprocess.Popen([*command, "k.%02d.png"], cwd=self.folder)
            time.sleep(wait)
            process.send_signal(signal.SIGKILL)
            process.wait()
        subprocess.run([*command, "k.%02d.png"], cwd=self.folder, check=True)
        self.assertEqual(self.series("k.%02d.png", 40), whole)

    @unittest.skipUnless(shutil.which("ffmpeg"), "no ffmpeg program")
    def test_a_video_goes_on(self):
        command = ["render", *WALK, "--module", "none", "--frames", 12, "--quiet", "--out"]
        (self.folder / "whole.999999999.part.mp4").write_bytes(b"of a process that was killed")
        (self.folder / "whole.1.part.mp4").write_bytes(b"of one that lives")
        self.good(*command, "whole.mp4")
        self.assertEqual(self.files(), ["whole.1.part.mp4", "whole.mp4"])
        (self.folder / "whole.1.part.mp4").unlink()
        process = subprocess.Popen([PROGRAM, *map(str, command), "a.mp4"], cwd=self.folder)
        frames = self.folder / "a.mp4.frames"
        while process.poll() is None and len(list(frames.glob("*.png"))) < 3:
            time.sleep(0.002)
        process.send_signal(signal.SIGKILL)
        process.wait()
        kept = len(list(frames.glob("*.png")))
        if (self.folder / "a.mp4").exists():  # it was killed while it removed the frames of the complete video
            shutil.rmtree(frames, ignore_errors=True)
        else:
            # Killed while it wrote a frame, and while it compared one with what was there.
            for left in ("000003.png.999999999.4.tmp", "000002.999999999.check.png", "000002.999999999.check.png.999999999.0.tmp"):
                (frames / left).write_bytes(b"half of a fra")
            result = self.good(*command[:-2], "--json", "--out", "a.mp4").json
            self.assertGreaterEqual(result["frames_kept"], kept - 1)
            self.assertEqual(result["files"], ["a.mp4"])
        self.assertEqual(self.files(), ["a.mp4", "whole.mp4"])
        self.assertEqual(self.bytes("a.mp4"), self.bytes("whole.mp4"))
        # What somebody else keeps there, or still writes, stays.
        frames = self.folder / "b.mp4.frames"
        frames.mkdir()
        others = ["000001.png.1.0.tmp", "000002.999999999.check.txt", "notes.png.999999999.0.tmp", "notes.txt"]
        for name in others:
            (frames / name).write_bytes(b"kept")
        self.good(*command, "b.mp4")
        self.assertEqual(sorted(path.name for path in frames.iterdir()), others)

    @unittest.skipUnless(shutil.which("ffmpeg"), "no ffmpeg program")
    def test_an_ffmpeg_that_outlives_its_program_leaves_nothing(self):
        (self.folder / "bin").mkdir()
        slow = self.folder / "bin/ffmpeg"
        slow.write_text(f"""#!/bin/sh
touch bin/begun
until [ -e bin/go ]; do sleep 0.02; done
{shutil.which("ffmpeg")} "$@"
touch bin/ended
""")
        slow.chmod(0o755)
        command = ["render", *WALK, "--module", "none", "--frames", 3, "--quiet", "--out", "a.mp4"]
        process = subprocess.Popen([PROGRAM, *map(str, command)], cwd=self.folder,
                                   env={**os.environ, "PATH": f"{self.folder}/bin:{os.environ['PATH']}"})
        self.wait_for("bin/begun")
        process.send_signal(signal.SIGKILL)
        process.wait()
        self.good(*command)
        (self.folder / "bin/go").touch()
        self.wait_for("bin/ended")
        self.assertEqual(self.files(), ["a.mp4", "bin"])

    def test_a_camera_path(self):
        path = {"format": "lumiscope-camera-path", "version": 1, "interpolation": "linear",
                "keys": [{"time": 0, "eye": [0, 1, 3.4], "look-at": [0, 1, 0], "fov-y-deg": 40},
                         {"time": 1, "eye": [1, 1, 3.4], "look-at": [0, 1, 0], "fov-y-deg": 50}]}
        (self.folder / "path.json").write_text(json.dumps(path))
        common = ["cornell", *TINY, "--spp", 4, "--quiet"]
        self.good("render", *common, "--fps", 2, "--frames", "1..2", "--camera-path", "path.json", "--out", "p.%d.exr")
        self.good("render", *common, "--set", "time=0.5", "--set", "camera.eye=0.5,1,3.4", "--set", "camera.look-at=0,1,0",
                  "--set", "camera.fov-y-deg=45", "--out", "s.exr")
        mse = self.good("compare", "p.1.exr", "s.exr", "--metrics", "mse", "--json").json["metrics"]["mse"]
        self.assertNotEqual(mse, None)
        self.good("render", "--replay", "p.1.exr", "--out", "again.exr", "--quiet")
        self.assertEqual(self.bytes("again.exr"), self.bytes("p.1.exr"))
        self.good("reference", *common, "--fps", 2, "--frames", "1..2", "--camera-path", "path.json", "--out", "r.%d.exr")
        mse = self.good("compare", "r.1.exr", "s.exr", "--metrics", "mse", "--json").json["metrics"]["mse"]
        self.assertLess(mse, 1e-9)
        self.refused(3, ["none.json"], "render", *common, "--camera-path", "none.json")

    def test_paths_out_and_in(self):
        self.good("info", "walk.json", "--write-camera-path", "own.json")
        self.good("info", "walk.json", "--write-camera-path", "out.ngp.json")
        own, ngp = (json.loads((self.folder / name).read_text()) for name in ("own.json", "out.ngp.json"))
        self.assertEqual((own["format"], own["version"]), ("lumiscope-camera-path", 1))
        self.assertEqual(len(own["keys"]), len(ngp["path"]))
        self.assertEqual(len(ngp["path"][0]["R"]), 4)
        for name in ("own.json", "out.ngp.json"):
            self.good("render", *WALK, "--frames", "3..4", "--camera-path", name, "--quiet", "--out", name + ".%d.exr")
        self.good("render", *WALK, "--frames", "3..4", "--quiet", "--out", "scene.%d.exr")
        for name in ("own.json", "out.ngp.json"):
            mse = self.good("compare", name + ".3.exr", "scene.3.exr", "--metrics", "mse", "--json").json["metrics"]["mse"]
            self.assertLess(mse, 1e-3)


if __name__ == "__main__":
    main()
