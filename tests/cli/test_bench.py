"""bench: the form of what it prints. Times depend on the machine and are not judged."""
from lumiscope import CommandTest, main

KEYS = {"name", "value", "unit", "median_ms", "spread", "limit", "ratio_to_limit"}


class Bench(CommandTest):
    def test_json(self):
        results = self.good("bench", "--filter", "^(trace/primary|build)/cornell$", "--json").json["results"]
        self.assertEqual([result["name"] for result in results], ["trace/primary/cornell", "build/cornell"])
        rays, build = results
        self.assertEqual(set(rays), KEYS)
        self.assertEqual((rays["unit"], build["unit"]), ("Mray/s", "s"))
        self.assertTrue(all(rays[key] > 0 for key in ("value", "median_ms", "limit", "ratio_to_limit")))
        self.assertAlmostEqual(rays["ratio_to_limit"], rays["value"] / rays["limit"], 6)
        # Every pixel's first ray, once.
        self.assertAlmostEqual(rays["value"] * rays["median_ms"] / 1000, 640 * 360 / 1e6, 6)
        self.assertAlmostEqual(build["value"], build["median_ms"] / 1000, 6)
        self.assertIsNone(build["limit"])
        self.assertIsNone(build["ratio_to_limit"])

    def test_table(self):
        table = self.good("bench", "--filter", "primary/cornell").out.splitlines()
        self.assertEqual(table[0].split(), ["name", "value", "unit", "median", "ms", "spread", "limit", "ratio"])
        self.assertEqual(len(table), 2)
        self.assertTrue(table[1].startswith("trace/primary/cornell "))

    def check_against_bandwidth(self, head, unit):
        """An entry with median, spread and the ratio to what memory gives in the same run, and its peak memory."""
        results = self.good("bench", "--filter", f"^{head}$", "--json", "--quiet").json["results"]
        self.assertEqual(results[0]["name"], head)
        for result in results:
            if result["name"].startswith("memory/"):
                self.assertEqual(result["unit"], "MiB")
                self.assertGreaterEqual(result["value"], 0)
                self.assertGreater(result["limit"], 0)
            else:
                self.assertEqual(result["unit"], unit)
                self.assertTrue(all(result[key] > 0 for key in ("value", "median_ms", "limit", "ratio_to_limit")), result)
        return [result["name"] for result in results]

    def test_a_metric(self):
        for metric in ("relmse", "lag"):
            self.assertEqual(self.check_against_bandwidth(f"metric/{metric}", "Mpixel/s"),
                             [f"metric/{metric}", f"memory/metric/{metric}"])

    def test_a_filter_and_its_stages(self):
        names = self.check_against_bandwidth("filter/svgf", "frame/s")
        self.assertIn("filter/svgf/wavelet filter", names)
        self.assertIn("memory/filter/svgf", names)

    def test_marks_are_judged_when_asked(self):
        result = self.run_program("bench", "--filter", "^mark/svgf$", "--check", "--json", "--quiet")
        marks = result.json["results"]
        self.assertEqual([mark["name"] for mark in marks],
                         ["mark/svgf/1280x720", "mark/svgf/640x360", "mark/svgf/1920x1080", "mark/svgf/size-spread"])
        sizes = [1] + [mark["value"] for mark in marks[1:3]]
        self.assertAlmostEqual(marks[3]["value"], max(sizes) / min(sizes), places=3)
        for mark in marks:
            self.assertEqual(mark["holds"], mark["value"] <= mark["limit"])
        self.assertEqual(marks[0]["limit"], 120)
        self.assertEqual(result.code, 0 if all(mark["holds"] for mark in marks) else 1)

    def test_the_list_has_every_metric_and_filter(self):
        names = {entry["id"] for entry in self.good("list", "benches", "--json").json}
        metrics = {metric["id"] for metric in self.good("list", "metrics", "--json").json}
        modules = {module["id"] for module in self.good("list", "modules", "--json").json}
        self.assertLessEqual({f"metric/{metric}" for metric in metrics}, names)
        self.assertLessEqual({f"filter/{module}" for module in modules - {"none"}}, names)
        self.assertLessEqual({"trace/path/cornell", "trace/path/atrium", "load/atrium"}, names)
        help_text = self.good("bench", "--help").out
        for word in ("metric/ID", "filter/MODULE/STAGE", "memory/filter/MODULE", "trace/frame"):
            self.assertIn(word, help_text)

    def test_quiet_still_prints_results(self):
        quiet = self.good("bench", "--filter", "build/cornell", "--quiet")
        self.assertIn("build/cornell", quiet.out)
        self.assertEqual(quiet.err, "")
        self.assertIn("results are printed all the same", " ".join(self.good("bench", "--help").out.split()))

    def test_filters_that_leave_nothing(self):
        self.refused(2, ["--filter", "trace/path/atrium", "nonsense"], "bench", "--filter", "nonsense")
        self.refused(2, ["--filter", "regular expression"], "bench", "--filter", "(")


if __name__ == "__main__":
    main()
