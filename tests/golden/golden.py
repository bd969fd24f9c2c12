#!/usr/bin/env python3
"""Holds the program to what it achieves on recordings and in simulated worlds.

bounds.csv says what is run and how large its errors may become, hashes.csv which bits come out of it: the former is for
every change, the latter for changes that must not alter a bit. CONTRIBUTING.md says when either may be recorded anew.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import os
import platform
import re
import resource
import shlex
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from tables import Bound, Hash, Run, read_bounds, read_hashes, write_bounds, write_hashes

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent

INSTRUCTION_SET = "avx2"  # of all runs, where the processor has it: bits depend on it
SKIPPED = 77  # exit status that ctest takes for "not run here"

LEAST_SLACK = 0.02  # of a value, in its bound
SIGMAS = 3.0  # at least, of what a filter makes of one log with these seeds
SEEDS_FOR_SPREAD = range(1, 11)

# Where metrics.json has a metric.
METRICS = {
    "position_rmse_m": ("truth", "position_rmse_m"),
    "position_rmse_aligned_m": ("truth", "position_rmse_aligned_m"),
    "landmark_rmse_m": ("truth", "landmark_rmse_m"),
    "landmark_rmse_self_m": ("truth", "landmark_rmse_self_m"),
    "nees_median": ("truth", "nees_median"),
    "nis_per_dof": ("nis_per_dof",),
    "landmarks": ("landmarks",),
    "landmarks_spurious": ("truth", "landmarks_spurious"),
    "smoothed.position_rmse_m": ("smoothed", "truth", "position_rmse_m"),
    "smoothed.position_rmse_aligned_m": ("smoothed", "truth", "position_rmse_aligned_m"),
    "smoothed.landmark_rmse_m": ("smoothed", "truth", "landmark_rmse_m"),
    "smoothed.nees_median": ("smoothed", "truth", "nees_median"),
}

Figures = dict[str, float]


class Skip(Exception):
    """What a run needs is not on this machine."""


class Failure(Exception):
    """The program is worse than it was, gives other bits, or does not run."""


@dataclass
class Place:
    """What there is on this machine."""

    program: Path
    data: Path
    results: Path
    tables: Path
    pinned: bool = field(init=False)

    def __post_init__(self) -> None:
        probe = subprocess.run([self.program, "--version"], env=self.environment(True), capture_output=True)
        self.pinned = probe.returncode == 0

    def environment(self, pinned: bool) -> dict[str, str]:
        return os.environ | ({"WAYMARK_INSTRUCTION_SET": INSTRUCTION_SET} if pinned else {})

    def find(self, name: str) -> str:
        """A simulated world, or the recording of that name."""
        if not name.startswith("sim:") and not (self.data / name).exists():
            raise Skip(f"no recording {self.data / name}; set WAYMARK_DATA_DIR to where it lies")
        return name if name.startswith("sim:") else str(self.data / name)

    def toolchain(self) -> str:
        """What bits depend on besides sources and instructions: the compiler, and the C library for its sine."""
        compilers = re.findall(rb"GCC: \([^)\0]*\) [\d.]+|clang version [\d.]+", self.program.read_bytes())
        return ", ".join([*sorted({c.decode() for c in compilers}), " ".join(platform.libc_ver()), platform.machine()])


def command(run: Run, seed: int, place: Place) -> list[str]:
    what = ["--filter", run.filter, "--observe", run.observe, "--associate", run.associate, *shlex.split(run.options)]
    return [str(place.program), "run", place.find(run.input), *what, "--seed", str(seed), "--quiet"]


def figures_of(folder: Path) -> Figures:
    """The metrics that this run has."""
    metrics = json.loads((folder / "metrics.json").read_text())
    figures = {}
    for name, path in METRICS.items():
        value = metrics
        for key in path:
            value = value.get(key) if value else None
        if value is not None and not math.isnan(value):
            figures[name] = float(value)
    return figures


def hash_of(folder: Path) -> Hash:
    return Hash(*(hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in ("trajectory.tum", "map.csv")))


def execute(run: Run, seed: int, place: Place, *more: str) -> tuple[Figures, Hash]:
    arguments = [*command(run, seed, place), *more]
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [*arguments, "--output", folder], env=place.environment(place.pinned), capture_output=True, text=True
        )
        if "this build of Waymark lacks" in done.stderr:
            raise Skip(done.stderr.strip())
        if done.returncode != 0:
            raise Failure(f"{shlex.join(arguments)}: status {done.returncode}: {done.stderr.strip()}")
        return figures_of(Path(folder)), hash_of(Path(folder))


def mean(figures: list[Figures]) -> Figures:
    """Of the metrics that every run has."""
    common = set.intersection(*(set(each) for each in figures))
    return {name: statistics.fmean(each[name] for each in figures) for name in METRICS if name in common}


def left_hashes(run: Run, place: Place) -> Path:
    return place.results / f"{run.name}.json"


def leave_hashes(run: Run, hashes: dict[int, Hash], place: Place) -> None:
    """For check_hashes, so that nothing is run twice."""
    place.results.mkdir(parents=True, exist_ok=True)
    left_hashes(run, place).write_text(json.dumps({seed: [h.trajectory, h.map] for seed, h in hashes.items()}))


def check_bounds(run: Run, place: Place) -> None:
    left_hashes(run, place).unlink(missing_ok=True)
    done = {seed: execute(run, seed, place) for seed in run.seeds}
    leave_hashes(run, {seed: found for seed, (_, found) in done.items()}, place)
    values = mean([figures for figures, _ in done.values()])
    worse = [complaint for bound in run.bounds if (complaint := bound.complaint(values.get(bound.metric)))]
    for bound in run.bounds:
        print(f"  {bound.metric:<34}{values.get(bound.metric, math.nan):>12.6g}   {bound.text()}")
    if worse or not run.bounds:
        again = shlex.join(command(run, run.seeds[0], place))
        raise Failure("\n  ".join([f"{run.name}: {again}", *(worse or ["no bounds were recorded"])]))


def check_hashes(run: Run, place: Place) -> None:
    """Of what check_bounds left."""
    if not place.pinned:
        raise Skip(f"this processor has no {INSTRUCTION_SET}")
    expected, toolchain = read_hashes(place.tables)
    if toolchain != place.toolchain():
        raise Skip(f"hashes.csv is of {toolchain}, this program of {place.toolchain()}")
    left = left_hashes(run, place)
    if not left.exists():
        raise Skip("its bounds were not checked, which leaves the hashes")
    found = {int(seed): Hash(*both) for seed, both in json.loads(left.read_text()).items()}
    complaints = [
        f"seed {seed}: {found[seed].difference(expected.get((run.name, seed)))}"
        for seed in run.seeds
        if found[seed] != expected.get((run.name, seed))
    ]
    if complaints:
        raise Failure("\n  ".join([f"{run.name}: other bits than recorded", *complaints]))


def simulated(run: Run, seed: int, place: Place, folder: str) -> Run:
    """The same run on a world that stands still while the seed of the filter varies."""
    scenario = run.input.removeprefix("sim:")
    made = [place.program, "sim", scenario, "--seed", str(seed), "--quiet", "--output", folder]
    subprocess.run(made, env=place.environment(place.pinned), check=True)
    return replace(run, input=folder)


def spreads(run: Run, place: Place) -> list[list[Figures]]:
    """What the filter makes of each log with many seeds."""
    if not run.is_random:
        return []
    if not run.input.startswith("sim:"):
        return [[execute(run, seed, place)[0] for seed in SEEDS_FOR_SPREAD]]
    by_world = []
    for world in run.seeds:
        with tempfile.TemporaryDirectory() as folder:
            on_disk = simulated(run, world, place, folder)
            by_world.append([execute(on_disk, seed, place)[0] for seed in SEEDS_FOR_SPREAD])
    return by_world


def sigma_of(metric: str, spread: list[list[Figures]]) -> float:
    samples = [[f[metric] for f in figures if metric in f] for figures in spread]
    variances = [statistics.variance(sample) for sample in samples if len(sample) > 1]
    return math.sqrt(statistics.fmean(variances)) if variances else 0.0


def bounds_from(values: Figures, spread: list[list[Figures]]) -> list[Bound]:
    return [
        Bound.around(metric, value, max(SIGMAS * sigma_of(metric, spread), LEAST_SLACK * value))
        for metric, value in values.items()
    ]


def in_order(hashes: dict[tuple[str, int], Hash], runs: list[Run]) -> dict[tuple[str, int], Hash]:
    """As the runs stand in bounds.csv, without those that are no longer there."""
    return {(run.name, seed): hashes[run.name, seed] for run in runs for seed in run.seeds if (run.name, seed) in hashes}


def record(names: list[str], place: Place) -> None:
    if not place.pinned:
        raise Skip(f"this processor has no {INSTRUCTION_SET}, with which hashes are recorded")
    runs = read_bounds(place.tables)
    hashes, toolchain = read_hashes(place.tables)
    if not names:
        hashes = {}
    elif toolchain != place.toolchain():
        raise Failure(f"hashes.csv is of {toolchain}, this program of {place.toolchain()}: record all runs")
    for run in chosen(runs, names):
        done = {seed: execute(run, seed, place) for seed in run.seeds}
        run.bounds = bounds_from(mean([figures for figures, _ in done.values()]), spreads(run, place))
        hashes |= {(run.name, seed): found for seed, (_, found) in done.items()}
        write_bounds(place.tables, runs)
        write_hashes(place.tables, in_order(hashes, runs), place.toolchain())
        print(f"{run.name}: recorded", flush=True)


def check_stability(run: Run, place: Place, times: int) -> None:
    """The same bits from run to run, with one thread and with two, without the batch estimate that may come after."""
    expected, _ = read_hashes(place.tables)
    seed = run.seeds[0]
    live = replace(run, options=run.options.replace("--smooth", ""))
    for i in range(times):
        found = execute(live, seed, place, "--threads", str(1 + i % 2))[1]
        if found != expected.get((run.name, seed)):
            raise Failure(f"{run.name}: run {i + 1}: {found.difference(expected.get((run.name, seed)))}")


def chosen(runs: list[Run], names: list[str]) -> list[Run]:
    unknown = set(names) - {run.name for run in runs}
    if unknown:
        raise Failure(f"no run {', '.join(sorted(unknown))} in bounds.csv")
    return [run for run in runs if not names or run.name in names]


def check_each(runs: list[Run], check: Callable[[Run], None]) -> int:
    """0: all hold; otherwise the worst that came up."""
    status = 0
    for run in runs:
        try:
            check(run)
            print(f"{run.name}: holds", flush=True)
        except Skip as reason:
            print(f"{run.name}: skipped: {reason}", flush=True)
            status = status or SKIPPED
        except Failure as reason:
            print(f"FAILED {reason}", flush=True)
            status = 1
    return status


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", choices=["bounds", "hashes", "stability", "record"])
    parser.add_argument("runs", nargs="*", help="names in bounds.csv; all, where none is given")
    parser.add_argument("--program", type=Path, default=ROOT / "build/ci/waymark")
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared/data", help="where recordings lie")
    parser.add_argument("--tables", type=Path, default=HERE, help="where bounds.csv and hashes.csv lie")
    parser.add_argument("--results", type=Path, default=ROOT / "build/ci/tests/golden", help="what bounds leave for hashes")
    parser.add_argument("--times", type=int, default=10, help="runs of each for stability, with 1 and 2 threads in turn")
    return parser.parse_args()


def main() -> int:
    asked = parse()
    if not asked.program.exists():
        raise Failure(f"no program {asked.program}")
    place = Place(asked.program, Path(os.environ.get("WAYMARK_DATA_DIR", asked.data)), asked.results, asked.tables)
    status = 0
    if asked.task == "record":
        record(asked.runs, place)
    else:
        check = {
            "bounds": lambda run: check_bounds(run, place),
            "hashes": lambda run: check_hashes(run, place),
            "stability": lambda run: check_stability(run, place, asked.times),
        }
        status = check_each(chosen(read_bounds(place.tables), asked.runs), check[asked.task])
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"{usage.ru_utime + usage.ru_stime:.1f} s of CPU time")
    return status


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Failure, Skip) as problem:
        sys.exit(f"golden: {problem}")
