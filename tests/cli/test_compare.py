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
