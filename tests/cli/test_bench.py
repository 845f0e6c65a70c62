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

    def test_filters_that_leave_nothing(self):
        self.refused(2, ["--filter", "trace/path/atrium", "nonsense"], "bench", "--filter", "nonsense")
        self.refused(2, ["--filter", "regular expression"], "bench", "--filter", "(")


if __name__ == "__main__":
    main()
