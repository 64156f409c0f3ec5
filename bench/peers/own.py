"""What is measured of tsubu alone: bonds against contacts, the price of frames, memory, start-up."""
import math
import random
import re
import statistics
from dataclasses import replace

import bed
import codes
import grains as grains_of
from table import Row, Series

EDGE, RADIUS = 32, 1e-3  # grains along the cubic block, m
BLOCK_STEP = 1e-8  # s: so short that nothing comes apart while it is measured
PAIRS = 3 * EDGE**2 * (EDGE - 1)
GLUE = '[bonds.glue]\nmodulus = 1e7\n'
BLOCKS = {  # name: distance of neighbours in diameters, bonds
    "apart": (2.0, ""),
    "contacts": (0.999, ""),
    "bonds": (0.999, GLUE),
    "damped bonds that may break": (0.999, GLUE + 'strength = { tension = 1e9, shear = 1e9 }\ndamping = { kind = "viscous", ratio = 0.1 }\n'),
}
TRIANGLES_ACROSS = 224  # squares of the mesh that start-up reads: 100,352 triangles


def block(spacing):
    """A cubic lattice whose grains move and spin a little, so that contacts slide."""
    numbers = random.Random(1)
    return [bed.Grain(RADIUS, tuple(2 * RADIUS * spacing * n for n in (i, j, k)), tuple(numbers.uniform(-0.01, 0.01) for _ in range(3)),
                      tuple(numbers.uniform(-10, 10) for _ in range(3)))
            for i in range(EDGE) for j in range(EDGE) for k in range(EDGE)]


def alternate(session, works):
    """Measures scenes of tsubu in turns: by name, the series of runs. A work comes with its grains, tables for the scene, and options."""
    series = {}
    for work, grains, tables, options in works:
        folder = session.folder(work)
        bed.write_tsubu(folder, grains, work, bed.FROM_FILE + tables)
        series[work.name] = Series(session.tsubu, work, 1, len(grains), folder, options)
    session.measure(list(series.values()))
    return series


def bonds(session):
    """100k bonds against as many contacts with friction: cost beyond that of the same grains when they touch nothing."""
    steps = session.steps(300)
    still = bed.Work("", steps, time_step=BLOCK_STEP, planes=(), gravity=(0.0, 0.0, 0.0))
    series = alternate(session, [(replace(still, name=f"block, {name}"), block(spacing), glue, {}) for name, (spacing, glue) in BLOCKS.items()])
    apart, contacts = series["block, apart"].seconds, series["block, contacts"].seconds
    for name in ("bonds", "damped bonds that may break"):
        glued = series[f"block, {name}"].seconds
        pair = 1e9 / steps / PAIRS
        session.add(Row(f"{PAIRS} {name}, without the motion", "bonds", pair * (glued - apart), "contacts", pair * (contacts - apart), "ns a pair", True),
                    Row(f"{PAIRS} {name}, whole step", "bonds", pair * glued, "contacts", pair * contacts, "ns a pair", True))


def frames(session):
    """The bed on one thread, with frames and without: time of the simulation alone, and of all."""
    (grains, sides), steps = session.bed(), session.steps(4000)
    work = bed.Work("bed", steps, planes=bed.box(*sides)).fitted(grains)
    series = alternate(session, [(replace(work, name=f"bed {word} frames"), grains, "", {"frames": word == "with"}) for word in ("without", "with")])
    drawn, bare = series["bed with frames"], series["bed without frames"]
    session.add(Row(f"simulation while {steps // bed.OUTPUT_EVERY + 1} frames are written", "with", drawn.seconds, "without", bare.seconds, "s", True),
                Row("the whole run, start and last frame included", "with", drawn.median("wall_seconds"), "without", bare.median("wall_seconds"), "s", True))


def memory(session):
    """Peak of resident memory beyond that of ten grains, per grain, with friction and without."""
    tiles, (grains, sides) = session.tiles(4), session.bed()
    many = bed.lay_out(grains, tiles, *sides)
    for friction in (True, False):
        word = "with" if friction else "without"
        series = list(alternate(session, [
            (bed.Work(f"{len(some)} grains {word} friction", session.steps(300), friction=friction,
                      planes=bed.box(*(count * side for side in sides))).fitted(grains), some, "", {})
            for some, count in ((grains[:10], 1), (many, tiles))]).values())
        few, full = (one.median("peak_bytes") for one in series)
        told = codes.call([session.tsubu.program, "explain", "bed.toml"], series[1].directory).text
        session.add(Row(f"memory {word} friction, {len(many)} grains", "tsubu", (full - few) / len(many), unit="bytes a grain"),
                    Row(f"the same, as explain has it", "tsubu", explained(told) / len(many), unit="bytes a grain"),
                    Row(f"memory of a contact {word} friction (explain)", "tsubu", float(re.search(r"(\d+) per contact", told)[1]), unit="bytes"))


def explained(text):
    return 1e6 * float(re.search(r"about ([\d.e+]+) MB", text)[1])


def wavy_sheet(path):
    """A mesh of 100,352 triangles."""
    n = TRIANGLES_ACROSS
    place = [[(0.001 * i, 0.001 * j, 0.002 * math.sin(0.1 * i) * math.cos(0.13 * j)) for j in range(n + 1)] for i in range(n + 1)]
    triangles = []
    for i in range(n):
        for j in range(n):
            a, b, c, d = place[i][j], place[i + 1][j], place[i + 1][j + 1], place[i][j + 1]
            triangles += [(a, b, c), (a, c, d)]
    grains_of.write_stl(path, triangles)


def start_up(session):
    """Processor time of `tsubu check`, which packs grains and reads meshes as a run does."""
    start = bed.Work("start-up", 1, planes=())
    folder = session.folder(start)
    wavy_sheet(folder / "sheet.stl")
    one = '[grains.bed]\nsource = "list"\npositions = [[0.1, 0.1, 0.1]]\nradius = 0.001\n'
    scenes = [("the program alone", start, one),
              (f"reading an STL of {2 * TRIANGLES_ACROSS**2} triangles (text)", replace(start, mesh=folder / "sheet.stl"), one)]
    for fill in (0.3, 0.5):
        radius = (fill * 1e-3 / 100_000 * 0.75 / math.pi) ** (1 / 3)
        region = "box = { min = [0, 0, 0], max = [0.1, 0.1, 0.1] }\ncount = 100000"
        scenes.append((f"packing 100000 grains to {fill}", start, grains_of.packing(region, f"radius = {radius!r}")))
    for name, work, sources in scenes:
        bed.write_tsubu(folder, [], work, sources)
        seconds = [codes.call([session.tsubu.program, "check", "bed.toml"], folder).cpu_seconds for _ in range(session.runs)]
        session.add(Row(f"start-up: {name}", "tsubu", statistics.median(seconds), unit="s of processor"))
