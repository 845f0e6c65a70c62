"""compare: numbers of known images, maps, parts of images, and what is refused."""
from lumiscope import SOURCE, CommandTest, exr_header, main, read_png, write_exr, write_png

WIDTH, HEIGHT = 48, 40
METRICS = ["rmse", "relmse", "mse", "mae", "psnr", "smape", "ssim", "ms_ssim", "flip", "hdr_flip", "cpbd"]


def pattern(x, y):
    return (x * 37 + y * 91) % 256, (x * y * 13) % 256, (x * 5 + 3) % 256


def half(x, y):
    """White on the left, black on the right."""
    return (255, 255, 255) if x < WIDTH // 2 else (0, 0, 0)


class Compare(CommandTest):
    def setUp(self):
        super().setUp()
        for name, colour in (("pattern", pattern), ("half", half), ("white", lambda x, y: (255, 255, 255)),
                             ("black", lambda x, y: (0, 0, 0))):
            write_png(self.folder / f"{name}.png", WIDTH, HEIGHT, colour)

    def metrics(self, *arguments):
        return self.good("compare", *arguments, "--json").json["metrics"]

    def check(self, expected, *arguments):
        values = self.metrics(*arguments, "--metrics", ",".join(expected))
        self.assertEqual(set(values), set(expected))
        for name, value in expected.items():
            self.assertAlmostEqual(values[name], value, places=6, msg=name)

    def test_an_image_is_itself(self):
        report = self.good("compare", "pattern.png", "pattern.png", "--json").json
        self.assertLessEqual({"width", "height", "nonfinite_pixels", "metrics"}, set(report))
        self.assertEqual((report["width"], report["height"], report["nonfinite_pixels"]), (WIDTH, HEIGHT, 0))
        values = report["metrics"]
        self.assertEqual(set(values), set(METRICS))
        for name in ("rmse", "relmse", "mse", "mae", "smape", "flip", "hdr_flip"):
            self.assertEqual(values[name], 0, name)
        self.assertIsNone(values["psnr"], "infinite")
        self.assertAlmostEqual(values["ssim"], 1, places=6)
        self.assertAlmostEqual(values["ms_ssim"], 1, places=6)
        self.assertEqual(report["details"]["ms_ssim"], {"scales": 2})

    def test_white_and_black(self):
        for pair in (("white.png", "black.png"), ("black.png", "white.png")):
            self.check({"rmse": 1, "mse": 1, "mae": 1}, *pair)
        self.check({"mse": 0.5, "rmse": 0.5 ** 0.5}, "half.png", "black.png")

    def test_the_parts_make_the_whole(self):
        whole = self.metrics("pattern.png", "half.png", "--metrics", "mse,mae")
        parts = []
        for x in (0, WIDTH // 2):
            for y in (0, HEIGHT // 2):
                crop = f"{x},{y},{WIDTH // 2},{HEIGHT // 2}"
                report = self.good("compare", "pattern.png", "half.png", "--metrics", "mse,mae", "--crop", crop,
                                   "--json").json
                self.assertEqual((report["width"], report["height"]), (WIDTH // 2, HEIGHT // 2))
                parts.append(report["metrics"])
        for name in whole:
            self.assertAlmostEqual(sum(part[name] for part in parts) / 4, whole[name], places=6)
        self.assertEqual(self.metrics("half.png", "black.png", "--metrics", "mse", "--crop", "0,0,24,40"), {"mse": 1})
        self.assertEqual(self.metrics("half.png", "black.png", "--metrics", "mse", "--crop", "24,0,24,40"), {"mse": 0})

    def test_a_mask(self):
        write_png(self.folder / "right.png", WIDTH, HEIGHT, lambda x, y: (255,) * 3 if x >= WIDTH // 2 else (0,) * 3)
        self.assertEqual(self.metrics("half.png", "black.png", "--metrics", "mse", "--mask", "half.png"), {"mse": 1})
        self.assertEqual(self.metrics("half.png", "black.png", "--metrics", "mse", "--mask", "right.png"), {"mse": 0})

    def test_maps(self):
        described = {m["id"]: m for m in self.good("list", "metrics", "--json").json}
        self.good("compare", "pattern.png", "half.png", "--maps", "deep/maps", "--quiet")
        names = sorted(path.name for path in (self.folder / "deep/maps").iterdir())
        self.assertEqual(names, sorted(f"{m}.{e}" for m in METRICS if described[m]["has_map"] for e in ("exr", "png")))
        self.assertIn("flip.png", names)
        self.assertEqual(set(exr_header(self.bytes("deep/maps/flip.exr"))["channels"]), {"Y"})
        self.good("compare", "pattern.png", "half.png", "--metrics", "mae", "--maps", "one")
        self.assertEqual(sorted(path.name for path in (self.folder / "one").iterdir()), ["mae.exr", "mae.png"])

    def colours(self, name):
        return {colour for row in read_png(self.bytes(name)) for colour in row}

    def test_maps_of_a_metric_have_one_range(self):
        dark, middle, bright = (0, 0, 4), (183, 55, 121), (252, 253, 191)  # magma at 0, 0.5 and 1

        def near(name, expected):
            for seen in self.colours(name):
                self.assertTrue(all(abs(a - b) <= 6 for a, b in zip(seen, expected)), f"{name}: {seen} {expected}")
        # Frame 0 is right, frame 1 wrong by 0.2, frame 2 by 0.4.
        self.frames("a.%d.exr", {0: 0.5, 1: 0.7, 2: 0.9})
        self.frames("r.%d.exr", {0: 0.5, 1: 0.5, 2: 0.5})
        ids = "mae,rmse,ssim,flip,temporal"
        report = self.good("compare", "a.%d.exr", "r.%d.exr", "--metrics", ids, "--maps", "maps", "--json").json
        self.assertEqual(list(report["maps"]), ids.split(","))
        self.assertEqual({m["low"] for m in report["maps"].values()}, {0})
        self.assertAlmostEqual(report["maps"]["mae"]["high"], 0.4, places=6)
        self.assertAlmostEqual(report["maps"]["rmse"]["high"], report["frames"][2]["metrics"]["rmse"], places=6)
        self.assertEqual([report["maps"][m]["high"] for m in ("ssim", "flip")], [1, 1])
        for frame, colour in enumerate((dark, middle, bright)):
            near(f"maps/mae.000{frame}.png", colour)
        near("maps/rmse.0002.png", bright)
        near("maps/flip.0000.png", dark)
        # FLIP is over all of [0, 1]: a small difference alone is not bright.
        write_png(self.folder / "nearly.png", WIDTH, HEIGHT, lambda x, y: (245,) * 3)
        alone = self.good("compare", "nearly.png", "white.png", "--metrics", "flip,mae", "--maps", "one", "--json").json
        self.assertLess(alone["metrics"]["flip"], 0.3)
        self.assertGreater(alone["metrics"]["flip"], 0.01)
        for colour in self.colours("one/flip.png"):
            self.assertLess(sum(colour), sum(middle))
        near("one/mae.png", bright)
        self.assertEqual(alone["maps"], {"flip": {"low": 0, "high": 1}, "mae": {"low": 0, "high": alone["maps"]["mae"]["high"]}})
        self.assertAlmostEqual(alone["maps"]["mae"]["high"], alone["metrics"]["mae"], places=5)
        equal = self.good("compare", "white.png", "white.png", "--metrics", "mae", "--maps", "same")
        near("same/mae.png", dark)
        self.assertIn("colours of the maps: mae 0 to 1", equal.out)
        table = self.good("compare", "a.%d.exr", "r.%d.exr", "--metrics", "mae,ssim", "--maps", "maps").out
        self.assertIn("colours of the maps: mae 0 to 0.4, ssim 0 to 1\n", table)

    def test_lists_may_have_blanks(self):
        report = self.good("compare", "half.png", "black.png", "--metrics", " rmse, mse ", "--crop", "0, 0, 24, 40", "--json").json
        self.assertEqual(report["metrics"], self.metrics("half.png", "black.png", "--metrics", "rmse,mse", "--crop", "0,0,24,40"))
        self.assertEqual(list(report["metrics"]), ["rmse", "mse"])
        self.refused(2, ["--metrics"], "compare", "half.png", "half.png", "--metrics", "rmse,,mse")

    def test_maps_go_into_a_folder(self):
        line = self.refused(2, ["--maps", "half.png", "a folder"], "compare", "half.png", "black.png", "--maps", "half.png")
        self.assertNotIn("filesystem", line)
        self.refused(2, ["--maps"], "compare", "half.png", "black.png", "--maps", "half.png/below")

    def test_exposure_is_what_ldr_metrics_see(self):
        def ssim(*more):
            return self.metrics("pattern.png", "half.png", "--metrics", "ssim", *more)["ssim"]
        self.assertEqual(ssim(), ssim("--exposure", "0"))
        self.assertNotEqual(ssim(), ssim("--exposure", "-2"))

    def test_the_table(self):
        result = self.good("compare", "pattern.png", "half.png", "--metrics", "mse,flip")
        table, facts = result.out.split("\n\n")
        self.assertEqual([line.split()[0] for line in table.splitlines() if not line.startswith(" ")], ["mse", "flip"])
        self.assertIn(f"{WIDTH}x{HEIGHT}, {WIDTH * HEIGHT} pixels count; not finite: 0 in the image, 0 in the reference; exposure 0 EV", facts)
        self.assertEqual(result.err, "")

    def test_nothing_that_counts_is_no_value(self):
        for mask in ("black.png", "half.png"):
            report = self.good("compare", "pattern.png", "half.png", "--mask", mask, "--json").json
            self.assertEqual(report["counted_pixels"], 0 if mask == "black.png" else WIDTH * HEIGHT // 2)
            for name in METRICS:
                if mask == "black.png":
                    self.assertIsNone(report["metrics"][name], name)
                    self.assertEqual(report["no_value"][name], "the mask leaves no pixel", name)
                else:
                    self.assertIsNotNone(report["metrics"][name], name)
        table = self.good("compare", "pattern.png", "half.png", "--mask", "black.png", "--metrics", "mse,ssim").out
        for name in ("mse", "ssim"):
            self.assertRegex(table, rf"(?m)^{name} +- +the mask leaves no pixel$")
        report = self.good("compare", "pattern.png", "half.png", "--crop", "0,0,8,40", "--metrics", "mse,ssim", "--json").json
        self.assertIsNotNone(report["metrics"]["mse"])
        self.assertIn("11x11", report["no_value"]["ssim"])

    def test_broken_pixels_are_told(self):
        nan, infinite = float("nan"), float("inf")
        write_exr(self.folder / "good.exr", 16, 12, lambda x, y: (0.5, 0.25 + 0.01 * x, 0.125))
        write_exr(self.folder / "bad.exr", 16, 12, lambda x, y: (nan if y == 3 and x < 2 else 0.75, 0.25 + 0.01 * x, 0.125))
        write_exr(self.folder / "worse.exr", 16, 12, lambda x, y: (0.5, infinite if x == 5 else 0.5, 0.125))
        result = self.good("compare", "bad.exr", "worse.exr", "--json")
        report = result.json
        self.assertEqual([report[k] for k in ("nonfinite_image", "nonfinite_reference", "nonfinite_pixels", "counted_pixels")],
                         [2, 12, 14, 16 * 12 - 14])
        self.assertIn("14 pixels are NaN or infinite", result.err)
        for name in METRICS:
            self.assertIsNotNone(report["metrics"][name], name)
        self.assertAlmostEqual(self.metrics("bad.exr", "good.exr", "--metrics", "mse")["mse"], 0.25 ** 2 / 3, places=7)
        table = self.good("compare", "bad.exr", "worse.exr", "--metrics", "mse").out
        self.assertIn("178 pixels count; not finite: 2 in the image, 12 in the reference", table)
        write_exr(self.folder / "none.exr", 16, 12, lambda x, y: (nan, 1, 1))
        report = self.good("compare", "none.exr", "good.exr", "--json").json
        for name in METRICS:
            self.assertIsNone(report["metrics"][name], name)
            self.assertEqual(report["no_value"][name], "no pixel of the image is finite", name)

    def test_settings_are_printed_with_the_number(self):
        def relmse(*more):
            report = self.good("compare", "pattern.png", "half.png", "--metrics", "relmse", *more, "--json").json
            return report["metrics"]["relmse"], report["details"]["relmse"]["epsilon"]
        self.assertEqual(relmse()[1], 0.001)
        wide, epsilon = relmse("--relmse-epsilon", "0.1")
        self.assertEqual(epsilon, 0.1)
        self.assertLess(wide, relmse()[0])
        table = self.good("compare", "pattern.png", "half.png", "--metrics", "relmse", "--relmse-epsilon", "0.1").out
        self.assertIn("epsilon = 0.1", table)
        for bad in ("0", "-1", "wide"):
            self.refused(2, ["--relmse-epsilon"], "compare", "half.png", "half.png", "--relmse-epsilon=" + bad)

    def test_the_exposure_of_the_files_state(self):
        for name, exposure in (("dark", -2), ("bright", 1)):
            self.good("render", "cornell", "--size", "32x24", "--exposure", exposure, "--out", name + ".exr", "--quiet")
        self.good("render", "cornell", "--size", "32x24", "--spp", 4, "--out", "plain.exr", "--quiet")

        def report(*arguments):
            return self.good("compare", *arguments, "--metrics", "ssim", "--json")
        dark = report("plain.exr", "dark.exr").json
        self.assertEqual((dark["exposure"], dark["exposure_from"]), (-2, "state of dark.exr"))
        self.assertEqual(dark["metrics"], report("plain.exr", "dark.exr", "--exposure=-2").json["metrics"])
        self.assertNotEqual(dark["metrics"], report("plain.exr", "dark.exr", "--exposure=0").json["metrics"])
        both = report("bright.exr", "dark.exr")
        self.assertIn("bright.exr was made at an exposure of 1 EV", both.err)
        self.assertEqual(both.json["exposure"], -2, "the reference's counts")
        self.assertEqual(report("half.png", "pattern.png").json["exposure_from"], "stored as shown")
        scene = (SOURCE / "scenes/cornell.json").read_text().replace('"exposure": 0.8', '"exposure": 1.5')
        self.assertIn('"exposure": 1.5', scene)
        (self.folder / "lit.json").write_text(scene)
        self.good("render", "lit.json", "--size", "32x24", "--out", "lit.exr", "--quiet")
        self.good("reference", "lit.json", "--size", "32x24", "--spp", 16, "--out", "ref.exr", "--quiet", XDG_CACHE_HOME=str(self.folder))
        lit = self.good("compare", "lit.exr", "ref.exr", "--metrics", "ssim", "--json")
        self.assertEqual((lit.json["exposure"], lit.json["exposure_from"], lit.err), (1.5, "state of ref.exr", ""))

    def test_a_picture_beside_a_linear_file_is_as_stored(self):
        for exposure in (-1.3, 2):
            self.good("render", "cornell", "--size", "64x48", "--spp", 4, "--exposure", exposure, "--set", "view.0.tone-curve=clamp",
                      "--out", "%d.exr", "--out", "%d.png", "--quiet")
            for pair in (("0.png", "0.exr"), ("0.exr", "0.png"), ("%d.png", "0.exr")):
                result = self.good("compare", *pair, "--metrics", "rmse,smape", "--json")
                report = result.json
                # Half a step of 8 bits, evenly distributed, is 1 / 255 / sqrt(12).
                self.assertLess(report["metrics"]["rmse"], 1.5 / 255 / 12 ** 0.5)
                self.assertLess(report["metrics"]["smape"], 0.1)
                self.assertAlmostEqual(report["exposure"], exposure, places=5)
                self.assertEqual(report["exposure_from"], "state of 0.exr; 0.png stored as shown")
                self.assertIn("0.png is a picture as shown", result.err)
            other = self.good("compare", "0.png", "0.exr", "--metrics", "rmse", "--exposure", 0, "--json").json
            self.assertGreater(other["metrics"]["rmse"], 0.05)
            self.assertEqual(other["exposure_from"], "--exposure for 0.exr; 0.png stored as shown")
            for name in ("0.png", "0.exr"):
                (self.folder / name).unlink()
        write_exr(self.folder / "plain.exr", WIDTH, HEIGHT, lambda x, y: (1, 1, 1))
        report = self.good("compare", "white.png", "plain.exr", "--metrics", "mse", "--json").json
        self.assertEqual((report["metrics"]["mse"], report["exposure_from"]), (0, "no state in plain.exr; white.png stored as shown"))

    def test_two_renderings(self):
        for name, spp in (("noisy.exr", 1), ("better.exr", 16), ("best.exr", 256)):
            self.good("render", "cornell", "--size", "32x32", "--spp", spp, "--quiet", "--out", name)
        noisy = self.metrics("noisy.exr", "best.exr", "--metrics", "rmse")["rmse"]
        better = self.metrics("better.exr", "best.exr", "--metrics", "rmse")["rmse"]
        self.assertGreater(noisy, 2 * better)

    def test_fixed_flip_exposures(self):
        details = self.good("compare", "pattern.png", "half.png", "--metrics", "hdr_flip", "--flip-exposures", "-3,3,5",
                            "--json").json["details"]["hdr_flip"]
        self.assertEqual(details, {"start_exposure": -3, "stop_exposure": 3, "exposures": 5})
        whole = self.good("compare", "pattern.png", "half.png", "--metrics", "hdr_flip", "--json").json["details"]
        part = self.good("compare", "pattern.png", "half.png", "--metrics", "hdr_flip", "--crop", "30,0,10,10", "--json").json
        self.assertEqual(part["details"], whole, "they belong to the reference, not to a part of it")

    def test_frames(self):
        for frame in range(6):
            level = 40 if frame < 2 else 200
            seen = (40, 40, 100, 150, 190, 200)[frame]
            write_png(self.folder / f"out.{frame:04}.png", WIDTH, HEIGHT, lambda x, y: (seen,) * 3)
            write_png(self.folder / f"ref.{frame:04}.png", WIDTH, HEIGHT, lambda x, y: (level,) * 3)
        report = self.good("compare", "out.%04d.png", "ref.%04d.png", "--metrics", "mae,rmse,temporal,lag", "--maps", "maps",
                           "--json").json
        frames = report["frames"]
        self.assertEqual([frame["frame"] for frame in frames], list(range(6)))
        self.assertAlmostEqual(frames[3]["metrics"]["rmse"], 50 / 255, places=6)
        self.assertNotIn("temporal", frames[0]["metrics"])
        self.assertAlmostEqual(frames[2]["metrics"]["temporal"], 60 / 255, places=5)
        self.assertAlmostEqual(frames[2]["details"]["temporal"]["reference"], 160 / 255, places=5)
        self.assertAlmostEqual(report["metrics"]["rmse"], sum(f["metrics"]["rmse"] for f in frames) / 6, places=9)
        self.assertAlmostEqual(report["metrics"]["temporal"], (60 + 50 + 40 + 10) / 5 / 255, places=5)
        linear = [(v / 255 + 0.055) ** 2.4 / 1.055 ** 2.4 for v in (40, 100, 150, 190, 200)]
        curve = [(v - linear[0]) / (linear[4] - linear[0]) for v in linear[1:]]
        self.assertEqual(report["details"]["lag"]["step_frame"], 2)
        for seen, expected in zip(report["details"]["lag"]["curve"], curve):
            self.assertAlmostEqual(seen, expected, places=4)
        self.assertEqual(report["metrics"]["lag"], 3, curve)
        names = {path.name for path in (self.folder / "maps").iterdir()}
        self.assertLessEqual({"mae.0005.exr", "rmse.0000.png", "temporal.0001.exr", "lag.png"}, names)
        some = self.good("compare", "out.%04d.png", "white.png", "--metrics", "mae", "--frames", "1..3", "--json").json
        self.assertEqual([frame["frame"] for frame in some["frames"]], [1, 2])
        table = self.good("compare", "out.%04d.png", "ref.%04d.png", "--metrics", "rmse,lag").out
        self.assertIn("lag: 3 frames after the step at frame 2", table)
        self.refused(3, ["out.0006.png"], "compare", "out.%04d.png", "ref.%04d.png", "--frames", "8", "--metrics", "mae")
        self.refused(3, ["none.%d.png"], "compare", "none.%d.png", "ref.%04d.png")
        self.refused(2, ["--frames"], "compare", "half.png", "half.png", "--frames", "3")
        self.refused(2, ["lag", "frames"], "compare", "half.png", "half.png", "--metrics", "mse,lag")

    def frames(self, pattern, levels, size=(16, 12), broken=()):
        for frame, level in levels.items():
            write_exr(self.folder / (pattern % frame), *size,
                      lambda x, y: (float("nan") if (frame, x, y) in broken else level, level, level))

    def test_every_metric_for_each_frame(self):
        for frame in range(2):
            write_png(self.folder / f"e{frame}.png", 180, 180, lambda x, y: pattern(x + frame, y))
            write_png(self.folder / f"f{frame}.png", 180, 180, lambda x, y: pattern(x, y + 2 * frame))
        write_png(self.folder / "mask.png", 180, 180, lambda x, y: (255,) * 3 if x > y else (0,) * 3)
        report = self.good("compare", "e%d.png", "f%d.png", "--mask", "mask.png", "--maps", "maps", "--json").json
        for frame in range(2):
            alone = self.good("compare", f"e{frame}.png", f"f{frame}.png", "--mask", "mask.png", "--maps", f"maps{frame}", "--json").json
            for name in METRICS:
                self.assertEqual(report["frames"][frame]["metrics"][name], alone["metrics"][name], name)
                self.assertEqual(self.bytes(f"maps/{name}.000{frame}.exr"), self.bytes(f"maps{frame}/{name}.exr"), name)
        self.assertLessEqual(set(METRICS) | {"temporal", "temporal_reprojected", "lag"}, set(report["metrics"]))

    def test_frames_that_are_missing_or_broken(self):
        self.frames("a.%d.exr", {0: 0.1, 1: 0.1, 2: 0.4, 4: 0.45, 5: 0.5}, broken={(1, 3, 3), (1, 4, 3)})
        self.frames("r.%d.exr", {0: 0.1, 1: 0.1, 2: 0.5, 3: 0.5, 4: 0.5, 5: 0.5, 6: 0.5}, broken={(2, 0, 0)})
        result = self.good("compare", "a.%d.exr", "r.%d.exr", "--metrics", "mae,psnr,temporal,lag", "--json")
        report = result.json
        self.assertEqual([frame["frame"] for frame in report["frames"]], [0, 1, 2, 4, 5])
        self.assertEqual((report["missing_frames"], report["references_without_image"]), ([3], [3, 6]))
        self.assertIn("no image of frame 3", result.err)
        self.assertIn("left out: frame 3, 6", result.err)
        self.assertEqual([f["nonfinite_image"] for f in report["frames"]], [0, 2, 0, 0, 0])
        self.assertEqual([f["nonfinite_reference"] for f in report["frames"]], [0, 0, 1, 0, 0])
        self.assertEqual((report["nonfinite_image"], report["nonfinite_reference"]), (2, 1))
        # Broken pixels of the frame before count for nothing in the next either.
        self.assertEqual(report["frames"][2]["details"]["temporal"]["nonfinite_pixels"], 2)
        self.assertIsNone(report["frames"][3]["metrics"]["temporal"])
        self.assertEqual(report["frames"][3]["no_value"]["temporal"], "frame 3 is missing")
        self.assertEqual(report["frames_counted"], {"mae": 5, "psnr": 2, "temporal": 3})
        self.assertEqual(report["no_value"]["lag"], "frame 3 is missing")
        self.assertIsNone(report["metrics"]["lag"])
        table = self.good("compare", "a.%d.exr", "r.%d.exr", "--metrics", "mae,psnr,temporal,lag").out
        self.assertRegex(table, r"(?m)^psnr: mean of 2 of 5 frames; .*frame 0: infinite")
        self.assertRegex(table, r"(?m)^temporal: mean of 3 of 4 frames; .*frame 4: frame 3 is missing")
        self.assertRegex(table, r"(?m)^1 .* 2 +0$")
        self.assertIn("lag: no value: frame 3 is missing", table)
        one = self.good("compare", "a.%d.exr", "r.%d.exr", "--metrics", "mae,temporal", "--frames", "4..5", "--json").json
        self.assertEqual((one["metrics"]["temporal"], one["no_value"]), (None, {"temporal": "there is one frame only"}))
        self.refused(3, ["a.3.exr"], "compare", "a.%d.exr", "r.%d.exr", "--frames", "2..5")
        self.frames("a.%d.exr", {3: 0.4}, size=(16, 10))
        self.refused(3, ["a.3.exr", "16x12", "16x10"], "compare", "a.%d.exr", "r.%d.exr", "--metrics", "mae")
        self.frames("r.%d.exr", {3: 0.4}, size=(16, 10))
        self.refused(3, ["a.3.exr", "frames differ in size"], "compare", "a.%d.exr", "r.%d.exr", "--metrics", "mae")

    def test_lag_is_of_linear_light_in_the_mask(self):
        # Far beyond what a screen shows, and half of the picture does something else.
        before, after = {f: 20.0 for f in range(3)}, {f: 50.0 for f in range(3, 8)}
        self.frames("r.%d.exr", before | after)
        for frame, level in {0: 20, 1: 20, 2: 20, 3: 35, 4: 42.5, 5: 46.25, 6: 48.125, 7: 49}.items():
            write_exr(self.folder / f"a.{frame}.exr", 16, 12, lambda x, y: (level if x < 8 else 1000 * frame,) * 3)
        write_png(self.folder / "left.png", 16, 12, lambda x, y: (255,) * 3 if x < 8 else (0,) * 3)
        report = self.good("compare", "a.%d.exr", "r.%d.exr", "--metrics", "lag", "--mask", "left.png", "--json").json
        self.assertEqual((report["metrics"]["lag"], report["details"]["lag"]["step_frame"]), (3, 3))
        for seen, expected in zip(report["details"]["lag"]["curve"], (0.5, 0.75, 0.875, 0.9375, 29 / 30)):
            self.assertAlmostEqual(seen, expected, places=6)
        other = self.good("compare", "a.%d.exr", "r.%d.exr", "--metrics", "lag", "--mask", "left.png", "--exposure=-9", "--json").json
        self.assertEqual(other["details"], report["details"])

    def test_movement_is_no_flicker(self):
        walk = ["--size", "64x48", "--frames", "0..3", "--fps", 30, "--set", "camera.jitter=none"]
        self.good("render", "parade", *walk, "--module", "none", "--spp", 16, "--out", "n.%d.exr", "--quiet")
        self.good("render", "parade", *walk, "--module", "none", "--spp", 16, "--buffers", "motion,depth", "--out", "r.%d.exr",
                  "--quiet", "--seed", 1)
        values = self.good("compare", "n.%d.exr", "r.%d.exr", "--metrics", "temporal,temporal_reprojected", "--json").json
        self.assertLess(values["metrics"]["temporal_reprojected"], values["metrics"]["temporal"])
        self.assertGreater(values["frames"][1]["details"]["temporal_reprojected"]["covered"], 0.5)

    def test_what_is_refused(self):
        write_png(self.folder / "small.png", 20, 16, pattern)
        (self.folder / "text.png").write_text("not an image")
        self.refused(3, ["small.png", "48x40", "20x16"], "compare", "small.png", "half.png")
        self.refused(3, ["size"], "compare", "small.png", "half.png", "--crop", "0,0,4,4")
        self.refused(3, ["mask"], "compare", "half.png", "half.png", "--mask", "small.png")
        self.refused(3, ["text.png"], "compare", "half.png", "text.png")
        self.refused(3, ["none.png"], "compare", "none.png", "half.png")
        self.refused(2, ["rmse", "--metrics"], "compare", "half.png", "half.png", "--metrics", "rmsee")
        self.refused(2, ["--crop"], "compare", "half.png", "half.png", "--crop", "40,0,20,20")
        for crop in ("1,2,3", "0,0,0,4", "-1,0,4,4", "a,b,c,d", "0,0,99999999999,4"):
            self.refused(2, ["--crop"], "compare", "half.png", "half.png", "--crop=" + crop)
        self.refused(2, [], "compare", "half.png")
        self.refused(2, [], "compare", "half.png", "half.png", "--exposure", "bright")


if __name__ == "__main__":
    main()
