"""The section on the published code: the paper's algorithms with the paper's settings, assembly by assembly."""
import csv
import os

from .suite_results import is_solved, markdown, number, outcome_of

COMMIT = "29db7df"
TOLERANCE = 0.01
SUITES = ["paper_translation", "paper_rotation", "paper_sequence"]
DEFAULTS = ["guided", "blocking"]

# Why our run with the paper's settings is weaker: {(assembly, in what): reason}. Only what a look at the run has shown.
THINNING = ("versions up to 27de7cb7 thinned the path by a length of 0.1 instead of a share of the tolerance, so that the verifier refused it "
            "each time until the search gave up")
REASONS = {
    ("cad/factory_nut_bolt_m8_loose", "success"): "the nut came off in the simulation (55 % of the largest edge away within a minute), but the verifier "
                                                  "refused the path where it cuts into the thread, and the search began again with this place as a "
                                                  "contact; with `simulator.contact_threshold=0.001` (0.005 here, 0.01 in the paper) it is solved in 73 s",
    ("two_part/dovetail_blind", "success"): THINNING,
    ("two_part/skew_peg", "success"): THINNING,
    ("two_part/zslot_4step", "success"): THINNING,
    ("threads/m6_left_hand_long_nut", "time"): "distances are exact, to triangles, in every step: with `simulator.distance=grid`, as published, "
                                               "it takes 53 s",
}


def published():
    with open(os.path.join(os.path.dirname(__file__), "..", "published_results.csv"), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def published_solved(row):
    return not row["result"].startswith("not")


def depth_text(row):
    """Depths that our verifier would refuse are marked. An overlap of the parts as assembled is none of the path's."""
    refused = row["depth"] and "as assembled" not in row["depth"] and float(row["depth"].split()[0]) > TOLERANCE
    return row["depth"] + (" (refused)" if refused else "")


def trial_of(all_results, assembly, planners):
    for results in all_results:
        for t in results.trials:
            if t["assembly"] == assembly and t["planner"] in planners:
                return t
    return None


def result_text(trial):
    if trial is None:
        return "not run"
    if not is_solved(trial):
        return f"*{outcome_of(trial)}*"
    removed = int(trial["removed"])
    return "solved, verified" if removed < 2 else f"{removed} of {removed}, verified"


def cells(trial):
    """Result, CPU s, simulated steps, depth that the verifier certifies."""
    if trial is None:
        return ["not run", "", "", ""]
    steps = trial.get("counts.steps", "")
    return [result_text(trial), number(float(trial["cpu s"])), f"{float(steps):.0f}" if steps else "-",
            trial["deepest"] if is_solved(trial) else "-"]


def weaker(row, trial):
    """In what our run is weaker than the published one: words of `REASONS`."""
    if trial is None:
        return []
    if not is_solved(trial):
        return ["success"] if published_solved(row) else []
    if not published_solved(row):
        return []
    out = []
    if float(trial["cpu s"]) > float(row["plan s"]) + float(row["build s"]):
        out.append("time")
    if float(trial.get("counts.steps") or 0) > float(row["steps"]):
        out.append("steps")
    return out


def reason_of(trial, row, what):
    known = REASONS.get((row["assembly"], what))
    seen = trial["last words"].strip()
    if what == "success":
        ended = f"ended with `{outcome_of(trial)}` after {number(float(trial['cpu s']))} s" + (f" ({seen})" if seen else "")
    elif what == "time":
        ended = f"{number(float(trial['cpu s']))} s, published {number(float(row['plan s']) + float(row['build s']))} s with its distance fields"
    else:
        ended = f"{float(trial['counts.steps']):.0f}, published {row['steps']}"
    return f"- {row['assembly']}, {what}: {ended}; {known or 'not explained'}."


def balance(pairs):
    """What is equal, better and worse, in sentences. `pairs`: (published row, our trial)."""
    run = [(row, t) for row, t in pairs if t is not None]
    if not run:
        return "None of them has been run.\n"
    both = [(r, t) for r, t in run if published_solved(r) and is_solved(t)]
    names = {"better": [r["assembly"] for r, t in run if is_solved(t) and not published_solved(r)],
             "worse": [r["assembly"] for r, t in run if published_solved(r) and not is_solved(t)],
             "neither": [r["assembly"] for r, t in run if not published_solved(r) and not is_solved(t)]}
    words = {"better": "only here", "worse": "only by the published code", "neither": "by neither"}
    text = f"Of {len(run)} assemblies, {len(both)} are solved by both"
    text += "".join(f", {len(n)} {words[kind]} ({', '.join(n)})" for kind, n in names.items() if n)
    text += ". "
    if both:
        faster = sum(float(t["cpu s"]) <= float(r["plan s"]) + float(r["build s"]) for r, t in both)
        fewer = sum(float(t.get("counts.steps") or 0) <= float(r["steps"]) for r, t in both)
        text += (f"Of those of both, {faster} take less CPU time here (the distance fields of the published code included) and {len(both) - faster} more, "
                 f"{fewer} take fewer or as many simulated steps and {len(both) - fewer} more. ")
    marked = sum("(refused)" in depth_text(r) for r, _ in run)
    of = sum(published_solved(r) for r, _ in run)
    return text + (f"{marked} of the {of} published paths {'is' if marked == 1 else 'are'} deeper at a vertex than our verifier allows; "
                   "every path here is certified along its whole length.\n")


def section(all_results, settings):
    """`all_results`: the results of SUITES. `settings`: link to the paper's settings."""
    rows, pairs = [], []
    for row in published():
        mine, default = (trial_of(all_results, row["assembly"], of) for of in (["paper"], DEFAULTS))
        pairs.append((row, mine))
        rows.append([row["assembly"], row["result"], row["plan s"], row["build s"], row["steps"], row["actions"], depth_text(row) or "-",
                     *cells(mine), result_text(default), number(float(default["cpu s"])) if default else "",
                     default["deepest"] if default and is_solved(default) else "-"])
    header = ["assembly", "published", "plan s", "build s", "steps", "actions", "depth", "paper's settings here", "CPU s", "steps", "certified",
              "default planner", "CPU s", "certified"]
    reasons = [reason_of(t, row, what) for row, t in pairs for what in weaker(row, t)]
    text = f"""
## The published code

The paper's algorithms with the paper's settings ([paper.yaml]({settings})) beside what the published code
([Assemble-Them-All](https://github.com/yunshengtian/Assemble-Them-All) at {COMMIT}, unmodified, its defaults, seed 1) did on the same
assemblies, on one core of a machine of this kind. Its plan times leave out the distance fields, "build"; our CPU times contain reading,
preparation and proofs. "Actions" are forces and torques that it applied; 12 of them to choose from where parts turn. Its depth is that of the
deepest *vertex* at 16 sampled poses, a lower bound; it verifies nothing, and depths that our verifier would refuse (more than {TOLERANCE} of an
assembly of size 10) are marked. "Certified" is an upper bound along the whole plan. Our simulator joins time steps (`adaptive`), so a step here
is up to some ten of the published ones.

{balance(pairs)}
{markdown([header, *rows])}"""
    text += "\nWhere the run with the paper's settings is weaker than the published code:\n\n" + "\n".join(reasons) + "\n" if reasons else \
        "\nNo row that was run is weaker than the published code.\n"
    for results in all_results:
        table = f", [{results.name}.csv]({results.name}.csv)" if results.trials else ""
        text += f"\n`{results.name}`: {results.progress()}{table}."
    return text + "\n"
