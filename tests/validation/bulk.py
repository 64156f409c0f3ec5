#!/usr/bin/env python3
"""Bulk laws of granular matter, measured with the program itself: bulk.py TSUBU [TEST…]. docs/validation.md has the table.

Slow on purpose (some minutes each); scripts/test --slow runs all of them. Every test prints what it measured.
"""
import csv
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = ""
ROOT = pathlib.Path(__file__).resolve().parents[2]
THREADS = os.environ.get("TSUBU_VALIDATION_THREADS", "2")
PI = math.pi


def simulate(scene, folder, *options, frames=False):
    result = subprocess.run([PROGRAM, "run", str(scene), "-o", str(folder), *([] if frames else ["--no-frames"]), "--threads", THREADS, *options],
                            capture_output=True, text=True, timeout=3600)
    if result.returncode != 0:
        raise AssertionError(result.stderr)


def table(path):
    with open(path, newline="", encoding="utf-8") as file:
        return [{key: number(value) for key, value in row.items()} for row in csv.DictReader(file)]


def number(text):
    try:
        return float(text)
    except ValueError:
        return text


def line(xs, ys):
    """Slope, intercept, and root mean square deviation of the straight line through the points."""
    n, mx, my = len(xs), sum(xs) / len(xs), sum(ys) / len(ys)
    slope = sum((x - mx) * (y - my) for x, y in zip(xs, ys)) / sum((x - mx) ** 2 for x in xs)
    rest = [y - my - slope * (x - mx) for x, y in zip(xs, ys)]
    return slope, my - slope * mx, math.sqrt(sum(r * r for r in rest) / n)


def write_obj(path, faces):
    lines, count = [], 0
    for face in faces:
        lines += ["v %.9g %.9g %.9g" % point for point in face]
        lines.append("f " + " ".join(str(count + k + 1) for k in range(len(face))))
        count += len(face)
    path.write_text("\n".join(lines) + "\n")


def ring(radius, z, facets=96):
    return [(radius * math.cos(2 * PI * k / facets), radius * math.sin(2 * PI * k / facets), z) for k in range(facets)]


def band(a, b):
    return [[a[k], a[(k + 1) % len(a)], b[(k + 1) % len(a)], b[k]] for k in range(len(a))]


class Bulk(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def test_janssen(self):
        """What the bottom of scenes/silo.toml carries: M_a = M_∞ (1 − exp(−M/M_∞)), M_∞ = ρ_b π D³/(16 μ K)."""
        simulate(ROOT / "scenes" / "silo.toml", self.path)
        g, diameter, friction = 9.81, 0.050, 0.5
        poured = [(row["time_s"], row["mass_kg"]) for row in table(self.path / "diagnostics.csv") if row["region"] == "whole"]
        bottom = {row["time_s"]: -row["force_z_N"] / g for row in table(self.path / "walls.csv") if row["wall"] == "bottom"}
        tube = {row["time_s"]: -row["force_z_N"] / g for row in table(self.path / "walls.csv") if row["wall"] == "tube"}
        points = [(mass, bottom[time]) for time, mass in poured if mass > 0 and time > 0.2]
        full = points[-1][0]

        def deviation(limit):
            return math.sqrt(sum((felt - limit * (1 - math.exp(-mass / limit))) ** 2 for mass, felt in points) / len(points))

        limit = min((0.001 * k for k in range(20, 3000)), key=deviation)
        cells = [row for row in table(self.path / "grid.csv") if row["time_s"] == poured[-1][0] and 0.05 < row["z_m"] < 0.25]
        # Cells are square and the tube is round.
        density = 2500 * sum(cell["solid_fraction"] for cell in cells) / len(cells) * 4 / PI
        ratio = density * PI * diameter**3 / (16 * friction * limit)
        last = [felt for mass, felt in points if mass > 0.85 * full]
        settled = sum(last) / len(last)
        print(f"\nJanssen: poured {full:.3f} kg, bottom carries {settled:.3f} kg, bottom and tube {bottom[poured[-1][0]] + tube[poured[-1][0]]:.3f} kg; "
              f"M_inf {limit:.3f} kg, rms deviation {100 * deviation(limit) / limit:.1f} % of it, bulk density {density:.0f} kg/m3, K {ratio:.2f} if all friction were at work")
        self.assertAlmostEqual((bottom[poured[-1][0]] + tube[poured[-1][0]]) / full, 1, delta=0.05)  # nothing else carries
        self.assertLess(settled, 0.6 * full)
        self.assertLess(deviation(limit), 0.15 * limit)

    def test_janssen_mobilised(self):
        """The bottom sinks by half a grain, so that more of the wall's friction is at work: the load falls towards, and not below, that of
        all of it, M_∞ = ρ_b π D³/(16 μ K) with the K = σ_rr/σ_zz that is measured. A bound: grains also roll along the wall."""
        text = (ROOT / "scenes" / "silo.toml").read_text(encoding="utf-8")
        text = "\n".join(line for line in text.splitlines() if not line.startswith(("rain5", "rain6", "end =")))
        text = text.replace("[simulation]", "[simulation]\nend = 2.3").replace("../assets", str(ROOT / "assets"))
        text = text.replace("[walls.bottom]", '[walls.bottom]\nmotion = { kind = "translate", velocity = [0, 0, -0.02], start = 1.9, end = 2.05 }')
        (self.path / "silo.toml").write_text(text)
        simulate(self.path / "silo.toml", self.path)
        g, diameter, friction = 9.81, 0.050, 0.5
        times = [row["time_s"] for row in table(self.path / "diagnostics.csv") if row["region"] == "whole"]
        poured = [row["mass_kg"] for row in table(self.path / "diagnostics.csv") if row["region"] == "whole"][-1]

        def bottom(low, high):
            felt = [-row["force_z_N"] / g for row in table(self.path / "walls.csv") if row["wall"] == "bottom" and low <= row["time_s"] <= high]
            return sum(felt) / len(felt)

        cells = [row for row in table(self.path / "grid.csv") if row["time_s"] == times[-1] and 0.02 < row["z_m"] < 0.15]
        density = 2500 * sum(cell["solid_fraction"] for cell in cells) / len(cells) * 4 / PI
        ratio = sum(0.5 * (cell["stress_xx_Pa"] + cell["stress_yy_Pa"]) for cell in cells) / sum(cell["stress_zz_Pa"] for cell in cells)
        limit = density * PI * diameter**3 / (16 * friction * ratio)
        expected, measured = limit * (1 - math.exp(-poured / limit)), bottom(2.2, 2.31)
        print(f"\nJanssen, mobilised: poured {poured:.3f} kg; the bottom carries {bottom(1.8, 1.9):.3f} kg before it sinks and {measured:.3f} kg after, "
              f"{expected:.3f} kg if all friction were at work, from K = {ratio:.2f} and bulk density {density:.0f} kg/m3")
        self.assertLess(measured, 0.7 * bottom(1.8, 1.9))
        self.assertGreater(measured, expected)

    HAFF = """
[simulation]
end = 6
gravity = [0, 0, 0]
integrator = "symplectic_euler"
ledger = false
domain = {{ min = [0, 0, 0], max = [{side}, {side}, {side}], periodic = ["x", "y", "z"] }}
[contact]
tangential = "none"
[materials]
ball = {{ density = 2500 }}
[pairs]
normal_stiffness = "30 kN/m"
restitution = 0.9
[grains.gas]
source = "packing"
box = {{ min = [0, 0, 0], max = [{side}, {side}, {side}] }}
count = {count}
radius = "5 mm"
velocity_spread = "0.17 m/s"
[diagnostics]
[output]
frame_interval = "50 ms"
"""

    def test_haff(self):
        """A gas of smooth spheres cools as T = T0/(1 + t/τ)²: d(1/√T)/dt = (2/3) √π (1 − e²) n d² χ, χ after Carnahan and Starling."""
        count, side, d, restitution = 2000, 0.22, 0.010, 0.9
        (self.path / "gas.toml").write_text(self.HAFF.format(side=side, count=count))
        simulate(self.path / "gas.toml", self.path)
        rows = [row for row in table(self.path / "diagnostics.csv") if row["region"] == "whole"]
        start = rows[0]["temperature_m2_per_s2"]
        fitted = [row for row in rows if row["time_s"] > 0.5 and row["temperature_m2_per_s2"] > start / 50]
        slope, at_zero, deviation = line([row["time_s"] for row in fitted], [row["temperature_m2_per_s2"] ** -0.5 for row in fitted])
        density = count / side**3
        fraction = density * PI / 6 * d**3
        pairs = (1 - fraction / 2) / (1 - fraction) ** 3
        theory = 2 / 3 * math.sqrt(PI) * (1 - restitution**2) * density * d**2 * pairs
        print(f"\nHaff: solid fraction {fraction:.3f}, T0/T {start / rows[-1]['temperature_m2_per_s2']:.1f} at the end; slope of 1/sqrt(T) "
              f"{slope:.3f} 1/m, kinetic theory {theory:.3f} 1/m ({100 * (slope / theory - 1):+.1f} %), rms deviation from the line "
              f"{100 * deviation / (at_zero + slope * fitted[-1]['time_s']):.2f} % of its end")
        self.assertGreater(start / fitted[-1]["temperature_m2_per_s2"], 10)
        self.assertAlmostEqual(slope / theory, 1, delta=0.05)
        self.assertLess(deviation, 0.02 * (at_zero + slope * fitted[-1]["time_s"]))


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
