#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Breaks the library on purpose, one place at a time, and counts which breaks the tests see.

    run.py BUILD OUT [--count N] [--seed S] [--jobs J] [--again]

BUILD holds the tests, built with a shared library; OUT gets copies of the sources, the broken
libraries and report.jsonl. A mutant that does not compile, or compiles to the same machine code,
is replaced by the next. The same seed on the same sources gives the same mutants. --again: only
those that survived in OUT/report.jsonl, where their line still reads as it did. --resume: goes on
behind those in OUT/report.jsonl, with the times of tests in OUT/seconds.json.

Of the passes, one template, only the copies for the baseline are compiled. Lines that those lack are
tried on a library with all."""
import argparse
import collections
import concurrent.futures
import glob
import hashlib
import json
import os
import queue
import random
import resource
import shutil
import subprocess
import sys
import time

import operators

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
MEMORY = 6 << 30  # a mutant may ask for anything [byte]
BASELINE = "/baseline"  # where a tree has its build of the baseline alone
WALL = 900  # [s]; what counts is the time of the processor

Test = collections.namedtuple("Test", "name command")


def run(command, **options):
    return subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL, **options)


def limited(seconds):
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    return limit


def run_test(command, library, seconds):
    """None if the test passes, else how it failed."""
    environment = dict(os.environ, LD_LIBRARY_PATH=library, OMP_NUM_THREADS="2",
                       OMP_WAIT_POLICY="passive", SPHG_TEST_ENDS_AT_FAILURE="1")
    if library.endswith(BASELINE + "/src"):
        environment["SPHG_TEST_BASELINE_ALONE"] = "1"
    try:
        code = run(command, env=environment, cwd=ROOT, preexec_fn=limited(seconds),
                   timeout=WALL).returncode
    except subprocess.TimeoutExpired:
        return "time"
    if code < 0:
        return "time" if -code in (9, 24) else "signal %d" % -code
    return "failed" if code else None


def tests_of(build):
    """The areas and the replays."""
    commands = {os.path.basename(path)[5:]: [path]
                for path in glob.glob(build + "/tests/test_*") if os.access(path, os.X_OK)}
    for path in glob.glob(build + "/tests/fuzz/fuzz_*"):
        name = os.path.basename(path)
        corpus = glob.glob("%s/tests/fuzz/corpus/%s/*" % (ROOT, name[5:]))
        if os.access(path, os.X_OK) and corpus:
            commands[name] = [path] + sorted(corpus)
    return [Test(*item) for item in sorted(commands.items())]


class Experience:
    """What each test costs and how often it killed, so that the cheapest kill is tried first."""

    def __init__(self, tests, library, file, resume):
        self.tests, self.seconds = tests, {}
        self.tried, self.killed = collections.Counter(), collections.Counter()
        if resume and os.path.exists(file):
            with open(file) as known:
                self.seconds = json.load(known)
        self.measure(library)
        with open(file, "w") as known:
            json.dump(self.seconds, known)

    def measure(self, library):
        for test in self.tests:
            if test.name in self.seconds:
                continue
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            end = run_test(test.command, library, 3600)
            if end:
                sys.exit("%s fails without any change: %s" % (test.name, end))
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            self.seconds[test.name] = (after.ru_utime + after.ru_stime - before.ru_utime -
                                       before.ru_stime)

    def limit(self, test):
        return int(5 + 6 * self.seconds[test.name])

    def learn(self, path, name, killed):
        for key in (name, (path, name)):
            self.tried[key] += 1
            self.killed[key] += killed

    def kills_per_second(self, path, name):
        """Mutants of the same file weigh most; before there are any, those of all files."""
        of_all = (self.killed[name] + 1) / (self.tried[name] + 4)
        of_file = (self.killed[path, name] + 4 * of_all) / (self.tried[path, name] + 4)
        return of_file / (self.seconds[name] + 0.1)

    def ordered(self, path):
        return sorted(self.tests, key=lambda test: -self.kills_per_second(path, test.name))


class Build:
    """A build of the library as it was, and what it takes to get back there."""

    def __init__(self, source, place, *options):
        self.place, self.folder, self.kept = place, place + "/src", place + "-kept"
        # -O1: half of the time goes into compiling passes
        run(["cmake", "-S", source, "-B", place, "-DCMAKE_BUILD_TYPE=Debug",
             "-DCMAKE_C_FLAGS_DEBUG=-O1", "-DSPHG_BUILD_TESTS=OFF", "-DSPHG_BUILD_BENCH=OFF",
             "-DSPHG_BUILD_EXAMPLES=OFF", "-DSPHG_INSTALL=OFF", *options], check=True)
        # twice: only the second time does make learn which headers the objects depend on
        if not self.compile() or not self.compile():
            sys.exit("the library does not build without any change")
        self.original = self.machine_code()
        shutil.copytree(self.folder, self.kept)

    def compile(self):
        return run(["cmake", "--build", self.place]).returncode == 0

    def machine_code(self):
        digest = hashlib.sha256()
        for path in sorted(glob.glob(self.folder + "/**/*.o", recursive=True)):
            with open(path, "rb") as file:
                digest.update(file.read())
        return digest.digest()

    def differs(self):
        return self.machine_code() != self.original

    def restore(self):
        """With their old times, so that nothing is compiled again."""
        shutil.copytree(self.kept, self.folder, dirs_exist_ok=True)


class Tree:
    """The sources once more, with a build of the library for the baseline, and of all when needed."""

    def __init__(self, original, place):
        self.original, self.source, self.place = original, place + "/source", place
        shutil.rmtree(place, ignore_errors=True)
        shutil.copytree(original, self.source)
        self.baseline = Build(self.source, place + BASELINE, "-DSPHG_COMPILER_HAS_V3=",
                              "-DSPHG_COMPILER_HAS_V4=")
        self.builds = [self.baseline]
        self.require_that_headers_count("src/passes/passes.h")

    def require_that_headers_count(self, header):
        """A mutant that is not compiled would pass for one that makes no difference."""
        for _ in range(2):
            self.write(header, "#error\n")
            if self.baseline.compile():
                sys.exit("a change of %s goes unseen" % header)
            self.restore(header)

    def everything(self):
        """Only while the sources are as they were."""
        if len(self.builds) == 1:
            self.builds.append(Build(self.source, self.place + "/all"))
        return self.builds[1]

    def write(self, path, text):
        with open("%s/%s" % (self.source, path), "w") as file:
            file.write(text)

    def restore(self, path):
        shutil.copy2("%s/%s" % (self.original, path), "%s/%s" % (self.source, path))
        for build in self.builds:
            build.restore()


def text_of(original, path):
    with open("%s/%s" % (original, path)) as file:
        return file.read()


def verdict_of(tree, mutant, experience):
    """(how the mutant ended, the test that saw it)."""
    lines = text_of(tree.original, mutant.path).split("\n")
    lines[mutant.line - 1] = mutant.after
    for build_of in (lambda: tree.baseline, tree.everything):
        build = build_of()
        tree.write(mutant.path, "\n".join(lines))
        try:
            if not build.compile():
                return "stillborn", None
            if build.differs():
                return verdict_of_tests(build.folder, mutant, experience)
        finally:
            tree.restore(mutant.path)
    return "same code", None


def verdict_of_tests(library, mutant, experience):
    for test in experience.ordered(mutant.path):
        end = run_test(test.command, library, experience.limit(test))
        experience.learn(mutant.path, test.name, end is not None)
        if end:
            return end, test.name
    return "survived", None


def copied_sources(place):
    """What the mutants are made from: the sources as they are now, whatever is edited meanwhile."""
    shutil.rmtree(place, ignore_errors=True)
    os.makedirs(place)
    shutil.copy(ROOT + "/CMakeLists.txt", place)
    for folder in ("src", "include"):
        shutil.copytree("%s/%s" % (ROOT, folder), "%s/%s" % (place, folder))
    return place


def all_mutants(original, seed):
    """Every place of every source once, in the order of the seed; of its mutants, one."""
    choice = random.Random(seed)
    places = collections.defaultdict(list)
    for pattern in ("src/*.h", "src/*/*.h", "src/*/*.c"):
        for path in sorted(glob.glob("%s/%s" % (original, pattern))):
            name = os.path.relpath(path, original)
            for mutant in operators.mutants_of(name, text_of(original, name)):
                places[name, mutant.line].append(mutant)
    keys = sorted(places)
    choice.shuffle(keys)
    return [choice.choice(places[key]) for key in keys]


def entries_of(report):
    with open(report) as file:
        return [json.loads(line) for line in file]


def mutant_in(entry):
    return {key: entry[key] for key in operators.Mutant._fields}


def survivors_of(original, report):
    mutants = []
    for entry in entries_of(report):
        mutant = operators.Mutant(**mutant_in(entry))
        lines = text_of(original, mutant.path).split("\n")
        at = [k for k, line in enumerate(lines, 1) if line == mutant.before]
        if entry["end"] == "survived" and at:
            nearest = min(at, key=lambda k: abs(k - mutant.line))
            mutants.append(mutant._replace(line=nearest))
    return mutants


def hunt(mutants, count, trees, experience, log, ends):
    """Verdicts until `count` of them say something of the tests; `ends` counts them."""
    free = queue.Queue()
    for tree in trees:
        free.put(tree)

    def one(mutant):
        if sum(ends.values()) - ends["stillborn"] - ends["same code"] >= count:
            return
        tree = free.get()
        begin = time.time()
        end, test = verdict_of(tree, mutant, experience)
        free.put(tree)
        ends[end] += 1
        entry = dict(mutant._asdict(), end=end, test=test, seconds=round(time.time() - begin, 1))
        log.write(json.dumps(entry) + "\n")
        log.flush()
        if end == "survived":
            print("survived: %s:%d (%s)\n-%s\n+%s" % (mutant.path, mutant.line, mutant.kind,
                                                       mutant.before, mutant.after), flush=True)

    with concurrent.futures.ThreadPoolExecutor(len(trees)) as pool:
        list(pool.map(one, mutants))
    return ends


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("out")
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--resume", action="store_true")
    options = parser.parse_args()
    options.build, options.out = os.path.abspath(options.build), os.path.abspath(options.out)
    report = options.out + "/report.jsonl"
    original = copied_sources(options.out + "/source")
    mutants = (survivors_of(original, report) if options.again
               else all_mutants(original, options.seed))
    if options.again:
        options.count, report = len(mutants), options.out + "/again.jsonl"
    done = entries_of(report) if options.resume else []
    mutants = [mutant for mutant in mutants if mutant._asdict() not in map(mutant_in, done)]
    trees = [Tree(original, "%s/%d" % (options.out, k)) for k in range(options.jobs)]
    experience = Experience(tests_of(options.build), trees[0].baseline.folder,
                            options.out + "/seconds.json", options.resume)
    for entry in done:
        if entry["test"]:
            experience.learn(entry["path"], entry["test"], True)
    with open(report, "a" if options.resume else "w") as log:
        ends = hunt(mutants, options.count, trees, experience, log,
                    collections.Counter(entry["end"] for entry in done))
    valid = sum(ends.values()) - ends["stillborn"] - ends["same code"]
    print("seed %d, %d mutants: %d killed, %d survived (%s)" % (
        options.seed, valid, valid - ends["survived"], ends["survived"],
        ", ".join("%d %s" % (ends[end], end) for end in sorted(ends))))
    return 0 if ends["survived"] <= valid / 10 else 1


if __name__ == "__main__":
    sys.exit(main())
