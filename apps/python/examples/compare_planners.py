"""Plots a comparison of planners from benchmark databases: success with confidence intervals, and success over time.

    python3 compare_planners.py RESULTS... -o comparison.png

RESULTS: databases, or folders with databases, as `dismantle bench` and dismantle.bench() write them.
"""
import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of the backend)
import numpy as np  # noqa: E402

import dismantle  # noqa: E402


def wilson(hits, n, z=1.959964):
    """95 % confidence interval of a share: (low, high)."""
    share = hits / n
    middle = (share + z * z / (2 * n)) / (1 + z * z / n)
    half = z * np.sqrt(share * (1 - share) / n + z * z / (4 * n * n)) / (1 + z * z / n)
    return middle - half, middle + half


def success_of(results):
    """Planner to (solved, trials); only what the verifier accepted counts."""
    good = results["solved"] & (results["verified"] == True)  # noqa: E712  (an array of objects)
    return {str(p): (int(good[results["planner"] == p].sum()), int((results["planner"] == p).sum()))
            for p in sorted(set(results["planner"]))}


def times_of(results, planner):
    """Seconds after which the solved trials of a planner were solved, ascending."""
    good = results["solved"] & (results["verified"] == True) & (results["planner"] == planner)  # noqa: E712
    return np.sort(results["solve_seconds"][good])


def plot(results):
    success = success_of(results)
    figure, (shares, curves) = plt.subplots(1, 2, figsize=(11, 4.5), constrained_layout=True)
    for row, (planner, (hits, n)) in enumerate(success.items()):
        low, high = wilson(hits, n)
        shares.barh(row, hits / n, color=f"C{row}")
        shares.errorbar(hits / n, row, xerr=[[max(hits / n - low, 0)], [max(high - hits / n, 0)]], color="black", capsize=4)
        times = times_of(results, planner)
        curves.step(np.concatenate([[0], times]), np.arange(len(times) + 1) / n, where="post", label=planner, color=f"C{row}")
    shares.set_yticks(range(len(success)), [f"{p} ({n} trials)" for p, (_, n) in success.items()])
    shares.set(xlim=(0, 1), xlabel="share solved and verified, with 95 % interval", title="Success")
    curves.set(ylim=(0, 1.02), xlabel="seconds", ylabel="share solved", title="Success over time")
    curves.legend(loc="lower right")
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", nargs="+")
    parser.add_argument("-o", "--output", default="comparison.png")
    arguments = parser.parse_args()
    results = dismantle.read_results(*arguments.results)
    for planner, (hits, n) in success_of(results).items():
        print(f"{planner}: {hits} of {n} solved and verified")
    plot(results).savefig(arguments.output, dpi=120)
    print(f"wrote {arguments.output}")


if __name__ == "__main__":
    main()
