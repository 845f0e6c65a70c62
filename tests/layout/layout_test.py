"""The house rules that a machine can check: where files stand, who includes whom, how long files are."""
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

ROOT = pathlib.Path(sys.argv.pop(1))
ORDER = "base math image params scene frame gl trace filter reconstruct measure reference session study".split()
TOP = {"CMakeLists.txt", "CMakePresets.json", "README.md", "CHANGELOG.md", "LICENSE", "app", "renderer", "ui",
       "shaders", "scenes", "tests", "build"}
CODE = {".h", ".cpp"}


def code_files(*folders):
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in CODE:
                yield path


def includes(path):
    """Quoted includes of a file with their line numbers."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
        if match:
            yield number, match.group(1)


class Layout(unittest.TestCase):
    def test_top_level_holds_nothing_else(self):
        names = {p.name for p in ROOT.iterdir() if not p.name.startswith(".") and not p.name.startswith("build")}
        self.assertEqual(names - TOP, set())

    def test_a_folder_includes_only_folders_above_it(self):
        wrong = []
        for path in code_files("renderer"):
            folder = path.relative_to(ROOT / "renderer").parts[0]
            self.assertIn(folder, ORDER, f"{path} stands in a folder the layout does not have")
            for number, name in includes(path):
                target = name.split("/")[0]
                if target not in ORDER or ORDER.index(target) > ORDER.index(folder):
                    wrong.append(f"{path.relative_to(ROOT)}:{number}: {name}")
        self.assertEqual(wrong, [])

    def test_nothing_in_the_engine_knows_the_window(self):
        wrong = [str(p) for p in code_files("renderer", "app") if re.search(r'include\s+[<"]imgui', p.read_text())]
        self.assertEqual(wrong, [])

    def test_only_the_parallel_loops_know_tbb(self):
        users = {p.name for p in code_files("renderer", "ui", "app") if re.search(r"include\s+<tbb/", p.read_text())}
        self.assertEqual(users, {"parallel.cpp"})

    def test_files_stay_short(self):
        long = []
        for path in code_files("renderer", "ui", "app", "tests"):
            lines = path.read_text().count("\n")
            if lines > 400 and "table" not in path.name:
                long.append(f"{path.relative_to(ROOT)} ({lines})")
        self.assertEqual(long, [])

    def test_code_is_formatted(self):
        """By the clang-format whose output .clang-format was written for: each version lays out a little differently."""
        if not shutil.which("clang-format"):
            self.skipTest("clang-format is not installed")
        version = subprocess.run(["clang-format", "--version"], capture_output=True, text=True).stdout.strip()
        if " version 14." not in version:
            self.skipTest(f"the code is formatted by clang-format 14; found {version}")
        files = [str(p) for p in code_files("renderer", "ui", "app", "tests")]
        check = subprocess.run(["clang-format", "--dry-run", "--ferror-limit=1", *files], capture_output=True, text=True)
        wrong = sorted({line.split(":")[0] for line in check.stderr.splitlines() if "clang-format-violations" in line})
        self.assertEqual([str(pathlib.Path(p).relative_to(ROOT)) for p in wrong], [], "clang-format -i mends them")

    def test_comments_keep_to_the_columns(self):
        """clang-format leaves comments as they are; strings may be as long as they must."""
        wide = [f"{path.relative_to(ROOT)}:{number}"
                for path in code_files("renderer", "ui", "app", "tests")
                for number, line in enumerate(path.read_text().splitlines(), 1)
                if len(line) > 120 and re.search(r"(^|\s)///?<? ", line)]
        self.assertEqual(wide, [])

    def test_sources_are_listed_in_a_build_file(self):
        """A source that no CMakeLists.txt names is never compiled, and its tests never run."""
        listed = "\n".join(p.read_text() for p in ROOT.rglob("CMakeLists.txt") if "build" not in p.parts)
        missing = [str(p.relative_to(ROOT)) for p in code_files("renderer", "ui", "app", "tests")
                   if p.suffix == ".cpp" and p.name not in listed]
        self.assertEqual(missing, [])

    def test_no_promises_of_later_work(self):
        pattern = re.compile(r"\b(TODO|FIXME|XXX|HACK)\b")
        found = [f"{p.relative_to(ROOT)}" for p in code_files("renderer", "ui", "app") if pattern.search(p.read_text())]
        self.assertEqual(found, [])

    def test_no_path_of_one_machine(self):
        pattern = re.compile(r"/(work|root|home)/")
        found = [str(p.relative_to(ROOT)) for p in code_files("renderer", "ui", "app", "tests")
                 if pattern.search(p.read_text())]
        self.assertEqual(found, [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
