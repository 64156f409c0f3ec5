"""Series of runs in alternation, their check, and the tables that come of them."""
import csv
import datetime
import re
import statistics
from dataclasses import dataclass, field
from pathlib import Path

import bed
import codes


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
    """Every series once, then again: a slow minute of the machine hits all of them. Returns what failed; the others go on without it, but
    nothing goes on without tsubu."""
    failures = []
    for number in range(1, runs + 1):
        for one in list(series):
            try:
                one.runs.append(one.code.run(one.directory, one.cores, **one.options))
            except codes.Failed as failure:
                if one.code.name == "tsubu":
                    raise
                series.remove(one)
                failures.append(f"{one.work.name}, {one.name}, {cores_in_words(one.cores)}: left out. {failure}")
                print(failures[-1], flush=True)
                continue
            print(f"run {number}/{runs}: {one.work.name}, {one.name:<13} {cores_in_words(one.cores):<8}{one.runs[-1].seconds:8.3f} s", flush=True)
    return failures


def judged(energies, tolerances):
    """The step at which codes are compared: the last one of those before chaos has had its time."""
    return max((step for step in energies if 0 < step <= tolerances.last), default=None)


def check(series, tolerances):
    """Prints the kinetic energies of a work. Returns sentences about what is wrong with them: tsubu is to be near enough to each peer at one
    step, and to end with the same bits always."""
    peers = [one for one in series if one.code.name != "tsubu" and one.cores == series[0].cores]
    work, wrong = series[0].work.name, []
    print(f"\n{work}: kinetic energy of translation, J" +
          (", and the difference from " + ", ".join(peer.name for peer in peers) if peers else ""))
    for one in series:
        print(f"  {one.name}, {cores_in_words(one.cores)}")
        for step, energy in sorted(one.runs[0].energies.items()):
            words = []
            for peer in peers:
                if step not in peer.runs[0].energies:
                    continue
                theirs = peer.runs[0].energies[step]
                difference = energy / theirs - 1 if theirs else energy
                words.append(f"{difference:+8.3%}")
                if one.code.name == "tsubu" and step == judged(peer.runs[0].energies, tolerances):
                    allowed = tolerances.of(peer.code.name)
                    near = abs(difference) <= allowed  # not if it is not a number
                    words.append(f"(within {allowed:.2%})" if near else f"(MORE THAN {allowed:.2%})")
                    if not near:
                        wrong.append(f"{work}, {one.name}: the kinetic energy is {difference:+.3%} from that of {peer.name} after {step} steps.")
            print(f"    {step:>6}  {energy:.5e}  " + "  ".join(words))
    for peer in peers:
        if judged(peer.runs[0].energies, tolerances) not in series[0].runs[0].energies:
            wrong.append(f"{work}: nothing was compared with {peer.name}.")
    hashes = {run.state_hash for one in series if one.code.name == "tsubu" for run in one.runs}
    if len(hashes) > 1:
        wrong.append(f"{work}: tsubu ended with different bits, {', '.join(sorted(hashes))}.")
    elif hashes:
        print(f"  every run of tsubu ended with the state {next(iter(hashes))}")
    return wrong


@dataclass(frozen=True)
class Tolerances:
    """How far kinetic energies may be from those of each peer, relatively, up to step `last`."""
    by_peer: dict
    factor: float = 1
    last: int = bed.OUTPUT_EVERY

    def of(self, peer):
        return self.factor * self.by_peer[peer]


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
    for sentence in failed:
        print(f"WRONG: {sentence}")


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
