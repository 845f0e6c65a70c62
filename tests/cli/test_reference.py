"""reference and merge: the same bytes by every way; kills, interrupts, damage, several processes."""
import os
import pathlib
import random
import shutil
import signal
import subprocess
import time
import unittest

from lumiscope import CommandTest, PROGRAM, TINY, exr_header, main

MPI_PROGRAM = pathlib.Path(PROGRAM).with_name("lumiscope-mpi")
SIZE = ["--size", "40x30"]


class Reference(CommandTest):
    """Each test has a cache of its own."""

    def setUp(self):
        super().setUp()
        self.cache = pathlib.Path(self.temporary.name + "-cache")
        os.environ["XDG_CACHE_HOME"] = str(self.cache)

    def tearDown(self):
        shutil.rmtree(self.cache, ignore_errors=True)
        super().tearDown()

    def kept(self):
        return sorted(self.cache.glob("lumiscope/references/*/*.lumiref"))

    def reference(self, *arguments):
        return self.good("reference", "cornell", *SIZE, *arguments, "--json").json["references"][0]

    def test_it_is_what_render_makes_of_as_many_samples(self):
        for spp in (1, 16, 50):
            self.good("render", "cornell", *SIZE, "--spp", spp, "--quiet", "--out", "a.exr", "--out", "a.png")
            self.good("reference", "cornell", *SIZE, "--spp", spp, "--quiet", "--out", "b.exr", "--out", "b.png")
            self.assertEqual(self.bytes("a.exr"), self.bytes("b.exr"))
            self.assertEqual(self.bytes("a.png"), self.bytes("b.png"))
        self.good("render", "--replay", "b.exr", "--out", "c.exr", "--quiet")
        self.assertEqual(self.bytes("b.exr"), self.bytes("c.exr"))

    def test_json_and_cache(self):
        first = self.reference("--spp", 256, "--out", "a.exr")
        self.assertEqual((first["samples"], first["cached"], first["frame"]), (256, False, 0))
        self.assertGreater(first["error"], 0)
        self.assertEqual([str(path) for path in self.kept()], [first["cache_file"]])
        second = self.reference("--spp", 256, "--out", "b.exr", "--threads", 1)
        self.assertTrue(second["cached"])
        self.assertEqual(second["error"], first["error"])
        self.assertEqual(self.bytes("a.exr"), self.bytes("b.exr"))
        self.assertFalse(self.reference("--spp", 256, "--seed", 1, "--out", "c.exr")["cached"])
        self.assertNotEqual(self.bytes("a.exr"), self.bytes("c.exr"))
        self.assertTrue(self.reference("--spp", 256, "--fps", 30, "--exposure", 2, "--out", "d.exr")["cached"])

    def test_an_error_as_goal(self):
        at256 = self.reference("--spp", 256, "--out", "a.exr")["error"]
        found = self.reference("--error", at256 * 0.9, "--out", "b.exr")
        self.assertLessEqual(found["error"], at256 * 0.9)
        self.assertIn(found["samples"], (320, 384, 448, 512))
        self.assertTrue(self.reference("--error", at256 * 0.9, "--out", "b.exr")["cached"])
        self.refused(2, ["--error", "--spp"], "reference", "cornell", "--error", "0.1", "--spp", "3")

    def test_the_default_name(self):
        for _ in range(2):
            self.good("reference", "cornell", *TINY, "--spp", 2, "--quiet")
        self.assertEqual(self.files(), ["cornell.reference-1.exr", "cornell.reference.exr"])

    def test_frames_and_layers(self):
        result = self.good("reference", "parade", *TINY, "--spp", 16, "--frames", "4..6", "--fps", 30, "--buffers",
                           "motion,albedo", "--out", "f%03d.exr", "--json").json
        self.assertEqual([entry["frame"] for entry in result["references"]], [4, 5])
        self.assertEqual(self.files(), ["f004.exr", "f005.exr"])
        channels = exr_header(self.bytes("f005.exr"))["channels"]
        self.assertLessEqual({"R", "Z", "motion.X", "motion.Y", "motion.Z", "albedo.R"}, set(channels))
        self.good("render", "parade", *TINY, "--spp", 16, "--set", f"time={5 / 30}", "--quiet", "--out", "one.exr")
        images = self.good("compare", "one.exr", "f005.exr", "--metrics", "mse", "--json").json["metrics"]
        self.assertLess(images["mse"], 1e-9)

    def test_merge(self):
        self.good("reference", "cornell", *SIZE, "--spp", 304, "--quiet", "--out", "whole.exr", "--out", "whole.png")
        for begin, end in ((160, 304), (0, 32), (32, 160)):
            self.good("reference", "cornell", *SIZE, "--samples", f"{begin}..{end}", "--quiet", "--out", f"{begin}.lumiref")
        result = self.good("merge", "160.lumiref", "0.lumiref", "32.lumiref", "--out", "merged.exr", "--json").json
        self.assertEqual((result["first_sample"], result["samples"]), (0, 304))
        self.assertEqual(self.bytes("merged.exr"), self.bytes("whole.exr"))
        self.good("merge", "32.lumiref", "160.lumiref", "--out", "late.lumiref")
        self.good("merge", "late.lumiref", "0.lumiref", "--out", "merged.png")
        self.assertEqual(self.bytes("merged.png"), self.bytes("whole.png"))
        self.refused(3, ["missing"], "merge", "0.lumiref", "160.lumiref", "--out", "x.exr")
        self.refused(3, ["first samples"], "merge", "late.lumiref", "--out", "x.exr")
        self.refused(3, ["overlaps"], "merge", "late.lumiref", "32.lumiref", "--out", "x.exr")
        self.good("reference", "cornell", *SIZE, "--samples", "32..48", "--seed", 3, "--quiet", "--out", "other.lumiref")
        self.refused(3, ["another image", "seed"], "merge", "0.lumiref", "other.lumiref", "--out", "x.exr")
        (self.folder / "text.lumiref").write_text("not a part, but long enough to look like one")
        self.refused(3, ["text.lumiref"], "merge", "0.lumiref", "text.lumiref", "--out", "x.exr")
        self.refused(2, ["x.jpg"], "merge", "0.lumiref", "--out", "x.jpg")
        self.assertNotIn("x.exr", self.files())

    def test_what_is_refused(self):
        for samples in ("0..10", "16", "32..16", "16..16", "a..b", "-16..16", "0..99999984"):
            self.refused(2, ["--samples"], "reference", "cornell", "--samples=" + samples)
        self.refused(2, ["--module"], "reference", "cornell", "--module", "none")
        self.refused(2, ["part.exr"], "reference", "cornell", "--samples", "0..16", "--out", "part.exr")
        self.refused(2, ["--samples", "--spp"], "reference", "cornell", "--samples", "0..16", "--spp", "4")
        self.refused(2, ["a.exr", "%04d"], "reference", "cornell", "--frames", "2", "--out", "a.exr")
        self.refused(2, ["a.mp4"], "reference", "cornell", "--out", "a.mp4")
        self.refused(2, [], "reference")
        self.refused(5, ["limit"], "reference", "cornell", "--size", "4096x4096", "--memory-limit", "300M")

    def test_an_interrupt_keeps_what_is_done(self):
        process = subprocess.Popen([PROGRAM, "reference", "cornell", "--size", "100x75", "--spp", "65536", "--out", "a.exr"],
                                   cwd=self.folder, stderr=subprocess.PIPE)
        deadline = time.time() + 60
        while not self.kept() and time.time() < deadline:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        _, error = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertIn(b"kept", error)
        self.assertEqual(self.files(), [])
        self.assertEqual(len(self.kept()), 1)

    def test_progress_when_asked_for(self):
        result = self.good("reference", "cornell", "--size", "80x60", "--spp", 256, "--out", "a.exr", "--progress", "always")
        self.assertIn("of 256 spp", result.err)
        self.assertNotIn("\r", self.good("reference", "cornell", *SIZE, "--spp", 64, "--out", "a.exr").err)

    def test_a_damaged_cache_is_named_and_made_anew(self):
        self.reference("--spp", 64, "--out", "a.exr")
        path = self.kept()[0]
        data = bytearray(path.read_bytes())
        data[len(data) // 2] ^= 1
        path.write_bytes(data)
        result = self.good("reference", "cornell", *SIZE, "--spp", 64, "--out", "b.exr", "--json")
        self.assertTrue(any(str(path) in warning and "damaged" in warning for warning in result.json["warnings"]))
        self.assertFalse(result.json["references"][0]["cached"])
        self.assertEqual(self.bytes("a.exr"), self.bytes("b.exr"))

    def test_a_changed_scene_is_another_reference(self):
        scene = '{"version": 1, "assets": {"ball": {"sphere": {"radius": %s}}}, "instances": [{"asset": "ball"}],' \
                ' "environment": {"constant": [1, 1, 1]}}'
        (self.folder / "s.json").write_text(scene % 1)
        self.good("reference", "s.json", *TINY, "--spp", 16, "--quiet", "--out", "a.exr")
        (self.folder / "s.json").write_text(scene % 0.5)
        changed = self.good("reference", "s.json", *TINY, "--spp", 16, "--out", "b.exr", "--json").json["references"][0]
        self.assertFalse(changed["cached"])
        self.assertNotEqual(self.bytes("a.exr"), self.bytes("b.exr"))

    def test_processes_at_once(self):
        command = [PROGRAM, "reference", "cornell", *SIZE, "--spp", "400", "--quiet", "--out"]
        processes = [subprocess.Popen([*command, f"{i}.exr"], cwd=self.folder) for i in range(3)]
        self.assertEqual([process.wait(timeout=120) for process in processes], [0, 0, 0])
        self.assertEqual(len({self.bytes(f"{i}.exr") for i in range(3)}), 1)
        self.assertEqual([path.name for path in self.kept()], ["400.lumiref"])

    def kill_and_resume(self, times, spp, size, longest):
        """Killed again and again at random moments, it comes to the bytes of one that was left alone."""
        command = [PROGRAM, "reference", "cornell", "--size", size, "--spp", str(spp), "--quiet", "--out"]
        seconds = random.Random(4)
        killed = 0
        while killed < times:
            process = subprocess.Popen([*command, "killed.exr"], cwd=self.folder)
            try:
                process.wait(timeout=seconds.uniform(0.02, longest))
                self.assertEqual(process.returncode, 0)
                shutil.rmtree(self.cache)  # it came to its end: from the start again
                (self.folder / "killed.exr").unlink()
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
                process.wait()
                killed += 1
        self.assertEqual(subprocess.run([*command, "killed.exr"], cwd=self.folder).returncode, 0)
        resumed = sorted(path.name for path in self.kept())
        self.assertEqual(resumed, [f"{spp}.lumiref"])
        self.assertEqual([path for path in self.cache.rglob("*.tmp")], [])
        sums = self.kept()[0].read_bytes()
        shutil.rmtree(self.cache)
        self.assertEqual(subprocess.run([*command, "whole.exr"], cwd=self.folder).returncode, 0)
        self.assertEqual(self.bytes("killed.exr"), self.bytes("whole.exr"))
        self.assertEqual(self.kept()[0].read_bytes(), sums)

    def test_kill_at_random_moments(self):
        times = int(os.environ.get("LUMISCOPE_KILLS", "3"))
        self.kill_and_resume(times, 3000 if times > 3 else 400, "120x90" if times > 3 else "60x45", 6 if times > 3 else 0.8)

    @unittest.skipUnless(MPI_PROGRAM.exists() and shutil.which("mpirun"), "no MPI here")
    def test_mpi(self):
        self.good("reference", "cornell", *SIZE, "--spp", 180, "--quiet", "--out", "alone.exr")
        self.good("reference", "cornell", *SIZE, "--samples", "48..144", "--quiet", "--out", "alone.lumiref")
        for ranks in (1, 2, 3):
            shutil.rmtree(self.cache)
            self.mpi(ranks, "--spp", "180", "--out", "mpi.exr")
            self.assertEqual(self.bytes("mpi.exr"), self.bytes("alone.exr"), f"{ranks} processes")
        self.mpi(2, "--samples", "48..144", "--out", "mpi.lumiref")
        self.assertEqual(self.bytes("mpi.lumiref"), self.bytes("alone.lumiref"))

    @unittest.skipUnless(MPI_PROGRAM.exists(), "no MPI here")
    def test_mpi_on_a_full_disk_under_standard_output(self):
        with open("/dev/full", "w") as full:
            process = subprocess.run([MPI_PROGRAM, "--help"], cwd=self.folder, stdout=full, stderr=subprocess.PIPE, timeout=100)
        self.assertEqual(process.returncode, 5, process.stderr.decode())
        self.assertIn(b"standard output could not be written", process.stderr)

    def mpi(self, ranks, *arguments):
        command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks), str(MPI_PROGRAM), "reference",
                   "cornell", *SIZE, "--quiet", *arguments]
        result = subprocess.run(command, cwd=self.folder, capture_output=True, timeout=300)
        self.assertEqual(result.returncode, 0, result.stderr.decode())


if __name__ == "__main__":
    main()
