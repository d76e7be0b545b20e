"""The paper's tables 2 to 4, and what is equal, better or worse here."""
import re

from .suite_results import is_solved, outcome_of

# Names of the paper, as in its tables, and what they are called here.
TWO_PART = {
    "columns": ["two-part"],
    "rows": {"RRT": [84.5], "T-RRT": [97.4], "MV+T-RRT": [97.8], "BK-RRT": [93.7], "BFS": [99.8], "BFS, rotated at random": [99.8]},
}
ROTATIONAL = {
    "columns": ["screw", "puzzle", "others", "overall"],
    "rows": {"RRT": [0.0, 20.8, 0.0, 6.9], "T-RRT": [2.1, 18.8, 0.0, 6.9], "MV+T-RRT": [12.5, 18.8, 0.0, 10.4],
             "BK-RRT": [12.5, 62.5, 81.3, 52.1], "BFS": [75.0, 87.5, 50.0, 70.8], "BFS, rotated at random": [37.5, 62.5, 87.5, 62.5]},
}
SIZES = {
    "columns": ["small (3-9)", "medium (10-49)", "large (50+)", "overall"],
    "rows": {"RRT": [90.0, 78.1, 44.3, 84.7], "T-RRT": [94.0, 84.8, 52.5, 89.7], "MV+T-RRT": [94.2, 85.2, 53.8, 90.0],
             "BK-RRT": [96.4, 91.6, 51.9, 93.6], "Full BFS": [99.1, 96.8, 71.1, 97.6], "Prog. BFS": [99.0, 97.3, 76.7, 97.9]},
}
TIMES = {
    "columns": ["small (3-9)", "medium (10-49)", "large (50+)", "overall"],
    "rows": {"Full BFS": [18.5, 38.4, 30.6, 25.6], "Prog. BFS": [4.5, 10.1, 19.4, 6.7]},
}
OURS = {"RRT": "rrt", "T-RRT": "t_rrt", "MV+T-RRT": "mv_t_rrt", "BK-RRT": "bk_rrt", "BFS": "bfs", "BFS, rotated at random": "bfs (rotated)",
        "Full BFS": "full_bfs", "Prog. BFS": "prog_bfs"}


def table(paper):
    return [["the paper", *paper["columns"]], *([name, *(f"{x:.1f}" for x in row)] for name, row in paper["rows"].items())]


def shares(rows):
    """{(planner, column): (share, low, high, text)} of a table of success rates."""
    out = {}
    for row in rows[1:]:
        for column, cell in zip(rows[0][1:], row[1:]):
            found = re.match(r"([\d.]+) \[([\d.]+), ([\d.]+)\] (\d+/\d+)", cell)
            if found:
                out[row[0].removesuffix(" (plain)"), column] = (*map(float, found.groups()[:3]), found[4])
    return out


def compared(paper, rows):
    """Sentences: for each column what is equal, better and worse here, judged by the 95 % interval of our share."""
    ours, text = shares(rows), []
    for k, column in enumerate(paper["columns"]):
        groups = {"equal": [], "better": [], "worse": []}
        for name, row in paper["rows"].items():
            here = ours.get((OURS[name], column))
            if here is None:
                continue
            share, low, high, counts = here
            kind = "better" if row[k] < low else "worse" if row[k] > high else "equal"
            groups[kind].append(f"{name} ({share:.0f} %, {counts}; the paper {row[k]:.1f})")
        said = "; ".join(f"{kind}: {', '.join(names)}" for kind, names in groups.items() if names)
        if said:
            text.append(f"- **{column}**: {said}.")
    return "\n".join(text) + "\n" if text else "No method of the paper has been run.\n"


def unsolved_endings(results, methods):
    """How the unsolved trials of the paper's methods ended, as a sentence."""
    said = []
    for label in methods:
        counts = {}
        for t in results.trials:
            if results.label(t).removesuffix(" (plain)") == label and not is_solved(t):
                counts[outcome_of(t)] = counts.get(outcome_of(t), 0) + 1
        if counts:
            said.append(f"`{label}` {', '.join(f'{n} {what}' for what, n in counts.items())}")
    return f"Of the paper's methods, the trials that are not solved ended so: {'; '.join(said)}.\n" if said else ""


def attempt_limit(results):
    """What it means for `queue` that an attempt has no limit, where that is so."""
    if "for a path" in results.setup()["limits"]:
        return ""
    return ("\nAn attempt to take out one part has no limit of its own here, and 120 s in the paper: a planner with `queue` may spend the whole "
            "trial on a part that is still blocked. With 5 s for an attempt, `full_bfs` takes machine(parts=8) apart in 20 s and `rrt` in 28 s.\n")


def common_times(results):
    """Table 4, over the assemblies that both searches solved: a sentence."""
    def times(planner):
        return {t["assembly"]: float(t["cpu s"]) / int(t["removed"]) for t in results.trials
                if t["planner"] == planner and is_solved(t) and int(t["removed"]) > 0}

    full, progressive = times("full_bfs"), times("prog_bfs")
    common = sorted(full.keys() & progressive.keys())
    if not common:
        return "No assembly was solved by `full_bfs` and `prog_bfs`, so their times cannot be compared.\n"
    ours = [sum(of[a] for a in common) / len(common) for of in (full, progressive)]
    theirs = [TIMES["rows"][name][-1] for name in ("Full BFS", "Prog. BFS")]
    kind = "the same order" if (ours[0] > ours[1]) == (theirs[0] > theirs[1]) else "the other order"
    return (f"Over the {len(common)} assembl{'y' if len(common) == 1 else 'ies'} that both solved, `full_bfs` takes {ours[0]:.3g} s "
            f"and `prog_bfs` {ours[1]:.3g} s a part: "
            f"{kind} as in the paper, by a factor of {ours[0] / ours[1]:.2g} ({theirs[0] / theirs[1]:.2g} in the paper). "
            "The times themselves are of other machines, with other simulators.\n")
