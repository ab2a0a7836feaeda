# SPDX-License-Identifier: BSD-3-Clause
"""What the benchmark scripts share: programs, models, child processes with a time limit, tables."""

import argparse
import glob
import json
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BUILD = os.environ.get("BUILD", os.path.join(ROOT, "build", "release"))
OUTPUT = os.environ.get("NURBS_BENCH_OUTPUT", os.path.join(ROOT, "build", "bench"))
OCCT_DATA = "/usr/share/opencascade/data"
MARK = "<!-- measured -->"
CRASHED = []  # Commands of child processes that a signal ended.
WITHOUT_FACES = {"asahi.brep", "edge.brep"}


def arguments(description, limit=300, **extra):
    """The options that every script has, and those in extra (name=(default, help))."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("folders", nargs="*", help="folders of more models")
    parser.add_argument("--only", default="", help="names that must contain one of these (a,b,...)")
    parser.add_argument(
        "--limit", type=float, default=limit, help="seconds a child process may take"
    )
    for name, (default, text) in extra.items():
        kind = {"action": "store_true"} if isinstance(default, bool) else {"type": type(default)}
        if not isinstance(default, bool):
            kind["default"] = default
        parser.add_argument("--" + name.replace("_", "-"), help=text, **kind)
    return parser.parse_args()


def models(folders=(), only=""):
    """CAD files of Debian's occt-misc, and those of other folders that it does not have."""
    found = []
    for pattern in ("occ/*.brep", "occ/*.rle", "step/*.step", "iges/*.iges"):
        found += glob.glob(os.path.join(OCCT_DATA, pattern))
    names = {os.path.basename(f) for f in found}
    for folder in folders:
        for file in glob.glob(os.path.join(folder, "*")):
            extension = file.rsplit(".", 1)[-1].lower()
            known = extension in ("step", "stp", "iges", "igs", "brep", "brp", "rle")
            if known and os.path.basename(file) not in names:
                found.append(file)
    wanted = [w for w in only.split(",") if w]
    found = [f for f in found if os.path.basename(f) not in WITHOUT_FACES]
    return sorted(
        (f for f in found if not wanted or any(w in os.path.basename(f) for w in wanted)),
        key=lambda f: (os.path.getsize(f), f),
    )


def program(name):
    path = os.path.join(BUILD, "bin", name)
    if not os.path.exists(path):
        sys.exit(f"{path} is missing: build the release preset first (./run bench does)")
    return path


def run(command, limit):
    """(standard output, None) of the command, or (it, why it failed)."""
    try:
        done = subprocess.run(command, capture_output=True, timeout=limit, text=True, check=False)
    except subprocess.TimeoutExpired:
        return "", f"no result in {limit:g} s"
    if done.returncode < 0:
        CRASHED.append(" ".join(command))
        return done.stdout, f"killed by {signal.Signals(-done.returncode).name}"
    if done.returncode > 0:
        message = done.stderr.strip().splitlines()
        return done.stdout, message[-1] if message else f"exit status {done.returncode}"
    return done.stdout, None


def run_json(command, limit):
    """The last JSON line that the command prints, or {"error": ...}."""
    output, problem = run(command, limit)
    for line in reversed(output.splitlines()):
        if problem is None and line.startswith("{"):
            return json.loads(line)
    return {"error": problem or "no result was printed"}


def scratch(suffix):
    handle, path = tempfile.mkstemp(suffix=suffix)
    os.close(handle)
    return path


def machine():
    """One line on what the figures were measured with."""
    cpu = "unknown processor"
    with open("/proc/cpuinfo", encoding="ascii", errors="replace") as info:
        for line in info:
            if line.startswith("model name"):
                cpu = line.split(":", 1)[1].strip()
                break
    load = os.getloadavg()[0]
    return f"{cpu}, {os.cpu_count()} processors, load {load:.1f} at the start"


def median(values):
    return statistics.median(values) if values else float("nan")


def show(value):
    """Numbers short, everything else as it is."""
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return f"{value:,}"
    if isinstance(value, float):
        if value != value:
            return "-"
        return f"{value:.0f}" if abs(value) >= 1000 else f"{value:.3g}"
    return str(value)


class Report:
    """Markdown, to the terminal as it comes and to build/bench/NAME.md at the end."""

    def __init__(self, name, title):
        self.name = name
        self.lines = []
        self.start = time.monotonic()
        self.text(f"# {title}")
        self.text(machine())

    def text(self, line):
        self.print([line, ""])

    def table(self, header, rows):
        cells = [[show(c) for c in row] for row in [header] + rows]
        width = [max(3, *(len(row[i]) for row in cells)) for i in range(len(header))]
        lines = []
        for row in cells:
            padded = [c.rjust(w) for c, w in zip(row, width)]
            lines.append("| " + " | ".join([row[0].ljust(width[0])] + padded[1:]) + " |")
        rule = ["-" * width[0]] + ["-" * (w - 1) + ":" for w in width[1:]]
        self.print([lines[0], "| " + " | ".join(rule) + " |", *lines[1:], ""])

    def print(self, lines):
        print("\n".join(lines), flush=True)
        self.lines += lines

    def paste(self, page):
        """Replaces everything behind the page's line MARK by what was printed, title left out."""
        with open(page, encoding="utf-8") as file:
            written = file.read().split(MARK)[0]
        with open(page, "w", encoding="utf-8") as file:
            file.write("\n".join([written + MARK, "", *self.lines[2:]]))

    def save(self):
        """Writes the file; the script's exit status: 1 if a child process crashed."""
        for command in CRASHED:
            self.text(f"- crashed: {command}")
        self.text(f"{time.monotonic() - self.start:.0f} s in all.")
        os.makedirs(OUTPUT, exist_ok=True)
        path = os.path.join(OUTPUT, self.name + ".md")
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(self.lines))
        print(f"written to {path}", flush=True)
        return 1 if CRASHED else 0
