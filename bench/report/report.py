# SPDX-License-Identifier: MIT
"""Shows what sphgrad-bench has measured: lines of words on standard input (report.h) become a Report, which COMMAND.py
prints, draws and writes as CSV, and which is written as JSON in Google Benchmark's format here."""
import contextlib
import datetime
import importlib.util
import json
import math
import os
import platform
import signal
import statistics
import subprocess
import sys

COMMA = "\037"
KERNELS = {"cubic": "cubic spline", "quintic": "quintic spline", "wendland-c2": "Wendland C2", "wendland-c4": "Wendland C4",
           "wendland-c6": "Wendland C6"}  # in sentences
BROKEN_PROMISES = 3  # the exit status where all is shown, but not as it should be
BENCH = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


class Time:
    """Samples in ms, and what makes one of the unit."""

    def __init__(self, words):
        self.factor, self.unit, numbers = float(words[0]), words[1], [float(word) for word in words[2:]]
        self.wall, self.cpu = numbers[0::2], numbers[1::2]

    def median(self):
        return statistics.median(self.wall)

    def spread(self):
        """Median, least and most in the unit."""
        return tuple(self.factor * f(self.wall) for f in (statistics.median, min, max))


def cell(text):
    kind, rest = text[0], text[1:]
    return (None if kind == "-" else rest if kind == "t" else float(rest) if kind == "n" else
            int(float(rest)) if kind == "c" else Time(rest.split()))


def grouped(number):
    return f"{number:,}".replace(",", " ")


def plural(count, word):
    return f"{count} {word}{'s' * (count > 1)}"


def milliseconds(ms):
    """Four digits are more than two runs agree on."""
    return f"{ms:.{3 if ms < 1 else 2 if ms < 100 else int(ms < 1000)}f}"


def text_of(value, form=None):
    """form: what % takes, of a time for three: median, least and most."""
    if isinstance(value, Time):
        return form % value.spread() if form else "{} ({}-{})".format(*map(milliseconds, value.spread()))
    if isinstance(value, float):
        return (form or "%.4g") % value
    return "-" if value is None else grouped(value) if isinstance(value, int) else value


def show(rows, columns, sections=None):
    """Prints a table. Columns are head, name of the cell, format. Before the rows that `sections` names the heads
    stand again, the first of which reads the title there; None: a blank line."""
    sections = sections or {}
    heads = [column[0] for column in columns]
    texts = [[text_of(row[name], *form) for _, name, *form in columns] for row in rows]
    first_heads = [heads[0]] + [title for title in sections.values() if title]
    widths = [max(map(len, column)) for column in zip(heads, *texts)]
    widths[0] = max([widths[0], *map(len, first_heads)])
    left = [all(isinstance(row[name], (str, type(None))) for row in rows) for _, name, *_ in columns]

    def line(words):
        print("".join("  " + (word.ljust(width) if is_left else word.rjust(width))
                      for word, width, is_left in zip(words, widths, left)).rstrip())

    for number, words in enumerate(texts):
        title = sections.get(number)
        if number == 0 or number in sections:
            print()
        if title or number == 0:
            line([title or heads[0]] + heads[1:])
        line(words)


def where(rows, changes):
    """The numbers of the rows from which on `changes` is another."""
    return [n for n, row in enumerate(rows) if n == 0 or changes(row) != changes(rows[n - 1])]


def names_in_files(rows):
    return [name for name in rows[0] if not name.startswith(".")]


@contextlib.contextmanager
def open_to_write(path):
    """Ends the program with one line where that fails."""
    try:
        with open(path, "w", encoding="utf-8") as file:
            yield file
    except OSError as problem:
        sys.exit(f"sphgrad-bench: cannot write {path}: {problem.strerror}")


class Report:
    """context, and tables: names, and rows that are dictionaries of texts, numbers, Times and None."""

    def __init__(self):
        self.context = {"date": datetime.datetime.now().astimezone().isoformat(timespec="seconds"),
                        "host_name": platform.node(), "executable": "sphgrad-bench", "cpu_model": "unknown processor"}
        self.tables, self.all_drawn, self.failed = [], True, False
        if os.path.exists("/proc/cpuinfo"):
            with open("/proc/cpuinfo", encoding="utf-8") as file:
                models = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
            self.context["cpu_model"] = (models + ["unknown processor"])[0]

    def rows(self, table):
        return next(rows for name, rows in self.tables if name == table)

    # ---- Printing --------------------------------------------------------------------------------------------

    def print_machine(self):
        c = self.context
        print(f"machine    {c['cpu_model']}, {plural(c['num_cpus'], 'processor')}; {plural(c['threads'], 'thread')}, "
              f"{c['isa']}\nprogram    sphgrad {c['library_version']}, {c['compiler']}, {c['library_build_type']}, "
              f"{c['date']}")

    def print_lattice(self, more):
        c = self.context
        print(f"particles  {grouped(c['particles'])}, lattice jittered by {c['jitter']:g} spacings, "
              f"H = {c['support_spacings']:g} spacings, {c['pairs_per_particle']:.2f} pairs a particle; {more}")
        self.print_machine()

    def print_if_busy(self, time):
        """One line if others kept the processors from the program while these samples were taken."""
        had = statistics.median(time.cpu) / (time.median() * min(self.context["num_cpus"], self.context["threads"]))
        if had < 0.8:
            print(f"BUSY       others ran: the program had {100 * had:.0f} % of its processors' time, and the times "
                  "are too long")

    # ---- Files -----------------------------------------------------------------------------------------------

    def write_csv(self, rows, name):
        """A time has three columns: NAME_UNIT, and that with _least and _most."""
        times = {key: next((row[key].unit for row in rows if isinstance(row[key], Time)), None) for key in rows[0]}
        keys = names_in_files(rows)

        def texts(row, key):
            numbers = (row[key].spread() if row[key] else ("", "", "")) if times[key] else (row[key],)
            return ["" if v is None else f"{v:.9g}" if isinstance(v, float) else f'"{v}"' if "," in str(v) else str(v)
                    for v in numbers]

        with open_to_write(os.path.join(self.context[".output"], name)) as file:
            print(f"# {self.context['cpu_model']}, {self.context['date']}", file=file)
            print(",".join("_".join(filter(None, (key, times[key], end))) for key in keys
                           for end in (("", "least", "most") if times[key] else ("",))), file=file)
            for row in rows:
                print(",".join(text for key in keys for text in texts(row, key)), file=file)

    def draw(self, script, parts, **assignments):
        """The script is made of assignments and files of bench, which read the CSV by the names of its columns."""
        folder = self.context[".output"]
        with open_to_write(os.path.join(folder, script)) as file:
            for name, value in assignments.items():
                print(name, "=", value if isinstance(value, int) else '"%s"' % value, file=file)
            for part in parts:
                with open(os.path.join(BENCH, part), encoding="utf-8") as lines:
                    file.write(lines.read())
        sys.stdout.flush()
        if self.all_drawn:
            try:
                self.all_drawn = subprocess.run(["gnuplot", script], cwd=folder, check=False).returncode == 0
                if not self.all_drawn:
                    print(f"gnuplot failed on {folder}/{script}", file=sys.stderr)
            except OSError:
                self.all_drawn = False
                print("no gnuplot here, so no pictures; the tables are written", file=sys.stderr)

    def print_written(self, tables, pictures=""):
        print(f"\nwritten to {self.context['.output']}: {tables}{pictures if self.all_drawn else ''}")

    def benchmarks(self):
        family = -1
        for table, rows in self.tables:
            for row in rows:
                keyed = [(key, row[key]) for key in names_in_files(rows)]
                texts = [value for _, value in keyed if isinstance(value, str)]
                counters = {key: value if math.isfinite(value) else None
                            for key, value in keyed if isinstance(value, (int, float))}
                for key, time in keyed:
                    if isinstance(time, Time):
                        family += 1
                        own = {time.unit: time.spread()[0]} if time.unit != "ms" else {}
                        name = "/".join([table] + texts + ([key] if key else []))
                        yield from self.entries(name, time, {"family_index": family} | counters | own)

    def entries(self, name, time, more):
        """All repetitions, then, if there are several, what they come to."""
        def entry(ending, kind, wall, cpu, **own):
            return {"name": name + ending, "per_family_instance_index": 0, "run_name": name, "run_type": kind,
                    "threads": self.context["threads"], "repetitions": len(time.wall), "real_time": wall,
                    "cpu_time": cpu, "time_unit": "ms"} | more | own

        for k, (wall, cpu) in enumerate(zip(time.wall, time.cpu)):
            yield entry("", "iteration", wall, cpu, repetition_index=k, iterations=1)
        if len(time.wall) > 1:
            for kind, of in (("mean", statistics.mean), ("median", statistics.median), ("stddev", statistics.stdev),
                             ("cv", lambda t: statistics.stdev(t) / statistics.mean(t) if any(t) else 0.0),
                             ("min", min), ("max", max)):
                yield entry("_" + kind, "aggregate", of(time.wall), of(time.cpu), iterations=len(time.wall),
                            aggregate_name=kind, aggregate_unit="percentage" if kind == "cv" else "time")

    def write_json(self):
        context = {name: value for name, value in self.context.items() if not name.startswith(".")}
        with open_to_write(self.context[".json"]) as file:
            print(json.dumps({"context": context, "benchmarks": list(self.benchmarks())}, indent=1), file=file)


def read_report():
    """The report and its command; None where the program ended before the report did."""
    report, command = Report(), None
    for line in sys.stdin:
        word, *words = line.rstrip("\n").split(COMMA)
        if word == "open":
            command = words[0]
        elif word == "text":
            report.context[words[0]] = words[1]
        elif word == "number":
            value = float(words[1])
            report.context[words[0]] = int(value) if value.is_integer() else value
        elif word == "table":
            report.tables.append((words[0], []))
        elif word == "row":
            report.tables[-1][1].append(dict(zip(words[0::2], map(cell, words[1::2]))))
        else:
            return report, command
    return report, None


def main():
    report, command = read_report()
    if not command:
        return 1
    report.context[".kernel_title"] = KERNELS.get(report.context[".kernel"], report.context[".kernel"])
    spec = importlib.util.spec_from_file_location(command, os.path.join(BENCH, command, command + ".py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.report_of(report)
    if report.context[".json"]:
        report.write_json()
    return BROKEN_PROMISES if report.failed else 0


if __name__ == "__main__":
    sys.modules["report"] = sys.modules["__main__"]
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # nobody reads on, as with `| head`
    sys.exit(main())
