"""The two tables of the golden tests, as they lie beside this file."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass, field
from pathlib import Path

BOUND_COLUMNS = ["run", "input", "filter", "observe", "associate", "seeds", "metric", "value", "bound", "options"]
HASH_COLUMNS = ["run", "seed", "trajectory", "map"]
MORE_IS_BETTER = {"landmarks"}


@dataclass
class Bound:
    """What a metric was when recorded, and how far it may fall off."""

    metric: str
    value: float
    limit: float

    @classmethod
    def around(cls, metric: str, value: float, slack: float) -> Bound:
        return cls(metric, value, value - slack if metric in MORE_IS_BETTER else value + slack)

    @classmethod
    def parse(cls, metric: str, value: str, bound: str) -> Bound:
        return cls(metric, float(value), float(bound.split()[1]))

    def text(self) -> str:
        return f"{'>=' if self.metric in MORE_IS_BETTER else '<='} {self.limit:.6g}"

    def complaint(self, value: float | None) -> str | None:
        """What is wrong with a value that is missing, no number, or beyond the limit."""
        if value is None or math.isnan(value):
            return f"{self.metric} is missing; it was {self.value:.6g}"
        holds = value >= self.limit if self.metric in MORE_IS_BETTER else value <= self.limit
        return None if holds else f"{self.metric} is {value:.6g}, must be {self.text()}; it was {self.value:.6g}"


@dataclass
class Run:
    """A command line of waymark run for several seeds, and what the means of its figures are held to."""

    name: str
    input: str
    filter: str
    observe: str
    associate: str
    seeds: list[int]
    options: str
    bounds: list[Bound] = field(default_factory=list)

    @property
    def is_random(self) -> bool:
        return self.filter == "fastslam"

    @classmethod
    def parse(cls, row: dict[str, str]) -> Run:
        seeds = [int(seed) for seed in row["seeds"].split()]
        what = (row[column] for column in ("run", "input", "filter", "observe", "associate"))
        return cls(*what, seeds, row["options"])

    def lines(self) -> list[list[str]]:
        """Of the table: what is run stands in the first only, its name in all."""
        seeds = " ".join(map(str, self.seeds))
        what = [self.name, self.input, self.filter, self.observe, self.associate, seeds]
        bounds = [[bound.metric, f"{bound.value:.6g}", bound.text()] for bound in self.bounds] or [[""] * 3]
        first, *others = bounds
        return [[*what, *first, self.options]] + [[self.name, *[""] * (len(what) - 1), *bound, ""] for bound in others]


@dataclass(frozen=True)
class Hash:
    trajectory: str
    map: str

    def difference(self, expected: Hash | None) -> str:
        if expected is None:
            return "no hashes were recorded"
        names = [name for name in ("trajectory", "map") if getattr(self, name) != getattr(expected, name)]
        return f"{' and '.join(names)} differ from hashes.csv"


def comments(path: Path) -> list[str]:
    return [line for line in path.read_text().splitlines() if line.startswith("#")]


def rows(path: Path) -> list[dict[str, str]]:
    lines = [line for line in path.read_text().splitlines() if line and not line.startswith("#")]
    return [{k.strip(): (v or "").strip() for k, v in row.items()} for row in csv.DictReader(lines)]


def aligned(table: list[list[str]]) -> str:
    """Blanks after commas, so that columns stand below one another."""
    widths = [max(map(len, column)) + 1 for column in zip(*table)]
    lines = [" ".join(f"{cell},".ljust(width) for cell, width in zip(row, widths)).rstrip(" ,") for row in table]
    return "\n".join(lines) + "\n"


def write(path: Path, head: list[str], table: list[list[str]]) -> None:
    path.write_text("\n".join(head) + "\n" + aligned(table))


def read_bounds(folder: Path) -> list[Run]:
    runs: list[Run] = []
    for row in rows(folder / "bounds.csv"):
        if not runs or row["run"] != runs[-1].name:
            runs.append(Run.parse(row))
        if row["metric"]:
            runs[-1].bounds.append(Bound.parse(row["metric"], row["value"], row["bound"]))
    return runs


def write_bounds(folder: Path, runs: list[Run]) -> None:
    lines = [line for run in runs for line in run.lines()]
    write(folder / "bounds.csv", comments(folder / "bounds.csv"), [BOUND_COLUMNS, *lines])


def read_hashes(folder: Path) -> tuple[dict[tuple[str, int], Hash], str]:
    """By run and seed, and the toolchain of the program that they are of, from the last comment."""
    path = folder / "hashes.csv"
    if not path.exists():
        return {}, ""
    hashes = {(row["run"], int(row["seed"])): Hash(row["trajectory"], row["map"]) for row in rows(path)}
    return hashes, comments(path)[-1].removeprefix("# Toolchain: ")


def write_hashes(folder: Path, hashes: dict[tuple[str, int], Hash], toolchain: str) -> None:
    table = [HASH_COLUMNS] + [[name, str(seed), h.trajectory, h.map] for (name, seed), h in hashes.items()]
    head = [line for line in comments(folder / "hashes.csv") if not line.startswith("# Toolchain: ")]
    write(folder / "hashes.csv", [*head, f"# Toolchain: {toolchain}"], table)
