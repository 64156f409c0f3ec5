#!/usr/bin/env python3
"""The costs of features, from the numbers of bench/step, as `tsubu explain` shows them.

    build/release/bench/step --benchmark_filter='-^(two|portable|avx)' --benchmark_repetitions=5 \\
        --benchmark_enable_random_interleaving=true --benchmark_min_time=0.3 --benchmark_out=costs.json
    bench/costs.py costs.json > bench/costs.csv

CPU time of the fastest repetition: what else runs on the machine can only add to it.
"""
import csv
import json
import sys


def main(path):
    with open(path) as file:
        told = json.load(file)
    context, runs = told["context"], [run for run in told["benchmarks"] if run["run_type"] == "iteration"]
    rows = {}
    for run in runs:
        feature, _, base = run["run_name"].removesuffix("/real_time").partition(" | ")
        ns = run["cpu_time"] * 1e6 / run["grain_steps"]
        if feature not in rows or ns < rows[feature]["ns"]:
            rows[feature] = {"base": base, "ns": ns, "grain": run["bytes/grain"], "contact": run["bytes/contact"], "hash": run["label"]}
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(["feature", "compared_with", "ns_per_grain_step", "ns_added", "bytes_per_grain_added", "bytes_per_contact_added", "state_hash",
                  "machine", "isa"])
    for feature, row in sorted(rows.items(), key=lambda item: (item[1]["base"] != "", item[0])):
        if row["base"] and row["base"] not in rows:
            sys.exit(f"'{feature}' is compared with '{row['base']}', which was not measured")
        base = rows.get(row["base"], {"ns": 0, "grain": 0, "contact": 0})
        out.writerow([feature, row["base"], f"{row['ns']:.1f}", f"{row['ns'] - base['ns']:.1f}", round(row["grain"] - base["grain"]),
                      round(row["contact"] - base["contact"]), row["hash"], context["processor"], context["isa"]])


if __name__ == "__main__":
    main(sys.argv[1])
