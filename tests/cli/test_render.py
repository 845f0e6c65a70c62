"""render: files, names, frames, determinism, interruption."""
import os
import shutil
import signal
import subprocess
import time
import unittest

from lumiscope import CommandTest, PROGRAM, SOURCE, TINY, exr_header, main

QUIET = [*TINY, "--quiet"]


class Render(CommandTest):
    def test_json(self):
        result = self.good("render", "cornell", *TINY, "--spp", 2, "--out", "a.png", "--json")
        value = result.json
        self.assertEqual(value["frames"], 1)
        self.assertIn("trace", value["stages_ms"])
        self.assertGreater(value["rays"], 24 * 16 * 2)
        self.assertGreater(value["mrays_per_s"], 0)
        self.assertGreater(value["peak_memory_bytes"], 1 << 20)
        self.assertEqual(value["warnings"], [])
        self.assertEqual(value["files"], ["a.png"])

    def test_tells_what_a_method_holds(self):
        result = self.good("render", "cornell", *TINY, "--module", "stable", "--frames", 2, "--out", "%d.png", "--json")
        held = result.json["module_bytes"]["stable"] / (24 * 16)
        self.assertGreater(held, 99)  # a word, where its samples begin, and 73 bytes for each of about 1.25 samples
        self.assertIn("stable holds", result.err)
        self.assertIn(f", {held:.0f} bytes a pixel", result.err)

    def test_results_go_to_standard_output_and_the_rest_does_not(self):
        result = self.good("render", "cornell", *TINY, "--out", "a.png")
        self.assertEqual(result.out, "")
        self.assertIn("Wrote a.png", result.err)
        result = self.good("render", "cornell", *QUIET, "--out", "a.png")
        self.assertEqual((result.out, result.err), ("", ""))
        self.assertNotIn("\r", self.good("render", "cornell", *TINY, "--out", "a.png").err)

    def test_the_number_of_threads_does_not_matter(self):
        names = ("a.exr", "a.png")
        seen = set()
        for threads in (1, 2, 8):
            self.good("render", "cornell", *QUIET, "--size", "61x47", "--spp", 3, "--frames", 2, "--threads", threads,
                      "--buffers", "all", *sum((["--out", n] for n in names), []))
            seen.add(tuple(self.bytes(n) for n in names))
        self.assertEqual(len(seen), 1)

    def test_the_same_command_gives_the_same_bytes_anywhere(self):
        self.good("render", "cornell", *QUIET, "--out", "a.exr")
        self.good("render", "cornell", *QUIET, "--out", "deeper/b.exr", "--memory-limit", "4G")
        self.assertEqual(self.bytes("a.exr"), self.bytes("deeper/b.exr"))
        self.good("render", "cornell", *QUIET, "--seed", 1, "--out", "c.exr")
        self.assertNotEqual(self.bytes("a.exr"), self.bytes("c.exr"))

    def test_samples_in_one_frame_equal_frames_of_one(self):
        self.good("render", "cornell", *QUIET, "--spp", 6, "--out", "one.png")
        self.good("render", "cornell", *QUIET, "--frames", 6, "--out", "six.png")
        self.assertEqual(pixels(self.bytes("one.png")), pixels(self.bytes("six.png")))

    def test_the_default_name_is_never_overwritten(self):
        for _ in range(3):
            self.good("render", "cornell", *QUIET)
        self.good("render", "cornell", *QUIET, "--module", "none")
        self.assertEqual(self.files(), ["cornell.accumulate-1.exr", "cornell.accumulate-2.exr", "cornell.accumulate.exr",
                                        "cornell.none.exr"])

    def test_frame_numbers_in_names(self):
        self.good("render", "cornell", *QUIET, "--frames", "2..5", "--out", "f%04d.png", "--out", "last.exr",
                  "--out", "100%%-%d.png")
        self.assertEqual(self.files(), ["100%-2.png", "100%-3.png", "100%-4.png", "f0002.png", "f0003.png", "f0004.png",
                                        "last.exr"])

    def test_a_range_begins_with_empty_history(self):
        common = ["render", "cornell", *QUIET]
        self.good(*common, "--frames", "4..6", "--out", "cold.png")
        self.good(*common, "--frames", "4..6", "--warm-up", 4, "--out", "warm.png")
        self.good(*common, "--frames", "6", "--out", "all.png")
        self.assertNotEqual(pixels(self.bytes("cold.png")), pixels(self.bytes("warm.png")))
        self.assertEqual(pixels(self.bytes("warm.png")), pixels(self.bytes("all.png")))

    def test_a_stereo_pair_is_both_eyes(self):
        result = self.good("render", "cornell", *TINY, "--stereo", "--spp", 2, "--set", "camera.interaxial=0.4", "--out", "a.exr",
                           "--out", "a.png", "--json")
        self.assertEqual(result.json["files"], ["a.left.exr", "a.left.png", "a.right.exr", "a.right.png"])
        self.assertEqual(result.json["frames"], 2)
        self.assertFalse((self.folder / "a.exr").exists())
        for eye in ("left", "right"):
            self.good("render", "cornell", *QUIET, "--spp", 2, "--set", "camera.stereo=" + eye, "--set", "camera.interaxial=0.4",
                      "--out", "one.exr", "--out", "one.png")
            for kind in ("exr", "png"):
                self.assertEqual(self.bytes("one." + kind), self.bytes(f"a.{eye}.{kind}"))
            self.good("render", "--replay", f"a.{eye}.png", "--quiet", "--out", "again.png")
            self.assertEqual(self.bytes("again.png"), self.bytes(f"a.{eye}.png"))
        self.assertNotEqual(self.bytes("a.left.png"), self.bytes("a.right.png"))
        # Each eye's frames are kept, and go on, by themselves.
        frames = ["render", "cornell", *QUIET, "--stereo", "--frames", 2, "--out", "s.%d.png"]
        self.good(*frames)
        before = self.bytes("s.1.right.png")
        (self.folder / "s.1.right.png").unlink()
        value = self.good(*frames, "--json").json
        self.assertEqual((value["frames_kept"], self.bytes("s.1.right.png")), (3, before))
        self.good("render", "cornell", *QUIET, "--stereo")
        self.assertTrue((self.folder / "cornell.accumulate.left.exr").exists())
        self.assertTrue((self.folder / "cornell.accumulate.right.exr").exists())
        self.refused(2, ["both eyes are rendered", "--set"], "render", "cornell", *QUIET, "--stereo", "--set", "camera.stereo=left")
        self.refused(2, ["--replay"], "render", "--replay", "a.left.png", "--stereo", "--quiet")

    def test_layers(self):
        self.good("render", "cornell", *QUIET, "--out", "plain.exr")
        self.assertEqual(set(exr_header(self.bytes("plain.exr"))["channels"]), {"R", "G", "B", "A", "Z"})
        self.good("render", "cornell", *QUIET, "--out", "some.exr", "--buffers", "albedo,objectId,sampleCount", "--half")
        channels = exr_header(self.bytes("some.exr"))["channels"]
        self.assertEqual(channels["albedo.R"], "half")
        self.assertEqual(channels["Z"], "float")
        self.assertEqual(channels["objectId"], "uint")
        self.assertEqual(channels["accumulate-sampleCount.Y"], "float")
        self.assertNotIn("normal.X", channels)
        self.good("render", "cornell", *QUIET, "--out", "all.exr", "--buffers", "all")
        header = exr_header(self.bytes("all.exr"))
        self.assertGreater(len(header["channels"]), 55)
        for attribute in ("lumiscope", "worldToCamera", "worldToNDC"):
            self.assertIn(attribute, header)

    def test_options_are_parameters(self):
        self.good("render", "cornell", *QUIET, "--spp", 3, "--exposure", "-1.5", "--camera", "corner", "--seed", 4, "--out", "a.png")
        self.good("render", "cornell", "--quiet", "--set", "render.width=24", "--set", "render.height=16", "--set",
                  "render.spp=3", "--set", "view.0.exposure=-1.5", "--set", "camera.select=corner", "--set",
                  "render.seed=4", "--out", "b.png")
        self.assertEqual(self.bytes("a.png"), self.bytes("b.png"))

    def test_a_png_shows_any_buffer(self):
        self.good("render", "cornell", *QUIET, "--out", "image.png")
        self.good("render", "cornell", *QUIET, "--out", "normal.png", "--set", "view.0.buffer=normal")
        self.good("render", "cornell", *QUIET, "--out", "tap.png", "--set", "view.0.buffer=sampleCount")
        self.assertEqual(len({pixels(self.bytes(n)) for n in ("image.png", "normal.png", "tap.png")}), 3)

    @unittest.skipUnless(shutil.which("ffmpeg"), "no ffmpeg program")
    def test_video(self):
        self.good("render", "cornell", *QUIET, "--frames", 4, "--out", "a.mp4")
        self.assertEqual(self.files(), ["a.mp4"])
        video = self.bytes("a.mp4")
        self.assertGreater(len(video), 500)
        self.refused(2, ["a.mp4", "exists"], "render", "cornell", *QUIET, "--frames", 4, "--out", "a.mp4")
        self.assertEqual(self.bytes("a.mp4"), video)

    @unittest.skipUnless(shutil.which("ffmpeg"), "no ffmpeg program")
    def test_a_video_leaves_other_files_alone(self):
        (self.folder / "a.partial.mp4").write_text("mine")
        self.good("render", "cornell", *QUIET, "--frames", 2, "--out", "a.mp4")
        self.assertEqual(self.files(), ["a.mp4", "a.partial.mp4"])
        self.assertEqual(self.bytes("a.partial.mp4"), b"mine")

    def test_without_ffmpeg_a_video_becomes_pictures(self):
        result = self.good("render", "cornell", *TINY, "--frames", 2, "--out", "walk.mp4", "--json",
                           PATH=str(self.folder))
        self.assertEqual(self.files(), ["walk.0000.png", "walk.0001.png"])
        self.assertEqual(result.json["files"], self.files())
        self.assertTrue(any("ffmpeg" in warning and "walk.mp4" in warning for warning in result.json["warnings"]))
        self.assertIn("warning: walk.mp4", result.err)

    def test_a_scene_may_be_called_anything(self):
        shutil.copy(SOURCE / "scenes/cornell.json", self.folder / "100% d%d.json")
        self.good("render", "100% d%d.json", *QUIET)
        self.assertEqual(self.files(), ["100% d%d.accumulate.exr", "100% d%d.json"])

    def test_one_frame_may_have_a_time(self):
        self.good("render", "parade", *QUIET, "--set", "time=0.5", "--out", "set.png")
        self.good("render", "parade", *QUIET, "--out", "start.png")
        self.assertNotEqual(pixels(self.bytes("set.png")), pixels(self.bytes("start.png")))

    def test_an_interrupt_ends_it(self):
        process = subprocess.Popen([PROGRAM, "render", "cornell", "--spp", "65536", "--out", "a.png"], cwd=self.folder,
                                   stderr=subprocess.PIPE)
        time.sleep(1.5)
        started = time.time()
        process.send_signal(signal.SIGINT)
        _, error = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertIn(b"interrupted", error)
        self.assertLess(time.time() - started, 20)
        self.assertEqual(self.files(), [])

    def test_an_interrupt_ends_a_video_and_keeps_its_frames(self):
        (self.folder / "bin").mkdir()
        stuck = self.folder / "bin/ffmpeg"
        stuck.write_text("#!/bin/sh\nexec sleep 200\n")
        stuck.chmod(0o755)
        process = subprocess.Popen([PROGRAM, "render", "cornell", *QUIET, "--frames", "3", "--out", "a.mp4"], cwd=self.folder,
                                   stderr=subprocess.PIPE, start_new_session=True, env={**os.environ, "PATH": f"{self.folder}/bin:{os.environ['PATH']}"})
        begun = time.time()
        while len(list(self.folder.glob("a.mp4.frames/*.png"))) < 3 and time.time() - begun < 100:
            time.sleep(0.05)
        time.sleep(1)
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does
        _, error = process.communicate(timeout=60)
        self.assertEqual((process.returncode, b"interrupted" in error), (130, True), error)
        self.assertEqual(len(list(self.folder.glob("a.mp4.frames/*.png"))), 3)
        self.good("render", "cornell", *QUIET, "--frames", "3", "--out", "a.mp4")
        self.assertEqual(self.files(), ["a.mp4", "bin"])

    def test_progress_when_asked_for(self):
        result = self.good("render", "cornell", "--size", "400x300", "--spp", 24, "--out", "a.png", "--progress", "always")
        self.assertIn("%", result.err)
        self.assertIn("frame 0 of 0..1", result.err)


def pixels(png):
    """The image data alone: what is shown, without the state."""
    return png[png.index(b"IDAT"):]


if __name__ == "__main__":
    main()
