"""Series of runs in alternation, their check, and the tables that come of them."""
import csv
import datetime
import re
import statistics
from dataclasses import dataclass, field
from pathlib import Path

import bed


@dataclass
class Series:
    """One code at one work: a line of the table of runs."""
    code: object
    work: bed.Work
    cores: int
    grains: int
    directory: Path
    options: dict = field(default_factory=dict)  # of tsubu: isa, frames, mixed
    runs: list = field(default_factory=list)

    @property
    def name(self):
        return " ".join([self.code.name, *filter(None, [self.options.get("isa"), "mixed" if self.options.get("mixed") else ""])])

    def median(self, of):
        return statistics.median(getattr(run, of) for run in self.runs)

    @property
    def seconds(self):
        return self.median("seconds")

    @property
    def per_grain_step(self):
        """ns"""
        return 1e9 * self.seconds / self.grains / self.work.steps

    @property
    def per_contact(self):
        """ns for a contact and step; tsubu alone knows how many there are"""
        return 1e9 * self.seconds / self.median("contacts") / self.work.steps


@dataclass
class Row:
    """A line of the final table. The ratio is how much faster `what` is than `against`; inverted, what it costs of it."""
    case: str
    what: str
    value: float
    against: str = ""
    other: float = 0
    unit: str = "s"
    invert: bool = False

    @property
    def ratio(self):
        if not self.against:
            return None
        return self.value / self.other if self.invert else self.other / self.value


def cores_in_words(count):
    return f"{count} core{'s' if count > 1 else ''}"


def alternate(series, runs):
    """Every series once, then again: a slow minute of the machine hits all of them."""
    for number in range(1, runs + 1):
        for one in series:
            one.runs.append(one.code.run(one.directory, one.cores, **one.options))
            print(f"run {number}/{runs}: {one.work.name}, {one.name:<13} {cores_in_words(one.cores):<8}{one.runs[-1].seconds:8.3f} s", flush=True)


def check(series, tolerances):
    """Prints the kinetic energies of a work and says whether tsubu is as near to a peer as it must be, always with the same bits."""
    peers = [one for one in series if one.code.name != "tsubu" and one.cores == series[0].cores]
    print(f"\n{series[0].work.name}: kinetic energy of translation, J" +
          (", and the difference from " + ", ".join(peer.name for peer in peers) if peers else ""))
    agree = True
    for one in series:
        print(f"  {one.name}, {cores_in_words(one.cores)}")
        for step, energy in sorted(one.runs[0].energies.items()):
            differences = [energy / peer.runs[0].energies[step] - 1 for peer in peers if peer.runs[0].energies.get(step)]
            verdict = ""
            if one.code.name == "tsubu" and differences and step in tolerances:
                near = min(map(abs, differences)) <= tolerances[step]
                verdict = f"   within {tolerances[step]:.2%}" if near else f"   MORE THAN {tolerances[step]:.2%} FROM ALL"
                agree = agree and near
            print(f"    {step:>6}  {energy:.5e}  " + "  ".join(f"{difference:+8.3%}" for difference in differences) + verdict)
    hashes = {run.state_hash for one in series if one.code.name == "tsubu" for run in one.runs}
    if len(hashes) > 1:
        print(f"  tsubu ended with different bits: {', '.join(sorted(hashes))}")
    elif hashes:
        print(f"  every run of tsubu ended with the state {next(iter(hashes))}")
    return agree and len(hashes) < 2


def print_runs(series):
    print(f"\n{'work':<38}{'code':<14}{'cores':>5}{'grains':>9}{'median s':>10}{'min':>9}{'max':>9}{'Mgrain-steps/s':>16}")
    for one in series:
        seconds = [run.seconds for run in one.runs]
        print(f"{one.work.name:<38}{one.name:<14}{one.cores:>5}{one.grains:>9}{one.seconds:>10.3f}{min(seconds):>9.3f}{max(seconds):>9.3f}"
              f"{1e3 / one.per_grain_step:>16.2f}")


def print_rows(rows, failed):
    print(f"\n{'what':<60}{'':<14}{'':>10}  {'against':<12}{'':>9}  {'unit':<18}{'ratio':>7}")
    for row in rows:
        ratio = "" if row.ratio is None else f"{row.ratio:.2f}"
        other = f"{row.other:.4g}" if row.against else ""
        print(f"{row.case:<60}{row.what:<14}{row.value:>10.4g}  {row.against:<12}{other:>9}  {row.unit:<18}{ratio:>7}")
    for name in failed:
        print(f"{name}: THE CODES OR THE BITS DO NOT AGREE")


def processor():
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown"


def append(path, names, lines):
    """Adds lines to a table, and the names of its columns on top when it is new."""
    new = not path.is_file()
    with open(path, "a", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        if new:
            table.writerow(names.split())
        table.writerows(lines)


def write(directory, series, rows):
    """All runs and the final table, one file of each per machine; earlier results stay."""
    date, cpu = datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"), processor()
    machine = re.sub(r"[^a-z0-9]+", "_", cpu.lower()).strip("_")
    runs, table = directory / f"runs_{machine}.csv", directory / f"table_{machine}.csv"
    append(runs, "date processor work code version cores grains steps run seconds wall_seconds million_grain_steps_per_second contacts peak_bytes "
           "kinetic_energy_J state_hash",
           [[date, cpu, one.work.name, one.name, one.code.version, one.cores, one.grains, one.work.steps, number, run.seconds, run.wall_seconds,
             f"{one.grains * one.work.steps / run.seconds / 1e6:.4f}", run.contacts, run.peak_bytes, run.energies.get(one.work.steps, ""),
             run.state_hash] for one in series for number, run in enumerate(one.runs, 1)])
    append(table, "date processor case what value against other unit ratio",
           [[date, cpu, row.case, row.what, row.value, row.against, row.other, row.unit, row.ratio or ""] for row in rows])
    print(f"\nall runs: {runs}\nthis table: {table}")
