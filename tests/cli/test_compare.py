"""compare: numbers of known images, maps, parts of images, and what is refused."""
from lumiscope import CommandTest, exr_header, main, write_png

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

    def test_exposure_is_what_ldr_metrics_see(self):
        def ssim(*more):
            return self.metrics("pattern.png", "half.png", "--metrics", "ssim", *more)["ssim"]
        self.assertEqual(ssim(), ssim("--exposure", "0"))
        self.assertNotEqual(ssim(), ssim("--exposure", "-2"))

    def test_the_table(self):
        result = self.good("compare", "pattern.png", "half.png", "--metrics", "mse,flip")
        names = [line.split()[0] for line in result.out.splitlines() if not line.startswith(" ")]
        self.assertEqual(names, ["mse", "flip"])
        self.assertEqual(result.err, "")

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
        self.refused(3, ["ref.0006.png"], "compare", "out.%04d.png", "ref.%04d.png", "--frames", "8", "--metrics", "mae")
        self.refused(3, ["none.%d.png"], "compare", "none.%d.png", "ref.%04d.png")
        self.refused(2, ["--frames"], "compare", "half.png", "half.png", "--frames", "3")
        self.refused(2, ["lag", "frames"], "compare", "half.png", "half.png", "--metrics", "mse,lag")

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
