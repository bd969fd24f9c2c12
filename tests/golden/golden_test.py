#!/usr/bin/env python3
"""golden.py with a program that gives the figures which a test wants."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

GOLDEN = Path(__file__).resolve().parent / "golden.py"

# Writes what FIGURES says, with SEED in it replaced; refuses an instruction set where REFUSE says so.
PROGRAM = """#!/bin/sh
[ "$1" = --version ] && { [ -z "$REFUSE" ] || [ -z "$WAYMARK_INSTRUCTION_SET" ]; exit; }
while [ $# -gt 1 ]; do
  case "$1" in --seed) seed=$2 ;; --output) folder=$2 ;; esac
  shift
done
echo "$FIGURES" | sed "s/SEED/$seed/" >"$folder/metrics.json"
echo "$PATH_BITS" >"$folder/trajectory.tum"
echo map >"$folder/map.csv"
"""

BOUNDS = """# What is run.
run, input, filter, observe, associate, seeds, metric, value, bound, options
one, sim:study, ekf, range-bearing, known, 1 2 3, position_rmse_m, 9, <= 9, --smooth
two, mylog, fastslam, range, known, 1 2 3
"""
HASHES = """# Bits.
# Toolchain: none
run, seed, trajectory, map
"""


def figures(rmse: object = 1, landmarks: object = 15) -> str:
    return f'{{"landmarks": {landmarks}, "truth": {{"position_rmse_m": {rmse}}}}}'


class Golden(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = Path(self.folder.name)
        (self.path / "mylog").mkdir()
        (self.path / "program").write_text(PROGRAM)
        (self.path / "program").chmod(0o755)
        (self.path / "bounds.csv").write_text(BOUNDS)
        (self.path / "hashes.csv").write_text(HASHES)

    def run_golden(self, *arguments: str, status: int = 0, **environment: str) -> str:
        places = [f"--{name}={self.path / name}" for name in ("program", "results")]
        done = subprocess.run(
            [sys.executable, GOLDEN, *arguments, *places, f"--tables={self.path}", f"--data={self.path}"],
            env=os.environ | {"FIGURES": figures(), "WAYMARK_DATA_DIR": str(self.path)} | environment,
            capture_output=True,
            text=True,
        )
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def bounds(self) -> str:
        return re.sub(r",\s*", ", ", (self.path / "bounds.csv").read_text())

    def test_what_was_recorded_holds(self) -> None:
        self.run_golden("record")
        self.run_golden("bounds")
        self.run_golden("hashes")
        self.run_golden("stability", "--times", "2")

    def test_ekf_may_fall_off_by_two_percent(self) -> None:
        self.run_golden("record", FIGURES=figures(2.0, 15))
        self.assertIn("position_rmse_m, 2, <= 2.04", self.bounds())
        self.assertIn("landmarks, 15, >= 14.7", self.bounds())
        self.run_golden("bounds", "one", FIGURES=figures(2.03, 15))
        out = self.run_golden("bounds", "one", FIGURES=figures(2.05, 15), status=1)
        self.assertIn("position_rmse_m is 2.05, must be <= 2.04; it was 2", out)
        self.assertIn("landmarks is 14", self.run_golden("bounds", "one", FIGURES=figures(2, 14), status=1))

    def test_fastslam_may_fall_off_by_three_deviations_of_ten_seeds(self) -> None:
        self.run_golden("record", FIGURES=figures("1SEED"))  # 11 to 19 and 110
        self.assertIn("position_rmse_m, 12, <= 102.457", self.bounds())
        self.run_golden("bounds", "two", FIGURES=figures(102))
        self.run_golden("bounds", "two", FIGURES=figures(103), status=1)

    def test_what_is_missing_fails(self) -> None:
        self.run_golden("record")
        for nothing in ("null", "NaN"):
            out = self.run_golden("bounds", "one", FIGURES=figures(nothing), status=1)
            self.assertIn("position_rmse_m is missing", out)
        self.assertIn("status", self.run_golden("bounds", "one", FIGURES=figures(), PATH="/nowhere", status=1))
        self.assertIn("no run three", self.run_golden("bounds", "three", status=1))

    def test_other_bits_fail_although_bounds_hold(self) -> None:
        self.run_golden("record")
        self.run_golden("bounds", PATH_BITS="changed")
        self.assertIn("seed 1: trajectory differ", self.run_golden("hashes", PATH_BITS="changed", status=1))

    def test_record_of_one_run_leaves_the_others(self) -> None:
        self.run_golden("record")
        self.run_golden("record", "two", FIGURES=figures(7), PATH_BITS="changed")
        self.run_golden("bounds", "one")
        self.run_golden("hashes", "one")
        self.run_golden("bounds", "two", FIGURES=figures(7), PATH_BITS="changed")
        self.run_golden("hashes", "two")
        self.assertTrue((self.path / "bounds.csv").read_text().startswith("# What is run.\n"))

    def test_missing_recording_is_skipped_by_name(self) -> None:
        self.run_golden("record")
        self.run_golden("bounds")
        (self.path / "mylog").rmdir()
        self.assertRegex(self.run_golden("bounds", "two", status=77), "two: skipped: no recording .*mylog")
        self.assertIn("two: skipped: its bounds", self.run_golden("hashes", "two", status=77))

    def test_processor_without_the_instruction_set_skips_hashes_but_not_bounds(self) -> None:
        self.run_golden("record")
        self.run_golden("bounds", REFUSE="1")
        self.assertIn("one: skipped: this processor", self.run_golden("hashes", REFUSE="1", status=77))
        self.run_golden("bounds", "one", FIGURES=figures(2), REFUSE="1", status=1)


if __name__ == "__main__":
    unittest.main()
