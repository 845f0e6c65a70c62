"""list and info: tables for people, JSON for tools."""
import json

from lumiscope import SOURCE, CommandTest, main

SCENES = ["cornell", "room", "atrium", "still-life", "parade"]
SIGNALS = """noisy emission albedo specularAlbedo directDiffuse indirectDiffuse directSpecular indirectSpecular direct
indirect visibility sampleVariance normal geometricNormal objectNormal depth inverseDepth depthGradient position motion
roughness objectId materialId surface""".split()


class List(CommandTest):
    def test_scenes(self):
        scenes = self.good("list", "scenes", "--json").json
        self.assertEqual([scene["id"] for scene in scenes][:len(SCENES)], SCENES)
        table = self.good("list", "scenes").out
        for scene in scenes:
            self.assertTrue(scene["title"])
            self.assertIn(scene["title"], table)

    def test_modules(self):
        modules = {m["id"]: m for m in self.good("list", "modules", "--json").json}
        self.assertLessEqual({"none", "accumulate"}, set(modules))
        self.assertTrue(all(set(m) >= {"id", "title", "paper"} for m in modules.values()))
        self.assertIn("Progressive mean", self.good("list", "modules").out)

    def test_buffers(self):
        buffers = self.good("list", "buffers", "--json").json
        ids = [b["id"] for b in buffers]
        self.assertEqual(ids[:len(SIGNALS)], SIGNALS)
        self.assertIn("accumulate-standardError", ids)
        taps = self.good("list", "buffers", "--module", "accumulate", "--json").json
        self.assertEqual([b["id"] for b in taps], ["accumulate-sampleCount", "accumulate-standardError"])
        self.assertTrue(all(b["module"] == "accumulate" for b in taps))

    def test_metrics(self):
        metrics = self.good("list", "metrics", "--json").json
        self.assertEqual([m["id"] for m in metrics], ["rmse", "relmse", "mse", "mae", "psnr", "smape", "ssim", "ms_ssim",
                                                      "flip", "hdr_flip", "cpbd", "temporal", "temporal_reprojected", "lag"])
        table = self.good("list", "metrics").out
        for metric in metrics:
            self.assertTrue(metric["title"] and metric["definition"], metric["id"])
            self.assertIn(metric["definition"], table)
            self.assertIn(metric["range"], table)
            self.assertIn(metric["source"], table)
            if metric["source"][-1].isdigit():
                self.assertIn(f"| {metric['source']} |", (SOURCE / "README.md").read_text(), "its source is in the bibliography")
        self.assertEqual({m["id"] for m in metrics if m["higher_is_better"]}, {"psnr", "ssim", "ms_ssim", "cpbd"})
        self.assertEqual({m["id"] for m in metrics if not m["symmetric"]}, {"relmse", "hdr_flip", "cpbd", "temporal", "temporal_reprojected", "lag"})
        self.assertEqual({m["id"] for m in metrics if m["of"] == "frames"}, {"temporal", "temporal_reprojected", "lag"})

    def test_parameters(self):
        parameters = {p["id"]: p for p in self.good("list", "parameters", "--json").json}
        for name in ("render.width", "render.spp", "path.max-depth", "sampler.kind", "camera.eye", "camera.jitter", "time",
                     "environment.rotate-deg", "material.<name>.roughness", "light.<name>.power", "light.<name>.radius",
                     "view.0.exposure", "view.layout", "accumulate.max-samples", "none.component"):
            self.assertIn(name, parameters)
        depth = parameters["path.max-depth"]
        self.assertEqual((depth["type"], depth["min"], depth["default"]), ("integer", 1, 6))
        self.assertEqual(parameters["sampler.kind"]["options"], ["sobol", "halton", "independent", "blue-noise"])
        for parameter in parameters.values():
            self.assertTrue(parameter["help"], parameter["id"])
            self.assertRegex(parameter["id"], r"^[a-z0-9@.<>-]+$")
        only = self.good("list", "parameters", "--module", "accumulate@b", "--json").json
        self.assertTrue(only and all(p["id"].startswith("accumulate@b.") for p in only))
        self.assertIn("accumulate.limit", self.good("list", "parameters", "--module", "accumulate").out)

    def test_every_listed_value_is_accepted(self):
        for parameter in self.good("list", "parameters", "--module", "accumulate", "--json").json:
            value = str(parameter["default"]).lower()
            self.good("render", "cornell", "--size", "4x4", "--quiet", "--out", "a.exr", "--set", f"{parameter['id']}={value}")


class Info(CommandTest):
    def test_json(self):
        info = self.good("info", "cornell", "--json").json
        self.assertEqual(info["title"], "Cornell box")
        self.assertGreater(info["triangles"], 10)
        self.assertGreater(info["instances"], 1)
        self.assertIn("white", [m["id"] for m in info["materials"]])
        self.assertEqual([light["id"] for light in info["lights"]], ["lamp"])
        self.assertEqual(info["cameras"][0]["id"], "main")
        self.assertEqual(len(info["bounds"]["min"]), 3)
        self.assertGreater(info["memory_bytes"], 0)
        memory = info["memory"]
        self.assertEqual(memory["geometry_bytes"] + memory["texture_bytes"], info["memory_bytes"])
        self.assertGreater(memory["acceleration_bytes"], 0)
        self.assertAlmostEqual(memory["peak_to_sum"], info["peak_memory_bytes"] / memory["sum_bytes"], places=3)
        self.assertEqual(info["warnings"], [])
        self.assertFalse(info["animated"])
        self.assertTrue(all(key == key.lower() for key in info))

    def test_text(self):
        text = self.good("info", "cornell").out
        for part in ("Cornell box", "triangles", "lamp", "main", "bounds", "memory"):
            self.assertIn(part, text)

    def test_scenes_and_variants_of_a_gltf(self):
        material = lambda name: {"name": name}
        gltf = {"asset": {"version": "2.0"}, "scene": 1, "scenes": [{"name": "Day"}, {"nodes": [0]}], "nodes": [{}],
                "materials": [material("a")],
                "animations": [{"name": "walk", "channels": [], "samplers": []}, {"channels": [], "samplers": []}],
                "extensions": {"KHR_materials_variants": {"variants": [{"name": "red"}, {"name": "green"}]}}}
        (self.folder / "two.gltf").write_text(json.dumps(gltf))
        info = self.good("info", "two.gltf", "--json").json
        self.assertEqual(info["scenes"], [{"index": 0, "title": "Day", "shown": False}, {"index": 1, "title": "", "shown": True}])
        self.assertEqual(info["variants"], [{"title": "red", "shown": False}, {"title": "green", "shown": False}])
        text = self.good("info", "two.gltf", "--set", "scene.index=0", "--set", "scene.variant=green").out
        self.assertIn('scenes      2: 0 "Day" (shown), 1; --set scene.index=N shows another', text)
        self.assertIn('variants    2: "red", "green" (shown); --set scene.variant=NAME shows one', text)
        self.assertIn('animations  2: 0 "walk", 1; --set scene.animation=NAME or number plays one alone', text)
        self.refused(2, ["no such animation", "walk, 1", "run"], "info", "two.gltf", "--set", "scene.animation=run")
        info = self.good("info", "cornell", "--json").json
        self.assertEqual((info["scenes"], info["variants"], info["animations"]), ([], [], []))
        self.assertNotIn("variants", self.good("info", "cornell").out)

    def test_bodies_of_lights_are_no_materials(self):
        self.assertEqual([m["id"] for m in self.good("info", "cornell", "--json").json["materials"] if "body" in m["id"]], [])
        self.refused(2, ["unknown parameter", "material.light-body.roughness"], "info", "cornell", "--quiet", "--set",
                     "material.light-body.roughness=0.5")
        # One that is worn is a material like any other.
        (self.folder / "own.json").write_text(json.dumps({
            "version": 1, "assets": {"ball": {"sphere": {}}}, "materials": {"light body": {}},
            "instances": [{"name": "it", "asset": "ball", "material": "light body"}],
            "lights": {"lamp": {"sphere": {"radius": 0.1}, "radiance": [5, 5, 5], "translate": [0, 2, 0]}}}))
        self.good("info", "own.json", "--set", "material.light-body.roughness=0.5")

    def test_every_built_in_scene_loads_without_a_warning(self):
        for scene in self.good("list", "scenes", "--json").json:
            if "missing" in scene:
                print("left out:", scene["id"], scene["missing"])
                continue
            info = self.good("info", scene["id"], "--json").json
            self.assertEqual(info["warnings"], [], scene["id"])
            self.assertGreater(info["triangles"], 0)

    def test_a_scene_without_its_assets_says_what_is_missing(self):
        nowhere = {"LUMISCOPE_ASSETS": "/nowhere"}
        scenes = {s["id"]: s for s in self.good("list", "scenes", "--json", **nowhere).json}
        self.assertEqual([name for name, scene in scenes.items() if "missing" in scene], ["sponza"])
        self.assertIn("/nowhere/gltf/Sponza/Sponza.gltf: no such asset", scenes["sponza"]["missing"])
        self.assertIn("no such asset", self.good("list", "scenes", **nowhere).out)
        self.assertIn("needs $LUMISCOPE_ASSETS", self.good("--help", **nowhere).out)
        self.refused(3, ["sponza.json:4:", "/nowhere/gltf/Sponza/Sponza.gltf", "$LUMISCOPE_ASSETS to name a folder"],
                     "info", "sponza", "--quiet", **nowhere)

    def test_the_signals_hold_what_they_promise(self):
        for scene in ("cornell", "atrium", "parade", "still-life"):
            info = self.good("info", scene, "--check", "--json", "--set", "render.width=160", "--set",
                             "render.height=90").json
            checks = info["checks"]
            self.assertEqual({check["frame"] for check in checks}, {0, 1})
            self.assertEqual(len({check["rule"] for check in checks if check["frame"] == 0}), 16)
            for check in checks:
                self.assertTrue(check["holds"] and check["violations"] == 0, (scene, check))
            for rule in ("normals", "motion", "radiance", "depth"):
                self.assertTrue(any(rule in check["rule"] and check["checked"] > 1000 for check in checks), rule)
        self.assertNotIn("checks", self.good("info", "cornell", "--json").json)
        text = self.good("info", "cornell", "--check").out
        self.assertEqual(text.count("  good "), 32)
        self.assertNotIn("BROKEN", text)

    def test_the_signals_hold_with_an_up_direction_that_is_none(self):
        # Without length, along the view, and at the eye itself.
        for camera in ("up=0,0,0", "up=0,0,-1", "look-at=0,2.73,8"):
            info = self.good("info", "cornell", "--check", "--json", "--set", "render.width=64", "--set",
                             "render.height=36", "--set", "camera." + camera).json
            self.assertTrue(all(check["holds"] for check in info["checks"]), (camera, info["checks"]))

    def test_what_lies_out_of_reach_is_refused(self):
        faces = "\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
        (self.folder / "far.obj").write_text("v 0 0 1e19" + faces)
        self.refused(3, ["far.obj:1", "out of range", "-1e+09 to 1e+09", "1e19"], "info", "far.obj")
        (self.folder / "near.obj").write_text("v 0 0 9e8" + faces)
        self.good("info", "near.obj", "--check", "--set", "render.width=32", "--set", "render.height=18")

    def test_warnings_are_told(self):
        (self.folder / "dark.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        info = self.good("info", "dark.obj", "--json").json
        self.assertTrue(any("light" in warning or "sky" in warning for warning in info["warnings"]), info["warnings"])
        self.assertEqual(info["cameras"][0]["id"], "default")
        self.assertIn(info["warnings"][0], self.good("info", "dark.obj").out)


if __name__ == "__main__":
    main()
