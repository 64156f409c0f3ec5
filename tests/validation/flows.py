#!/usr/bin/env python3
"""Flows of granular matter, measured with the program itself: flows.py TSUBU [TEST…]. docs/validation.md has the table.

Small scenes of soft grains, about a minute of one core each at most. Every test prints what it measured. With TSUBU_VALIDATION_PICTURES=DIR
the last instant of each scene is drawn into DIR; TSUBU_VALIDATION_SEED=N (1 unless given) places the grains otherwise.
"""
import math
import os
import pathlib
import random
import shutil
import sys
import tempfile
import unittest

import bulk
from bulk import PI, band, line, ring, table, write_obj

PICTURES = os.environ.get("TSUBU_VALIDATION_PICTURES")
SEED = int(os.environ.get("TSUBU_VALIDATION_SEED", "1"))
G = 9.81
D = 0.006  # m: mean diameter of all grains here; radii are uniform within 7 % of it
MEAN_VOLUME = 4 / 3 * PI * (0.0028**2 + 0.0032**2) * (0.0028 + 0.0032) / 4

HEAD = """
[simulation]
end = {end}
integrator = "symplectic_euler"
safety = 0.6
overlap_limit = 0.5
ledger = false
seed = {seed}
gravity = [{gx}, 0, {gz}]
domain = {domain}
[contact]
rolling = "{rolling}"
[materials]
bead = {{ density = 2500 }}
smooth = {{ density = 2500 }}
[pairs]
normal_stiffness = 1500
restitution = {e}
friction = {mu}
{rolling_friction}
smooth = {{ bead = {{ friction = 0 }} }}
[output]
frame_interval = {end}
ledger_interval = "10 ms"
[picture]
width = 480
height = 270
quality = "fine"
[overlay]
title = false
[colours]
by = "speed"
"""

UNIFORM = 'radius = { min = "2.8 mm", max = "3.2 mm" }\nmaterial = "bead"\n'


def head(end, domain, gx=0.0, gz=-G, e=0.5, mu=0.5, mu_r=0.0):
    return HEAD.format(end=end, seed=SEED, gx=gx, gz=gz, domain=domain, rolling="elastic_plastic" if mu_r else "none", e=e, mu=mu,
                       rolling_friction=f"rolling_friction = {mu_r}" if mu_r else "")


def camera(eye, target, opening):
    return f'[camera]\nview = "fixed"\neye = {list(eye)}\ntarget = {list(target)}\nfield_of_view = "{opening} deg"\n'


def mean_and_error(values):
    mean = sum(values) / len(values)
    return mean, math.sqrt(sum((v - mean) ** 2 for v in values) / (len(values) - 1) / len(values))


def fit(xs, ys):
    """Slope and intercept of a straight line, each with its standard error."""
    slope, at_zero, deviation = line(xs, ys)
    n, mean = len(xs), sum(xs) / len(xs)
    scatter = deviation * math.sqrt(n / (n - 2))
    spread = sum((x - mean) ** 2 for x in xs)
    return slope, scatter / math.sqrt(spread), at_zero, scatter * math.sqrt(1 / n + mean**2 / spread)


class Flow(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def run_scene(self, name, text):
        scene, out = self.path / f"{name}.toml", self.path / name
        scene.write_text(text)
        if PICTURES:
            bulk.simulate(scene, out, frames=True)
            shutil.copy(sorted((out / "frames").iterdir())[-1], pathlib.Path(PICTURES) / f"{name}.png")
        else:
            bulk.simulate(scene, out)
        return out

    # Discharge of a flat-bottomed silo --------------------------------------------------------------------------------------------------

    def discharge(self, ratio, radius, flowing):
        """Rates through a hole of `ratio` grain diameters in four equal spans of time, kg/s, and kg/m³ of the bed before it opens. `radius`
        of the silo in diameters, `flowing` in s."""
        opens, settled, hole, radius = 0.25, 0.12, ratio * D / 2, radius * D
        write_obj(self.path / "silo.obj", band(ring(hole, 0), ring(radius, 0)) + band(ring(radius, 0), ring(radius, 0.3)))
        write_obj(self.path / "plug.obj", [ring(hole * 1.02, -0.0001)])
        end = round(opens + settled + flowing, 2)
        text = head(end, "{ min = [-0.5, -0.5, -0.3], max = [0.5, 0.5, 1] }") + f"""
[grains.bed]
source = "packing"
cylinder = {{ base = [0, 0, 0.001], top = [0, 0, {18 * D + 0.03}], radius = {radius - 0.0005} }}
fill = 0.48
{UNIFORM}
[walls.silo]
mesh = "silo.obj"
material = "bead"
look = "translucent"
[walls.plug]
mesh = "plug.obj"
material = "bead"
look = "hidden"
motion = {{ kind = "translate", velocity = [0, 0, -4], start = {opens} }}
[sinks.below]
box = {{ min = [-1, -1, -0.29], max = [1, 1, -0.08] }}
[counters.outlet]
point = [0, 0, -0.01]
[diagnostics]
regions = {{ bed = {{ box = {{ min = [{-4 * D}, {-4 * D}, 0.018], max = [{4 * D}, {4 * D}, 0.07] }} }} }}
""" + camera((0.1, -0.42, 0.10), (0, 0, 0.035), 30)
        out = self.run_scene(f"beverloo_{ratio}", text)
        bed = min((row for row in table(out / "diagnostics.csv") if row["region"] == "bed"), key=lambda row: abs(row["time_s"] - opens))
        rows = [row for row in table(out / "ledger.csv") if row["time_s"] >= opens + settled - 1e-6]
        rates = []
        for part in range(4):
            some = rows[part * (len(rows) - 1) // 4:(part + 1) * (len(rows) - 1) // 4 + 1]
            slope, _, _ = line([row["time_s"] for row in some], [row["counted_outlet"] for row in some])
            rates.append(slope * 2500 * MEAN_VOLUME)
        return rates, 2500 * bed["solid_fraction"]

    def test_beverloo(self):
        """Q = C ρ_b √g (D − k d)^(5/2): then (Q/(ρ_b √g))^(2/5) is a straight line in D that meets zero at k d. C is known as 0.55 to 0.65, k
        as 1 to 2 (1.4 for spheres); the exponent is that for the k that is fitted."""
        roots, wide, logarithms = [], [], []
        print()
        for ratio, radius, flowing in ((5, 9, 0.6), (7, 10, 0.4), (10, 12, 0.28), (14, 14.5, 0.2)):
            rates, density = self.discharge(ratio, radius, flowing)
            rate, error = mean_and_error(rates)
            roots.append((rate / (density * math.sqrt(G))) ** 0.4 / D)
            wide.append(ratio)
            logarithms.append(math.log(rate / density))
            print(f"Beverloo: D/d {ratio}: {rate:.4f} ± {error:.4f} kg/s, bulk density {density:.0f} kg/m3, C for k = 1.4: "
                  f"{roots[-1] ** 2.5 / (ratio - 1.4) ** 2.5:.3f}", flush=True)
        slope, slope_error, at_zero, zero_error = fit(wide, roots)
        k, constant = -at_zero / slope, slope**2.5
        exponent, exponent_error, _, _ = fit([math.log(ratio - 1.4) for ratio in wide], logarithms)
        print(f"Beverloo: k {k:.2f} ± {zero_error / slope:.2f}, C {constant:.3f} ± {2.5 * constant * slope_error / slope:.3f}; exponent for k = 1.4: "
              f"{exponent:.3f} ± {exponent_error:.3f}")
        self.assertTrue(1 < k < 2)
        self.assertTrue(0.5 < constant < 0.7)
        self.assertAlmostEqual(exponent, 2.5, delta=0.15)

    # Collapse of a column ---------------------------------------------------------------------------------------------------------------

    def collapse(self, aspect):
        """(r_end − r_0)/r_0 of a round column of this ratio of height to radius when its tube is pulled up."""
        radius = (3000 / 3.6 / aspect) ** (1 / 3) * D
        height, opens = aspect * radius, 0.3
        write_obj(self.path / "tube.obj", band(ring(radius, 0), ring(radius, height * 1.4 + 0.02)))
        end = 1.4
        half, cells = 90 * D, 180
        text = head(end, "{ min = [-2, -2, -0.1], max = [2, 2, 6] }", e=0.5, mu=0.5, mu_r=0.2) + f"""
[grains.column]
source = "packing"
cylinder = {{ base = [0, 0, 0.001], top = [0, 0, {height * 1.22}], radius = {radius - 0.0005} }}
fill = 0.5
{UNIFORM}
[walls.floor]
plane = {{ normal = [0, 0, 1] }}
material = "bead"
look = "ground"
colour = "#e0dcd4"
[walls.tube]
mesh = "tube.obj"
material = "smooth"
look = "wire"
motion = {{ kind = "translate", velocity = [0, 0, 5], start = {opens} }}
[diagnostics]
every = 10
grid = {{ box = {{ min = [{-half}, {-half}, -0.001], max = [{half}, {half}, 0.5] }}, cells = {{ x = {cells}, y = {cells} }} }}
""" + camera((0, -0.75, 0.30), (0, 0, 0.02), 22)
        out = self.run_scene(f"collapse_{aspect:g}", text)
        last = table(out / "grid.csv")[-cells * cells:]
        # How many grains there are at each radius, per place for one in a layer; the deposit ends where half a layer does.
        counts, areas = {}, {}
        for cell in last:
            at = int(math.hypot(cell["x_m"], cell["y_m"]) / D)
            counts[at] = counts.get(at, 0) + cell["grains"]
            areas[at] = areas.get(at, 0) + (2 * half / cells) ** 2 / D**2
        layers = [counts[at] / areas[at] for at in range(len(counts))]
        front = next(at for at in range(len(layers)) if layers[at] < 0.5)
        before = layers[front - 1]
        edge = (front - 0.5 + (before - 0.5) / (before - layers[front])) * D
        start = [cell for cell in table(out / "grid.csv") if abs(cell["time_s"] - opens) < 1e-6]
        settled = sum(cell["grains"] for cell in start) * MEAN_VOLUME / 0.6 / (PI * radius**2)  # height at a solid fraction of 0.6
        moving = max(math.hypot(cell["velocity_x_m_per_s"], cell["velocity_y_m_per_s"]) for cell in last if math.hypot(cell["x_m"], cell["y_m"]) < edge)
        return settled / radius, edge / radius - 1, moving, int(sum(counts.values())), radius / D

    def test_collapse(self):
        """Lube, Huppert, Sparks & Hallworth (2004): the runout of a round column is 1.24 a for a < 1.7 and 1.6 √a beyond, whatever it is made of."""
        print()
        for aspect in (0.6, 1.2, 3, 6):
            a, runout, moving, grains, radius = self.collapse(aspect)
            lube = 1.24 * a if a < 1.7 else 1.6 * math.sqrt(a)
            print(f"Collapse: a {a:.2f} (radius {radius:.1f} d, {grains:.0f} grains): runout {runout:.2f}, Lube {lube:.2f} ({100 * (runout / lube - 1):+.0f} %), "
                  f"fastest cell at the end {1000 * moving:.1f} mm/s", flush=True)
            self.assertAlmostEqual(runout / lube, 1, delta=0.35)

    # Angle of repose --------------------------------------------------------------------------------------------------------------------

    def repose(self, name, mu, mu_r, e):
        """Degrees: slope that stays when one side of a box is taken away, its standard error, and the largest speed of a cell left, m/s."""
        length, height, width, opens, end = 32 * D, 22 * D, 8 * D, 0.3, 2.0
        domain = f'{{ min = [-0.1, 0, -0.2], max = [0.6, {width}, 1], periodic = ["y"] }}'
        columns = 32
        text = head(end, domain, e=e, mu=mu, mu_r=mu_r) + f"""
[grains.bed]
source = "packing"
box = {{ min = [0, 0, 0], max = [{length}, {width}, {height * 1.15}] }}
fill = 0.5
{UNIFORM}
[walls.table]
mesh = "table.obj"
material = "bead"
colour = "#c9c2b4"
[walls.back]
plane = {{ point = [0, 0, 0], normal = [1, 0, 0] }}
material = "bead"
look = "hidden"
[walls.gate]
mesh = "gate.obj"
material = "smooth"
look = "wire"
motion = {{ kind = "translate", velocity = [0, 0, -3], start = {opens} }}
[sinks.below]
box = {{ min = [-1, -1, -0.2], max = [1, 1, -0.02] }}
[diagnostics]
every = 10
grid = {{ box = {{ min = [0, 0, 0], max = [{length}, {width}, {height * 1.2}] }}, cells = {{ x = {columns}, z = 27 }} }}
""" + camera((0.096, -0.5, 0.09), (0.096, 0, 0.05), 26)
        y0, y1, far = -0.05, width + 0.05, length
        # The table is rough: its grooves across the slope are as wide as a grain.
        teeth = [(k * D * 1.0, 0.0 if k % 2 else -0.0025) for k in range(33)]
        floor = [[(a, y0, za), (b, y0, zb), (b, y1, zb), (a, y1, za)] for (a, za), (b, zb) in zip(teeth, teeth[1:])]
        write_obj(self.path / "table.obj", floor + [[(far, y0, teeth[-1][1]), (far, y0, -0.1), (far, y1, -0.1), (far, y1, teeth[-1][1])]])
        write_obj(self.path / "gate.obj", [[(far, y0, 0), (far, y1, 0), (far, y1, 0.3), (far, y0, 0.3)]])
        out = self.run_scene(name, text)
        last = table(out / "grid.csv")[-columns * 27:]
        inside = [cell["solid_fraction"] for cell in last if cell["x_m"] < 0.4 * length and 0.01 < cell["z_m"] < 0.04]
        bulk_fraction = sum(inside) / len(inside)
        profile = {}
        for cell in last:
            profile[cell["x_m"]] = profile.get(cell["x_m"], 0) + cell["solid_fraction"] / bulk_fraction * height * 1.2 / 27
        # The slope between the crest, which the back wall holds, and the foot at the edge.
        points = [(x, h) for x, h in sorted(profile.items()) if 0.15 * length < x < 0.88 * length]
        slope, error, _, _ = fit([x for x, _ in points], [h for _, h in points])
        moving = max(math.hypot(cell["velocity_x_m_per_s"], cell["velocity_z_m_per_s"]) for cell in last if cell["grains"] > 0 and cell["x_m"] < 0.8 * length)
        angle = math.degrees(math.atan(-slope))
        return angle, math.degrees(error) * math.cos(math.radians(angle)) ** 2, moving

    def test_repose(self):
        """The angle of repose grows with friction, then hardly; with rolling resistance beyond that; restitution is not felt by what rests."""
        angles = {}
        print()
        for mu, mu_r, e in ((0.1, 0, 0.5), (0.3, 0, 0.5), (0.6, 0, 0.5), (0.6, 0.1, 0.5), (0.6, 0.3, 0.5), (0.6, 0.1, 0.2)):
            angle, error, moving = self.repose(f"repose_{mu:g}_{mu_r:g}_{e:g}", mu, mu_r, e)
            angles[mu, mu_r, e] = angle
            print(f"Repose: mu {mu:g}, mu_r {mu_r:g}, e {e:g}: {angle:.1f} ± {error:.1f} deg, fastest cell at the end {1000 * moving:.2g} mm/s", flush=True)
        self.assertTrue(angles[0.1, 0, 0.5] + 3 < angles[0.3, 0, 0.5] < angles[0.6, 0, 0.5] + 1)
        self.assertTrue(angles[0.6, 0, 0.5] + 2 < angles[0.6, 0.1, 0.5] < angles[0.6, 0.3, 0.5])
        self.assertAlmostEqual(angles[0.6, 0.1, 0.2], angles[0.6, 0.1, 0.5], delta=2.5)

    # A dense layer on an incline --------------------------------------------------------------------------------------------------------

    def chute(self, angle, end):
        """Mean velocity down the incline, m/s, against time, s."""
        length, width, layer = 16.5 * D, 6 * D, 12 * D
        sine, cosine = math.sin(math.radians(angle)), math.cos(math.radians(angle))
        domain = f'{{ min = [0, 0, -0.05], max = [{length}, {width}, 0.5], periodic = ["x", "y"] }}'
        text = head(end, domain, gx=G * sine, gz=-G * cosine) + f"""
[grains.layer]
source = "packing"
box = {{ min = [0, 0, {D}], max = [{length}, {width}, {layer * 1.2 + D}] }}
fill = 0.48
{UNIFORM}velocity = [0.35, 0, 0]
[walls.bumps]
mesh = "bumps.obj"
material = "bead"
colour = "#8d8677"
[diagnostics]
every = 2
""" + camera((0.048, -0.36, 0.07), (0.048, 0, 0.035), 24)
        # Pyramids at random, repeated as the domain is: on regular ones grains order themselves and slide.
        chance, faces, edge, across, along = random.Random(3), [], 1.5 * D, 4, 11
        tips = [[(chance.uniform(0.2, 0.8), chance.uniform(0.2, 0.8), chance.uniform(0.3, 0.9)) for _ in range(across)] for _ in range(along)]
        for i in range(-2, along + 2):
            for j in range(-2, across + 2):
                x, y, (u, v, w) = i * edge, j * edge, tips[i % along][j % across]
                corners = [(x, y, 0), (x + edge, y, 0), (x + edge, y + edge, 0), (x, y + edge, 0)]
                faces += [[corners[k], corners[(k + 1) % 4], (x + u * edge, y + v * edge, w * D)] for k in range(4)]
        write_obj(self.path / "bumps.obj", faces)
        out = self.run_scene(f"chute_{angle:g}", text)
        return [(row["time_s"], row["bulk_velocity_x_m_per_s"]) for row in table(out / "diagnostics.csv") if row["region"] == "whole"]

    def test_chute(self):
        """Silbert et al. (2001), Phys. Rev. E 64, 051302: a layer on a bumpy incline stops at small angles, flows steadily between, and accelerates
        where the incline is too steep; there friction no longer holds the weight."""
        print()
        for angle, end, state in ((15, 1.5, "stops"), (22, 4.0, "steady"), (25, 4.0, "steady"), (34, 2.0, "accelerates")):
            flow = self.chute(angle, end)
            late = [(t, v) for t, v in flow if t > 0.6 * end]
            mean = sum(v for _, v in late) / len(late)
            acceleration, error, _, _ = fit([t for t, _ in late], [v for _, v in late])
            share = acceleration / (G * math.sin(math.radians(angle)))
            print(f"Chute: {angle} deg: {mean:.3f} m/s in the last two fifths of {end} s, acceleration {acceleration:.3f} ± {error:.3f} m/s2 = {100 * share:.1f} % of "
                  f"what pulls: {state}", flush=True)
            if state == "stops":
                self.assertLess(abs(late[-1][1]), 0.002)
            elif state == "steady":
                self.assertGreater(mean, 0.05)
                self.assertLess(abs(share), 0.03)
            else:
                self.assertGreater(share, 0.05)


if __name__ == "__main__":
    bulk.PROGRAM = sys.argv.pop(1)
    unittest.main()
