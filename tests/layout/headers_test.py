"""Every header compiles by itself. A header that its own source includes first is proven by the build; only the others
are compiled here, with the flags that the build uses."""
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

source, build = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])


def flags_of_folder():
    """Compile flags (includes, definitions) of one source of each folder, from the compilation database."""
    flags = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        folder = pathlib.Path(entry["file"]).resolve().relative_to(source).parts[0:2]
        words = shlex.split(entry["command"])
        kept, take = [], False
        for word in words:
            if take:
                kept.append(word)
                take = False
            elif word in ("-isystem", "-I"):
                kept.append(word)
                take = True
            elif re.match(r"-[ID]|-isystem", word):
                kept.append(word)
        flags.setdefault("/".join(folder[:2]) if folder[0] == "renderer" else folder[0], kept)
    return flags


def check(header, flags):
    command = [os.environ.get("CXX", "g++"), "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wshadow",
               "-Wno-unused-parameter", "-Werror", "-x", "c++", *flags, "-"]
    text = f'#include "{header}"\n'
    done = subprocess.run(command, input=text, capture_output=True, text=True, cwd=source)
    return header, done.returncode, done.stderr


def proven_by_the_build(path, name):
    """Does path's own .cpp begin with it?"""
    own = path.with_suffix(".cpp")
    if not own.exists():
        return False
    first = re.search(r'^\s*#\s*include\s+(\S+)', own.read_text(), re.MULTILINE)
    return first is not None and first.group(1) == f'"{name}"'


def main():
    flags = flags_of_folder()
    jobs, proven = [], 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for top in ("renderer", "ui", "app"):
            for path in sorted((source / top).rglob("*.h")):
                relative = path.relative_to(source)
                name = str(relative.relative_to("renderer")) if top == "renderer" else str(relative)
                if proven_by_the_build(path, name):
                    proven += 1
                    continue
                folder = "/".join(relative.parts[:2]) if top == "renderer" else top
                jobs.append(pool.submit(check, name, flags.get(folder, flags.get("renderer/session", []))))
    failed = [job.result() for job in jobs if job.result()[1] != 0]
    for header, _, text in failed:
        print(f"{header} does not compile alone:\n{text}")
    print(f"{len(jobs) - len(failed) + proven} passed, {len(failed)} failed")
    return 1 if failed or not jobs or not proven else 0


sys.exit(main())
