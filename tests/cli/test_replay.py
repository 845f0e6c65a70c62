"""--replay: the state inside a file makes the same file again, byte for byte."""
import json
import shutil

from lumiscope import CommandTest, SOURCE, exr_header, main, png_text

SMALL = ["--size", "40x30", "--quiet"]


class Replay(CommandTest):
    def replayed(self, source, *names):
        for name in names:
            self.good("render", "--replay", source, "--quiet", "--out", "again-" + name)
            self.assertEqual(self.bytes(name), self.bytes("again-" + name), f"{source} -> {name}")

    def test_png_and_exr_from_each_other(self):
        self.good("render", "cornell", *SMALL, "--spp", 4, "--buffers", "all", "--half", "--exposure", "1", "--set",
                  "path.max-depth=3", "--set", "material.white.base-color=0.2,0.5,0.7", "--set", "light.lamp.power=0.5",
                  "--out", "a.png", "--out", "a.exr")
        self.replayed("a.png", "a.png", "a.exr")
        self.replayed("a.exr", "a.png", "a.exr")

    def test_frames_of_a_sequence(self):
        for module in ("accumulate", "none"):
            self.good("render", "cornell", *SMALL, "--frames", "1..5", "--warm-up", 1, "--module", module, "--set",
                      "accumulate.reset=cut-only", "--buffers", "motion,normal", "--out", module + "%04d.exr")
            for frame in range(1, 5):
                self.replayed(f"{module}{frame:04}.exr", f"{module}{frame:04}.exr")

    def test_a_moving_camera(self):
        scene = json.loads((SOURCE / "scenes/cornell.json").read_text())
        name = next(iter(scene["cameras"]))
        camera = scene["cameras"][name]
        eye = camera["eye"]
        camera["keys"] = [{"time": 0, "eye": eye}, {"time": 0.2, "eye": [eye[0] + 0.4, eye[1], eye[2]]}]
        (self.folder / "moving.json").write_text(json.dumps(scene))
        self.good("render", "moving.json", *SMALL, "--frames", 6, "--buffers", "motion", "--out", "m%04d.exr", "--out",
                  "m%04d.png")
        self.assertNotEqual(self.bytes("m0001.png"), self.bytes("m0005.png"))
        for frame in (0, 1, 5):
            self.replayed(f"m{frame:04}.exr", f"m{frame:04}.exr", f"m{frame:04}.png")
        state = json.loads(png_text(self.bytes("m0005.png"), "lumiscope"))
        self.assertEqual((state["start"]["frame"], state["frame"]), (4, 5), "history was dropped by the move")

    def test_a_module_that_changed_on_the_way(self):
        """As the window records it when another method is chosen between two frames."""
        self.good("render", "cornell", *SMALL, "--frames", 2, "--set", "accumulate.reset=cut-only", "--buffers",
                  "sampleCount", "--out", "a.exr", "--out", "a.png")
        state = json.loads(png_text(self.bytes("a.png"), "lumiscope"))
        state["start"]["set"]["view.0.module"] = "none"
        state["frames"] = [{"frame": 1, "set": {"view.0.module": "accumulate"}}]
        (self.folder / "changed.json").write_text(json.dumps(state))
        self.good("render", "--replay", "changed.json", "--quiet", "--out", "b.exr")
        self.assertIn("accumulate-sampleCount.Y", exr_header(self.bytes("b.exr"))["channels"])
        self.good("render", "--replay", "changed.json", "--quiet")
        self.assertIn("cornell.accumulate.exr", self.files())
        state["frames"] = []
        (self.folder / "other.json").write_text(json.dumps(state))
        self.refused(3, ["sampleCount", "other.json"], "render", "--replay", "other.json", "--out", "c.exr")

    def test_the_state_is_the_same_in_both_and_says_nothing_of_the_machine(self):
        self.good("render", "cornell", *SMALL, "--threads", 1, "--out", "a.png", "--out", "a.exr")
        text = png_text(self.bytes("a.png"), "lumiscope")
        self.assertEqual(exr_header(self.bytes("a.exr"))["lumiscope"].decode(), text)
        state = json.loads(text)
        self.assertEqual(state["scene"]["name"], "cornell")
        self.assertIn(state["isa"], ("baseline", "v3", "v4"))
        for word in ("thread", str(self.folder), "a.png"):
            self.assertNotIn(word, text)

    def test_a_state_alone_replays_too(self):
        self.good("render", "cornell", *SMALL, "--out", "a.png")
        (self.folder / "state.json").write_text(png_text(self.bytes("a.png"), "lumiscope"))
        self.replayed("state.json", "a.png")

    def test_a_scene_that_changed_is_refused(self):
        shutil.copy(SOURCE / "scenes/cornell.json", self.folder / "mine.json")
        self.good("render", "mine.json", *SMALL, "--out", "a.png")
        self.replayed("a.png", "a.png")
        text = (self.folder / "mine.json").read_text()
        (self.folder / "mine.json").write_text(text.rstrip() + "\n\n")
        self.refused(3, ["mine.json", "changed"], "render", "--replay", "a.png", "--out", "b.png")
        (self.folder / "elsewhere").mkdir()
        (self.folder / "elsewhere/moved.json").write_text(text)
        self.good("render", "elsewhere/moved.json", "--replay", "a.png", "--quiet", "--out", "b.png")
        self.assertEqual(self.bytes("a.png"), self.bytes("b.png"))

    def test_what_holds_no_state(self):
        (self.folder / "plain.png").write_bytes((SOURCE / "scenes/cornell.json").read_bytes())
        self.refused(3, ["plain.png"], "render", "--replay", "plain.png")
        self.refused(3, ["none.exr", "no such file"], "render", "--replay", "none.exr")
        (self.folder / "list.json").write_text("[]")
        self.refused(3, ["list.json", "no state"], "render", "--replay", "list.json")
        self.good("render", "cornell", *SMALL, "--out", "a.png")
        state = json.loads(png_text(self.bytes("a.png"), "lumiscope"))
        state["start"]["set"]["nothing.of-it"] = 1
        (self.folder / "odd.json").write_text(json.dumps(state))
        self.refused(3, ["odd.json", "nothing.of-it"], "render", "--replay", "odd.json")


if __name__ == "__main__":
    main()
