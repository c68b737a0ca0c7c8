# SPDX-License-Identifier: MIT
"""Shows what sphgrad-bench has measured. On standard input come lines to print and, behind a mark, what
report.h lists: tables that are printed, written as CSV and as JSON in Google Benchmark's format, and drawn."""
import datetime
import importlib.util
import json
import math
import os
import platform
import statistics
import subprocess
import sys

MARK, COMMA = "\036", "\037"
BENCH = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def in_files(key):
    """A name with a dot in front is between a command and its COMMAND.py."""
    return key is not None and not key.startswith(".")


class Time:
    """Samples in ms, and what makes one of the unit of the column."""

    def __init__(self, numbers):
        self.factor, self.wall, self.cpu = numbers[0], numbers[1::2], numbers[2::2]

    def spread(self):
        return tuple(self.factor * f(self.wall) for f in (statistics.median, min, max))


def cell(text):
    kind, rest = text[0], text[1:]
    if kind == "s":
        return Time([float(word) for word in rest.split()])
    return {"-": lambda: None, "t": lambda: rest, "n": lambda: float(rest), "c": lambda: int(float(rest))}[kind]()


def grouped(number):
    return f"{number:,}".replace(",", " ")


def milliseconds(ms):
    """Four digits are more than two runs agree on."""
    return f"{ms:.{3 if ms < 1 else 2 if ms < 100 else int(ms < 1000)}f}"


class Table:
    """Columns are head, key, format, unit; cells None, a text, a number or a Time."""

    def __init__(self, name="", heads=()):
        """heads: of a table that is only shown, with the formats of the columns."""
        self.name, self.rows, self.sections = name, [], {}
        self.columns = [(head, None, form, None) for head, form in heads]

    def keyed(self):
        """The rows, each a dictionary of what files would have."""
        keys = [key for _, key, _, _ in self.columns]
        return [{key: value for key, value in zip(keys, row) if key is not None} for row in self.rows]

    def kind(self, c):
        """Of the first cell that holds something."""
        return next((type(row[c]) for row in self.rows if row[c] is not None), type(None))

    def text(self, value, c):
        form = self.columns[c][2]
        if isinstance(value, Time):
            median, least, most = value.spread()
            return form % (median, least, most) if form else \
                f"{milliseconds(median)} ({milliseconds(least)}-{milliseconds(most)})"
        if isinstance(value, float):
            return (form or "%.4g") % value
        return "-" if value is None else grouped(value) if isinstance(value, int) else value

    def print(self):
        shown = [c for c, column in enumerate(self.columns) if column[0] is not None]
        heads = [self.columns[c][0] for c in shown]
        texts = [[self.text(row[c], c) for c in shown] for row in self.rows]
        titles = [heads] + [[title] + heads[1:] for title in self.sections.values() if title]
        widths = [max(map(len, column)) for column in zip(*titles, *texts)] if shown else []
        left = [self.kind(c) in (str, type(None)) for c in shown]

        def line(words):
            print("".join("  " + (word.ljust(width) if is_left else word.rjust(width))
                          for word, width, is_left in zip(words, widths, left)).rstrip())

        for r, words in enumerate(texts):
            if r in self.sections or r == 0:
                print()
            if r in self.sections and self.sections[r] is not None:
                line([self.sections[r]] + heads[1:])
            elif r == 0:
                line(heads)
            line(words)

    def turned(self):
        """Rows as columns. A line without any value is left out."""
        for c, (head, key, _, _) in enumerate(self.columns):
            values = [row[c] for row in self.rows]
            times = self.kind(c) is Time
            if head == "" and key is None:
                print()
            elif head is not None and self.kind(c) is not type(None):
                print(f"  {head:20}" + "".join(
                    f"{milliseconds(v.spread()[0]) if isinstance(v, Time) else self.text(v, c):>13}" for v in values))
            if head is not None and times:
                print(f"  {'  min-max':20}" + "".join(
                    f"{'-'.join(map(milliseconds, v.spread()[1:])) if v else '':>13}" for v in values))

    def csv(self, path, first_line):
        names, texts = [], []
        for c, (_, key, _, unit) in enumerate(self.columns):
            if not in_files(key):
                continue
            name = "_".join(filter(None, (key, unit or "ms")))
            times = self.kind(c) is Time
            names += [name, name + "_least", name + "_most"] if times else [key]
            for r, row in enumerate(self.rows):
                value = row[c]
                numbers = (value.spread() if value else ("", "", "")) if times else (value,)
                texts += [[]] if len(texts) == r else []
                texts[r] += ["" if v is None else f"{v:.9g}" if isinstance(v, float) else
                             f'"{v}"' if "," in str(v) else str(v) for v in numbers]
        with open(path, "w", encoding="utf-8") as file:
            print(first_line, *(",".join(line) for line in [names] + texts), sep="\n", file=file)

    def benchmarks(self, threads, families):
        """Entries of the JSON: all repetitions, then, if there are several, what they come to."""
        for row in self.rows:
            keyed = [(key, value, unit) for (_, key, _, unit), value in zip(self.columns, row) if in_files(key)]
            texts = [value for _, value, _ in keyed if isinstance(value, str)]
            counters = {key: value if math.isfinite(value) else None
                        for key, value, _ in keyed if isinstance(value, (int, float))}
            for key, time, unit in keyed:
                if isinstance(time, Time):
                    name = "/".join([self.name] + texts + ([key] if key else []))
                    own = {unit: time.factor * statistics.median(time.wall)} if unit else {}
                    yield from entries(name, time, next(families), threads, counters | own)


def entries(name, time, family, threads, counters):
    def entry(ending, kind, wall, cpu, more):
        return {"name": name + ending, "family_index": family, "per_family_instance_index": 0, "run_name": name,
                "run_type": kind, "threads": threads, "repetitions": len(time.wall), "real_time": wall,
                "cpu_time": cpu, "time_unit": "ms"} | counters | more

    for k, (wall, cpu) in enumerate(zip(time.wall, time.cpu)):
        yield entry("", "iteration", wall, cpu, {"repetition_index": k, "iterations": 1})
    if len(time.wall) > 1:
        for kind, come_to in (("mean", statistics.mean), ("median", statistics.median), ("stddev", statistics.stdev),
                              ("cv", lambda t: statistics.stdev(t) / statistics.mean(t) if any(t) else 0.0),
                              ("min", min), ("max", max)):
            yield entry("_" + kind, "aggregate", come_to(time.wall), come_to(time.cpu), {
                "iterations": len(time.wall), "aggregate_name": kind,
                "aggregate_unit": "percentage" if kind == "cv" else "time"})


def cpu_model():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            return next(line.split(":", 1)[1].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        return "unknown processor"


class Report:
    """A method for each word of report.h. Functions of COMMAND.py get the report and their words."""

    def __init__(self):
        now = datetime.datetime.now().astimezone().isoformat(timespec="seconds")
        self.context = {"date": now, "host_name": platform.node(), "executable": "sphgrad-bench",
                        "cpu_model": cpu_model()}
        self.table_now, self.benchmarks, self.failed, self.all_drawn = Table(), [], False, True
        self.families = iter(range(1 << 31))

    def open(self, command, json_path):
        self.json_path = json_path
        path = os.path.join(BENCH, command, command + ".py")
        if os.path.exists(path):
            spec = importlib.util.spec_from_file_location(command, path)
            self.own = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(self.own)

    def text(self, name, value):
        self.context[name] = value

    def number(self, name, value):
        self.context[name] = int(float(value)) if float(value).is_integer() else float(value)

    def machine(self):
        c = self.context
        print(f"machine    {c['cpu_model']}, {c['num_cpus']} processor{'s' * (c['num_cpus'] > 1)}; "
              f"{c['threads']} thread{'s' * (c['threads'] > 1)}, {c['isa']}")
        print(f"program    sphgrad {c['library_version']}, {c['compiler']}, {c['library_build_type']}, {c['date']}")

    def table(self, name):
        self.table_now = Table(name)

    def column(self, *names):
        self.table_now.columns.append([None if name == MARK else name for name in names])

    def row(self, *cells):
        self.table_now.rows.append([cell(text) for text in cells])

    def section(self, title=None):
        self.table_now.sections[len(self.table_now.rows)] = title

    def print(self):
        self.table_now.print()

    def turned(self):
        self.table_now.turned()

    def times(self):
        self.benchmarks += self.table_now.benchmarks(self.context["threads"], self.families)

    def csv(self, folder, name):
        self.table_now.csv(os.path.join(folder, name), f"# {self.context['cpu_model']}, {self.context['date']}")

    def show(self, function, *words):
        getattr(self.own, function)(self, *words)

    def draw(self, folder, script, parts, *assignments):
        with open(os.path.join(folder, script), "w", encoding="utf-8") as file:
            print(f'machine = "{self.context["cpu_model"]}"', *assignments, sep="\n", file=file)
            for part in parts.split():
                with open(os.path.join(BENCH, part), encoding="utf-8") as lines:
                    file.write(lines.read())
        if not self.all_drawn:
            return
        sys.stdout.flush()
        try:
            self.all_drawn = subprocess.run(["gnuplot", script], cwd=folder, check=False).returncode == 0
        except OSError:
            self.all_drawn = False
            print("no gnuplot here, so no pictures; the tables are written", file=sys.stderr)
        else:
            if not self.all_drawn:
                print(f"gnuplot failed on {folder}/{script}", file=sys.stderr)

    def drawn(self, folder, tables, pictures=""):
        print(f"\nwritten to {folder}: {tables}{pictures if self.all_drawn else ''}")

    def close(self):
        if self.json_path:
            context = {name: value for name, value in self.context.items() if in_files(name)}
            with open(self.json_path, "w", encoding="utf-8") as file:
                print(json.dumps({"context": context, "benchmarks": self.benchmarks}, indent=1), file=file)


def main():
    report = Report()
    for line in sys.stdin:
        if line.startswith(MARK):
            word, *arguments = line[1:].rstrip("\n").split(COMMA)
            getattr(report, word)(*arguments)
        else:
            print(line, end="")
    return int(report.failed)


try:
    sys.exit(main())
except OSError as problem:
    sys.exit(f"sphgrad-bench: cannot write {problem.filename}: {problem.strerror}")
