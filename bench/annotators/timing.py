#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Times suggestion and band for the phantom's liver: PYTHONPATH=build/release/python bench/annotators/timing.py [THREADS]

The least of ten runs each, in ms, whatever is prepared for them included but for the samples, which `segment` takes by itself.
"""
import sys
import time

import kontur


def least_ms(run, rounds=10):
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        run()
        times.append(1000 * (time.perf_counter() - start))
    return min(times)


def main():
    threads = int(sys.argv[1]) if len(sys.argv) > 1 else 2
    case = kontur.phantom_case("liver_orthogonal14")
    liver = kontur.segment(case.contours, case.grid, mesh=True, threads=threads)
    suggestion = least_ms(lambda: kontur.suggest_planes(liver, case.contours, grid=case.grid, threads=threads))
    band = least_ms(lambda: kontur.half_widths_mm(liver, case.contours, liver.mesh.points, threads=threads))
    print(f"{liver.report.centres} centres, {threads} threads: a suggestion {suggestion:.1f} ms; "
          f"the band at {len(liver.mesh.points)} points {band:.1f} ms")
    print(f"measuring the result, samples included, takes {1000 * liver.report.seconds['measure']:.0f} ms of segment's "
          f"{1000 * sum(liver.report.seconds.values()):.0f}")


if __name__ == "__main__":
    main()
