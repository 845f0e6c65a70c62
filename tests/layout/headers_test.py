"""Every header compiles by itself, with the flags that the build uses."""
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


def main():
    flags = flags_of_folder()
    jobs = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for top in ("renderer", "ui", "app"):
            for path in sorted((source / top).rglob("*.h")):
                relative = path.relative_to(source)
                folder = "/".join(relative.parts[:2]) if top == "renderer" else top
                name = str(relative.relative_to("renderer")) if top == "renderer" else str(relative)
                jobs.append(pool.submit(check, name, flags.get(folder, flags.get("renderer/session", []))))
    failed = [job.result() for job in jobs if job.result()[1] != 0]
    for header, _, text in failed:
        print(f"{header} does not compile alone:\n{text}")
    print(f"{len(jobs) - len(failed)} passed, {len(failed)} failed")
    return 1 if failed or not jobs else 0


sys.exit(main())
