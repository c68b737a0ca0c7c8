#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""compiles_with.py COMPILER COMPILE_COMMANDS FOLDER...: another compiler has no word on the sources below these
folders, with the flags that they are built with. It only reads them, which is when it warns."""
import concurrent.futures
import json
import os
import shlex
import subprocess
import sys

compiler, commands, *folders = sys.argv[1:]
folders = tuple(os.path.join(os.path.realpath(folder), "") for folder in folders)
with open(commands, encoding="utf-8") as file:
    wanted = [command for command in json.load(file) if os.path.realpath(command["file"]).startswith(folders)]


def read(command):
    """What it says, or nothing."""
    words = shlex.split(command["command"])[1:]
    run = subprocess.run([compiler, *words, "-fsyntax-only", "-Werror", "-Wno-unused-command-line-argument"],
                         cwd=command["directory"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return run.stdout + (f"{command['file']}: status {run.returncode}\n" if run.returncode else "")


with concurrent.futures.ThreadPoolExecutor(2) as pool:
    said = "".join(pool.map(read, wanted))
print(f"{len(wanted)} sources", said, sep="\n")
sys.exit(1 if said or len(wanted) < 20 else 0)
