"""study: results, resuming after kill -9, errors. LUMISCOPE_KILLS sets how often a study is killed (3)."""
import csv
import json
import os
import random
import signal
import subprocess
import time

from lumiscope import PROGRAM, CommandTest, main

STUDY = {
    "version": 1, "title": "Tiny <study>", "scenes": ["cornell"], "size": [64, 36],
    "frames": {"range": [0, 4], "measure": [1, 2]}, "spp": [1, 2], "seeds": [1, 2],
    "reference": {"spp": 64}, "metrics": ["mse", "ssim", "temporal_reprojected"],
    "entries": [{"name": "raw", "module": "none"},
                {"name": "mean", "module": "accumulate"},
                {"name": "limited", "module": "accumulate", "set": {"limit": True}, "tune": {"max-samples": [1, 4]}}],
    "tuning": {"frame": 3, "metric": "mse"},
    "pairs": [{"entry": "mean", "against": "raw"}],
    "ablations": [{"entry": "mean", "stages": [{"name": "history", "set": {"limit": True, "max-samples": 1}}]}],
    "figures": [{"name": "strip", "crops": [{"name": "box", "box": [0.25, 0.5, 0.25, 0.25]}]}],
    "presets": {"quick": {}},
}


class StudyTest(CommandTest):
    def write(self, name="tiny.json", **changes):
        study = {key: value for key, value in {**STUDY, **changes}.items() if value is not None}
        (self.folder / name).write_text(json.dumps(study))
        return name

    def environment(self, cache="cache"):
        return {"XDG_CACHE_HOME": str(self.folder / cache)}

    def study(self, *arguments, cache="cache"):
        return self.good("study", *arguments, **self.environment(cache))

    def contents(self, folder):
        """Every file that has to come out the same: all but times, and what shows them."""
        root = self.folder / folder
        return {str(path.relative_to(root)): path.read_bytes() for path in sorted(root.rglob("*"))
                if path.is_file() and path.name not in ("timings.json", "times.json", "report.html")
                and path.parent.name != "tables"}


class Results(StudyTest):
    def test_a_study_writes_what_it_promises(self):
        result = self.study(self.write(), "--preset", "quick", "--out", "out", "--json")
        out = self.folder / "out"
        self.assertEqual({p.name for p in out.iterdir() if p.is_file()} - {".lock"},
                         {"study.json", "results.json", "results.csv", "timings.json", "report.html"})
        results = json.loads((out / "results.json").read_text())
        self.assertEqual(result.json, results)
        # Three entries and one without a stage, two sample counts, two seeds; two frames, and what is measured over the sequence.
        self.assertEqual(len(results["rows"]), 48)
        keys = [(r["scene"], r["frame"], r["entry"], r["spp"], r["seed"]) for r in results["rows"]]
        self.assertEqual(len(set(keys)), 48)
        sequences = [row for row in results["rows"] if row["frame"] == "sequence"]
        self.assertEqual(len(sequences), 16)
        flicker = {(r["entry"], r["spp"], r["seed"]): r["metrics"]["temporal_reprojected"] for r in sequences}
        self.assertGreater(flicker["raw", 1, 1], 1.5 * flicker["mean", 1, 1], "a mean of frames flickers less")
        for row in results["rows"]:
            if row["frame"] == "sequence":
                continue
            self.assertGreater(row["metrics"]["mse"], 0)
            self.assertLessEqual(row["corrected"]["mse"], row["metrics"]["mse"])
            self.assertLess(row["metrics"]["ssim"], 1)
            self.assertEqual(row["nonfinite_pixels"], 0)
        with open(out / "results.csv") as file:
            table = list(csv.DictReader(file))
        self.assertEqual(len(table), 48)
        for line, row in zip(table, results["rows"]):
            metric = "temporal_reprojected" if row["frame"] == "sequence" else "mse"
            self.assertEqual(float(line[metric]), row["metrics"][metric])
            self.assertEqual((line["entry"], line["frame"]), (row["entry"], str(row["frame"])))
        # The mean of three frames has less error than one frame, and two samples less than one.
        mean = {(s["entry"], s["spp"]): s for s in results["summary"] if s["metric"] == "mse" and s["scene"] == "cornell"}
        self.assertLess(mean["mean", 1]["mean"], 0.7 * mean["raw", 1]["mean"])
        self.assertLess(mean["raw", 2]["mean"], 0.7 * mean["raw", 1]["mean"])
        self.assertEqual(mean["raw", 1]["count"], 2)
        self.assertLess(mean["raw", 1]["low"], mean["raw", 1]["mean"])
        # Tuning finds that the mean of four frames is better than the last of them, at both sample counts.
        self.assertEqual([t["chosen"]["max-samples"] for t in results["tuning"]], ["4", "4"])
        for tuning in results["tuning"]:
            one, four = tuning["candidates"]
            self.assertEqual((one["values"]["max-samples"], four["values"]["max-samples"]), ("1", "4"))
            self.assertLess(four["metric"], 0.6 * one["metric"])
        times = json.loads((out / "timings.json").read_text())
        self.assertEqual(len(times["rows"]), 8)
        for row in times["rows"]:
            for part in (row["frame_ms"], row["build_ms"], row["trace_ms"], *row["stages_ms"].values()):
                self.assertGreaterEqual(part["mean"], 0)
                self.assertLessEqual(part["low"], part["mean"], "every time has its interval")
        self.assertIn("equivalent_spp", results["equivalent_samples"][0])
        self.assertEqual(results["nonfinite"], [])
        self.assertIn("<dt>Images measured</dt><dd>32</dd>", (out / "report.html").read_text(), "sequences are no images")
        # Without its history the mean is the raw frame: twice to thrice the error at frames 1 and 2.
        effect = {(a["scene"], a["spp"], a["metric"]): a for a in results["ablations"]}["cornell", 1, "mse"]
        self.assertEqual((effect["entry"], effect["stage"], effect["difference"]["count"]), ("mean", "history", 2))
        self.assertGreater(effect["without"]["mean"], 1.6 * effect["whole"]["mean"])
        self.assertAlmostEqual(effect["difference"]["mean"], effect["without"]["mean"] - effect["whole"]["mean"], 12)
        self.assertEqual({a["stage"] for a in times["ablations"]}, {"history"})

    def test_frames_at_a_rate_of_their_own_are_no_jumps(self):
        """Slower than the scene's rate, every frame was taken for a cut and no method had a history."""
        entries = [{"name": "raw", "module": "none"}, {"name": "temporal", "module": "temporal"}]
        self.study(self.write(entries=entries, tuning=None, ablations=None, figures=None, pairs=None, metrics=["rmse"],
                              frames={"range": [0, 8], "measure": [7], "fps": 5}), "--out", "out")
        rows = json.loads(self.bytes("out/results.json"))["rows"]
        error = {(r["scene"], r["entry"], r["spp"], r["seed"]): r["metrics"]["rmse"] for r in rows}
        for (scene, entry, spp, seed), value in error.items():
            if entry == "temporal":
                self.assertLess(value, 0.75 * error[scene, "raw", spp, seed])

    def test_claims_decide_the_exit_code(self):
        good = [{"title": "the mean is better", "entry": "mean", "metric": "mse", "against": ["raw"], "at-most": 0.8}]
        result = self.study(self.write(checks=good), "--out", "out")
        self.assertIn("the mean is better", result.out)
        self.assertEqual({c["verdict"] for c in json.loads(self.bytes("out/results.json"))["checks"]} - {"holds", "holds within the noise"}, set())
        bad = self.run_program("study", self.write(checks=good + [{"entry": "raw", "metric": "ssim", "at-least": 0.99}]), "--out", "out",
                               **self.environment())
        self.assertEqual(bad.code, 1, bad.err)
        self.assertRegex(bad.out, r"SSIM of raw at least 0.99 +cornell .* fails")
        self.assertIn("0 jobs run, ", bad.err)
        entries = [{"name": "raw", "module": "none"}, {"name": "more", "module": "none", "spp": [4]}]
        unknown = self.run_program("study", self.write(entries=entries, tuning=None, ablations=None, figures=None, pairs=None, spp=[1],
                                                       checks=[{"entry": "raw", "metric": "mse", "against": ["more"], "at-most": 9}]),
                                   "--out", "unknown", **self.environment())
        self.assertEqual(unknown.code, 1, unknown.err)
        self.assertRegex(unknown.out, r"cornell +1 .* more .* unknown")

    def test_figures_and_tables_for_the_paper(self):
        name = self.write()
        self.study(name, "--out", "out")
        out = self.folder / "out"
        self.assertEqual(sorted(p.name for p in (out / "figures").iterdir()), ["strip.png", "strip.svg"])
        tables = {p.name: p.read_text() for p in (out / "tables").iterdir()}
        self.assertEqual(set(tables), {"results-cornell.tex", "times-cornell.tex", "equal-cornell.tex", "ablation-cornell.tex", "metrics.tex", "all.tex"})
        self.assertIn("\\toprule", tables["results-cornell.tex"])
        self.assertIn("Tiny \\textless{}study\\textgreater{}", tables["results-cornell.tex"])
        # Another choice of crops is drawn from what is there: nothing is rendered again, and what is not wanted any more goes.
        (out / "tables" / "all.pdf").write_text("mine")
        changed = [{"name": "other", "metric": "mse", "crops": [{"box": [0, 0, 0.5, 0.5]}, {"box": [0.5, 0.5, 0.5, 0.5]}]}]
        result = self.study(self.write(figures=changed), "--out", "out")
        self.assertIn("0 jobs run, ", result.err)
        self.assertEqual(sorted(p.name for p in (out / "figures").iterdir()), ["other.png", "other.svg"])
        self.assertEqual((out / "tables" / "all.pdf").read_text(), "mine", "nothing that the study did not write")

    def test_lag_is_measured_after_a_step_in_the_light(self):
        """A mean with weight 1/2 of the new frame has 90% after three frames: 1 - 0.5^(n + 1)."""
        step = {"frame": 3, "set": {"light.lamp.power": 4}}
        name = self.write(frames={"range": [0, 9], "measure": [8], "still": True, "step": step}, metrics=["mse", "lag"], spp=[16], seeds=[1, 2],
                          reference={"spp": 256}, tuning={"frame": 7, "metric": "mse"}, ablations=[], pairs=[],
                          entries=[{"name": "raw", "module": "none"}, {"name": "half", "module": "temporal", "set": {"color-alpha": 0.5}},
                                   {"name": "slow", "module": "temporal", "set": {"color-alpha": 0.05}}])
        results = self.study(name, "--out", "out", "--json").json
        lag = {s["entry"]: s for s in results["summary"] if s["metric"] == "lag"}
        self.assertEqual(lag["raw"]["mean"], 0, "a frame without memory follows at once")
        self.assertEqual(lag["half"]["mean"], 3)
        self.assertIsNone(lag["slow"]["mean"], "not within the frames there were")
        self.assertEqual(lag["slow"]["missing"], 2)
        page = (self.folder / "out" / "report.html").read_text()
        data = json.loads(page.split('id="data">', 1)[1].split("</script>", 1)[0])
        curve = {s["entry"]: s for s in data["series"] if s["metric"] == "lag"}["half"]
        self.assertEqual(curve["begin"], 3)
        for n, value in enumerate(curve["values"][:4]):
            self.assertAlmostEqual(value, 1 - 0.5 ** (n + 1), delta=0.03)

    def test_the_report_is_one_file_that_needs_no_other(self):
        self.study(self.write(), "--preset", "quick", "--out", "out")
        page = (self.folder / "out" / "report.html").read_text()
        self.assertIn("<title>Tiny &lt;study&gt;</title>", page)
        self.assertNotIn("{{", page.split("<script", 1)[0])
        for outside in ('src="http', 'href="http', "@import", "url(http"):
            self.assertNotIn(outside, page)
        data = json.loads(page.split('id="data">', 1)[1].split("</script>", 1)[0])
        self.assertEqual(len(data["pictures"]), 2, "the least and the most samples")
        kinds = [image["kind"] for image in data["pictures"][0]["images"]]
        self.assertEqual(sorted(kinds), ["error"] * 4 + ["method"] * 4 + ["reference"])
        self.assertEqual([figure["name"] for figure in data["figures"]], ["strip"])

    def test_table_on_standard_output(self):
        result = self.study(self.write(), "--out", "out")
        for part in ("cornell, 1 spp", "raw", "limited", "±", "cornell, 1 spp, without", "history", "equal time, equal value"):
            self.assertIn(part, result.out)
        self.assertIn("Wrote out/report.html", result.err)

    def test_threads_never_change_a_result(self):
        name = self.write()
        self.study(name, "--out", "one", "--threads", "1", cache="a")
        self.study(name, "--out", "three", "--threads", "3", cache="b")
        self.assertEqual(self.contents("one"), self.contents("three"))

    def test_a_changed_study_keeps_what_it_can(self):
        self.study(self.write(), "--out", "out")
        before = {p.name for p in (self.folder / "out" / "jobs").iterdir()}
        result = self.study(self.write(seeds=[2, 3], title="Other"), "--out", "out")
        after = {p.name for p in (self.folder / "out" / "jobs").iterdir()}
        # At two sample counts: one tuning, and two groups of methods for each of two seeds, one of which is new.
        self.assertEqual((len(before), len(before & after), len(after)), (10, 6, 10))
        self.assertIn("4 jobs run, 6 found done", result.err)
        self.assertEqual({r["seed"] for r in json.loads(self.bytes("out/results.json"))["rows"]}, {2, 3})


class Resume(StudyTest):
    def test_killed_at_any_moment_it_ends_with_the_same_bytes(self):
        name = self.write()
        begun = time.monotonic()
        self.study(name, "--out", "whole", cache="a")
        duration = time.monotonic() - begun
        expected = self.contents("whole")
        seed = int(os.environ.get("LUMISCOPE_SEED", "1"))
        moments = random.Random(seed)
        killed = 0
        for kill in range(int(os.environ.get("LUMISCOPE_KILLS", "3"))):
            folder, cache = f"killed-{kill}", f"cache-{kill}"
            for _ in range(moments.randint(1, 3)):
                process = subprocess.Popen([PROGRAM, "study", name, "--out", folder, "--quiet"], cwd=self.folder,
                                           stdout=subprocess.DEVNULL, env={**os.environ, **self.environment(cache)})
                time.sleep(moments.uniform(0.02, 0.9 * duration))
                process.send_signal(signal.SIGKILL)
                killed += process.wait() == -signal.SIGKILL
            self.study(name, "--out", folder, cache=cache)
            self.assertEqual(self.contents(folder), expected, f"seed {seed}, kill {kill}")
        self.assertGreater(killed, 0)

    def test_a_finished_study_runs_nothing_again(self):
        name = self.write()
        self.study(name, "--out", "out")
        before = self.contents("out")
        result = self.study(name, "--out", "out")
        self.assertIn("0 jobs run, ", result.err)
        self.assertEqual(self.contents("out"), before)

    def test_an_interrupt_ends_it_and_it_goes_on(self):
        """Ctrl+C at three moments: exit code 130 and nothing on standard output; then the same bytes as without."""
        name = self.write(reference={"spp": 512})
        begun = time.monotonic()
        self.study(name, "--out", "whole", cache="a")
        duration, expected = time.monotonic() - begun, self.contents("whole")
        for part in (0.15, 0.4, 0.65):
            process = subprocess.Popen([PROGRAM, "study", name, "--out", "out", "--quiet"], cwd=self.folder, stderr=subprocess.PIPE,
                                       stdout=subprocess.PIPE, env={**os.environ, **self.environment("b")})
            time.sleep(part * duration)
            process.send_signal(signal.SIGINT)
            output, error = process.communicate(timeout=60)
            if process.returncode == 0 and part > 0.3:
                continue  # it goes on where it was, so that later ones may come too late
            self.assertEqual((process.returncode, output), (130, b""), error)
            self.assertFalse((self.folder / "out" / "results.json").exists())
        self.study(name, "--out", "out", cache="b")
        self.assertEqual(self.contents("out"), expected)

    def test_a_folder_belongs_to_one_study(self):
        self.study(self.write(), "--out", "out")
        before = self.contents("out")
        other = self.write("other.json")
        self.refused(2, ["out: holds the study \"tiny\"", "another folder for \"other\""], "study", other, "--out", "out", **self.environment())
        (self.folder / "mine").mkdir()
        (self.folder / "mine" / "results.json").write_text("mine")
        self.refused(2, ["mine: holds \"results.json\"", "an empty folder"], "study", other, "--out", "mine", **self.environment())
        self.assertEqual(self.contents("out"), before)
        self.assertEqual((self.folder / "mine" / "results.json").read_text(), "mine")

    def test_one_process_works_in_a_folder(self):
        name = self.write(reference={"spp": 4096}, size=[320, 180])
        process = subprocess.Popen([PROGRAM, "study", name, "--out", "out", "--quiet"], cwd=self.folder,
                                   stdout=subprocess.DEVNULL, env={**os.environ, **self.environment()})
        try:
            while not (self.folder / "out" / ".lock").exists():
                time.sleep(0.01)
            time.sleep(0.1)
            self.refused(2, ["another study runs in this folder"], "study", name, "--out", "out", **self.environment())
        finally:
            process.kill()
            process.wait()


class Errors(StudyTest):
    def test_one_line_with_the_place(self):
        self.refused(2, ["unknown study", '"convergence"'], "study", "convergense")
        self.refused(3, ["no such file", "no/such.json"], "study", "no/such.json")
        self.refused(2, ["no preset", "--preset", '"quick"'], "study", self.write(), "--preset", "qick")
        (self.folder / "broken.json").write_text('{\n  "version": 1,\n  "sceens": []\n}')
        self.refused(3, ["broken.json:3:3", '"scenes"'], "study", "broken.json")
        self.refused(3, ["lost.json:1:", "unknown scene"], "study", self.write("lost.json", scenes=["no-such-scene"]))
        self.refused(3, ["bad.json:1:", "path.max-dept", "path.max-depth"], "study",
                     self.write("bad.json", set={"path.max-dept": 3}), "--out", "o", **self.environment())
        # Every scene is looked at before the first is rendered.
        self.refused(3, ["bad.json:1:", "camera.select"], "study",
                     self.write("bad.json", scenes=["cornell", {"scene": "room", "set": {"camera.select": "nobody"}}], reference={"spp": 1 << 20}),
                     "--out", "q", **self.environment())
        self.assertFalse((self.folder / "q" / "jobs").exists())
        self.refused(3, ["bad.json:1:", "camera.select"], "study",
                     self.write("bad.json", scenes=[{"scene": "cornell", "set": {"camera.select": "nobody"}}]), "--out", "p",
                     **self.environment())

    def test_optional_scenes_are_left_out_with_a_warning(self):
        name = self.write(scenes=["cornell", {"scene": "assets:no/such.gltf", "optional": True}], seeds=[1], spp=[1])
        result = self.study(name, "--out", "out")
        self.assertIn("warning: scene \"such\" is left out", result.err)
        result = self.good("study", self.write(scenes=["cornell", {"scene": "sponza", "optional": True}], seeds=[1], spp=[1]), "--out", "out2",
                            **self.environment(), LUMISCOPE_ASSETS="/nowhere")
        self.assertIn("warning: scene \"sponza\" is left out", result.err)
        self.assertIn("/nowhere/gltf/Sponza/Sponza.gltf: no such asset", result.err)
        name = self.write(scenes=[{"scene": "assets:no/such.gltf", "optional": True}])
        self.refused(3, ["none of the study's scenes is there"], "study", name, "--quiet")

    def test_list_studies(self):
        studies = {s["id"]: s for s in self.good("list", "studies", "--json").json}
        self.assertLessEqual({"convergence", "clamping"}, set(studies))
        for study in studies.values():
            self.assertLessEqual({"quick", "paper"}, set(study["presets"]))
        self.assertIn(studies["convergence"]["title"], self.good("list", "studies").out)
        self.assertIn("convergence", self.good("study", "--help").out)


if __name__ == "__main__":
    main()
