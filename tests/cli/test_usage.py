"""Exit codes and messages: what is refused, how, and with which number."""
import os
import shutil
import subprocess

from lumiscope import CommandTest, PROGRAM, SOURCE, TINY, main


class Usage(CommandTest):
    def test_help_says_what_there_is(self):
        text = self.good("--help").out
        for part in ("render", "reference", "merge", "compare", "bench", "info", "list", "view", "cornell", "list metrics", "Exit codes", "lumiscope render"):
            self.assertIn(part, text)
        for command in ("render", "reference", "merge", "compare", "bench", "info", "list", "view"):
            text = self.good(command, "--help").out
            self.assertIn("lumiscope " + command, text)
            self.assertIn("Example", text)
        self.assertIn("accumulate", self.good("render", "--help").out)
        self.assertRegex(self.good("--version").out, r"^lumiscope \d+\.\d+\.\d+\n$")

    def test_unknown_things_name_the_nearest(self):
        self.refused(2, ["--sppp", "--spp"], "render", "cornell", "--sppp", "3")
        self.refused(2, ['"cornel"', '"cornell"'], "render", "cornel")
        self.refused(2, ['"acumulate"', '"accumulate"', "--module"], "render", "cornell", "--module", "acumulate")
        self.refused(2, ['"path.max-dept"', '"path.max-depth"', "--set"], "render", "cornell", "--set", "path.max-dept=2")
        self.refused(2, ['"albdo"', '"albedo"', "--buffers"], "render", "cornell", "--buffers", "albdo")
        self.refused(2, ["main", "corner", "--camera"], "render", "cornell", "--camera", "nowhere")
        self.refused(2, ["scenes", "parameters", "metrics"], "list", "things")
        self.refused(2, ["v3", "--isa"], "render", "cornell", "--isa", "v9")
        for parts, arguments in ((['expected one of scenes, modules', 'found "things"'], ["list", "things"]),
                                 (['--size', 'WIDTHxHEIGHT', 'found "0x7"'], ["render", "cornell", "--size", "0x7"]),
                                 (['--threads', 'expected 1 to 1024', 'found "0"'], ["render", "cornell", "--threads", "0"]),
                                 (['--progress', 'expected one of auto, always, never'], ["render", "cornell", "--progress", "x"]),
                                 (['--memory-limit', 'found "lots"'], ["render", "cornell", "--memory-limit", "lots"])):
            self.refused(2, parts, *arguments)
        self.assertEqual(self.files(), [])

    def test_bad_values_are_refused_before_anything_is_rendered(self):
        for arguments in (["--size", "12"], ["--size", "0x4"], ["--size", "axb"], ["--frames", "0"], ["--frames", "5..3"],
                          ["--frames", "3..3"], ["--frames", "x"], ["--spp", "0"], ["--spp", "many"], ["--fps", "0"],
                          ["--set", "path.max-depth"], ["--set", "=3"], ["--set", "path.max-depth=99"],
                          ["--threads", "0"], ["--memory-limit", "lots"], ["--out", "a.jpg"], ["--out", "noextension"],
                          ["--out", "a%s.png"], ["--out", "a%04d.mp4"], ["--progress", "sometimes"],
                          ["--module", "none", "--module", "accumulate"], ["--warm-up", "1"],
                          ["--frames", "3..5", "--warm-up", "4"], ["--set", "time=2", "--frames", "2"],
                          ["--set", "scene.index=abc"]):
            self.refused(2, [], "render", "cornell", *arguments)
        self.refused(2, ["SCENE"], "render")
        self.refused(2, ["--replay"], "render", "--replay", "a.png", "--spp", "3")
        self.refused(2, ["--offscreen"], "view", "cornell", "--out", "x")
        self.refused(2, ["--out"], "view", "cornell", "--offscreen")
        self.assertEqual(self.files(), [])

    def test_a_value_for_a_method_that_does_not_run_is_told(self):
        command = ["render", "cornell", *TINY, "--out", "a.png", "--module", "svgf"]
        warned = self.good(*command, "--set", "svgf@b.levels=2").err
        self.assertRegex(warned, r"warning: --set svgf@b\.levels=2: no effect, svgf@b does not run; svgf does")
        self.assertNotIn("warning", self.good(*command, "--set", "svgf.levels=2").err)

    def test_the_window_refuses_what_render_refuses(self):
        out = ["--offscreen", "--out", "x", *TINY]
        three = ["--module", "none", "--module", "accumulate", "--module", "none"]
        for arguments in (["--module", "bogus"], ["--set", "scene.index=abc"], three, ["--module", "none", *three]):
            self.refused(2, [], "cornell", *arguments)
            self.refused(2, [], "view", "cornell", *out, *arguments)
        if self.run_program("view", "cornell", *out, "--samples", 1).code == 4:
            self.skipTest("no OpenGL")
        for part, arguments in (("bogus.id", ["--set", "bogus.id=1"]), ("path.max-depth", ["--set", "path.max-depth=999"]),
                                ("--camera", ["--camera", "nowhere"]),
                                ("albdo", ["--set", "path.max-depth=3", "--set", "view.1.buffer=albdo"])):
            self.refused(2, [part], "view", "cornell", *out, *arguments)

    def test_without_a_display_the_window_says_so(self):
        for arguments in ([], ["cornell"]):
            self.refused(4, ["display"], *arguments)

    def test_bad_scenes(self):
        good = (SOURCE / "scenes/cornell.json").read_text()
        cases = {
            "truncated.json": (good[:len(good) // 2], ["truncated.json:"]),
            "unknown-key.json": (good.replace('"materials"', '"materals"'), ["unknown-key.json:", '"materials"']),
            "empty.json": ("", ["empty.json"]),
            "array.json": ("[1, 2]", ["array.json"]),
            "broken.gltf": ('{"asset": {"version": "2.0"}, "scenes": [{"nodes": [7]}]}', ["broken.gltf"]),
            "broken.glb": ("glTF\x02\x00\x00\x00\xff\xff", ["broken.glb"]),
            "broken.obj": ("v 0 0 0\nf 1 2 99\n", ["broken.obj"]),
            "garbage.obj": ("this is no obj\nfoo bar\n", ["garbage.obj", "no faces"]),
            "empty.obj": ("", ["empty.obj", "no faces"]),
            "cut.obj": ("v 0 0 0\nv 1 0 0\nv 0 1", ["cut.obj:3", "too few numbers"]),
        }
        for name, (text, parts) in cases.items():
            (self.folder / name).write_text(text)
            for command in ("render", "info"):
                self.refused(3, parts, command, name)
        self.refused(3, ["missing.gltf", "no such file"], "render", "missing.gltf")
        (self.folder / "folder.json").mkdir()
        self.refused(3, ["folder.json"], "info", "folder.json")

    def test_the_memory_limit(self):
        line = self.refused(5, ["memory limit", "MiB"], "render", "cornell", "--memory-limit", "20M", "--size", "4096x4096")
        self.assertIn("4096x4096", line)
        self.assertEqual(self.files(), [])

    def test_a_folder_that_cannot_be_written(self):
        (self.folder / "file").write_text("")
        # Found out before the first of so many samples.
        for command in ("render", "reference"):
            self.refused(2, ["file/a.png", "folder cannot be created", "Not a directory"], command, "cornell", "--spp", 65536, "--quiet",
                         "--out", "file/a.png", timeout=60, XDG_CACHE_HOME=self.folder / "cache")
        self.refused(2, ["too long"], "render", "cornell", "--spp", 65536, "--quiet", "--out", 252 * "n" + ".png", timeout=60)

    def test_a_name_as_long_as_they_get(self):
        name = 251 * "n" + ".png"
        self.good("render", "cornell", *TINY, "--quiet", "--out", name)
        self.assertEqual(self.files(), [name])

    def test_a_full_disk_under_standard_output(self):
        for arguments in (["list", "modules", "--json"], ["--help"], ["render", "cornell", *TINY, "--quiet", "--json", "--out", "a.png"]):
            with open("/dev/full", "w") as full:
                process = subprocess.run([PROGRAM, *arguments], cwd=self.folder, stdout=full, stderr=subprocess.PIPE, timeout=100)
            self.assertEqual(process.returncode, 5, arguments)
            self.assertIn(b"standard output could not be written", process.stderr)

    def test_names_that_are_no_utf_8(self):
        scene = os.fsdecode(b"bad\xff.json")
        shutil.copy(SOURCE / "scenes/cornell.json", self.folder / scene)
        told = self.good("render", scene, *TINY, "--quiet", "--json", "--out", os.fsdecode(b"o\xff.png")).json
        self.assertEqual(told["files"], ["o\ufffd.png"])
        self.good("info", scene, "--quiet", "--json").json
        # The scene cannot be found by the state's name, but given beside it.
        os.rename(self.folder / os.fsdecode(b"o\xff.png"), self.folder / "o.png")
        self.good("render", scene, "--replay", "o.png", "--quiet", "--out", "again.png")
        self.assertEqual(self.bytes("again.png")[:8], self.bytes("o.png")[:8])


if __name__ == "__main__":
    main()
