#!/usr/bin/env python3
"""A gate on results: does every assembly still come apart, in the same way, with the same proofs?

    tests/results/gate.py                                  # the quick rows; all rows with DISMANTLE_TESTS=nightly
    tests/results/gate.py --set all --jobs 2
    tests/results/gate.py --assembly 'cad/fb_*' --tolerance 0.001
    tests/results/gate.py --assembly cad/as1_oc_214 --record   # write what is found now into the tables

Plans each row of expected.csv with counted budgets (no seconds decide) and without an objective, verifies the plan, and compares it with the row and
with its proofs in proofs.csv. README.md says what the columns mean and what counts as worse, different and better.
Exit status: 0 all rows are as recorded; 1 some are not; 2 wrong usage; 77 every selected row was skipped.
"""
import argparse
import collections
import concurrent.futures
import csv
import fnmatch
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
KEY = ("assembly", "configuration", "tolerance")
FOUND = ("exit", "status", "parts", "removed", "full_proofs", "reduced_proofs", "order", "forced")
COLUMNS = ("set", *KEY, "path_steps", *FOUND)
PROOF_COLUMNS = (*KEY, "parts", "kind", "full_tolerance")
STATUS = ("error", "interrupted", "partial", "forced", "complete")  # from worst to best
DEPTH_SHARE = 0.01  # forced depths that differ by less are not worse or better, only different
SKIPPED = 77

Finding = collections.namedtuple("Finding", "verdict field before now")


class NoResult(Exception):
    """The row could not be planned."""


# ---- comparing

def by_rank(field, before, now, rank):
    if before == now:
        return []
    a, b = rank(before), rank(now)
    return [Finding("worse" if b < a else "better" if b > a else "different", field, before, now)]


def depths(text):
    return [float(entry.rsplit(" ", 1)[1]) for entry in text.split("; ")] if text else []


def compare_forced(before, now):
    """More forced steps, a deeper deepest one, or a larger sum of depths is worse."""
    if before == now:
        return []
    old, new = depths(before), depths(now)
    signs = {len(new) - len(old)}
    for measure in (sum, lambda d: max(d, default=0)):
        a, b = measure(old), measure(new)
        if abs(b - a) > DEPTH_SHARE * max(a, b):
            signs.add(b - a)
    verdict = "worse" if max(signs) > 0 else "better" if min(signs) < 0 else "different"
    return [Finding(verdict, "forced", before, now)]


def proof_text(proofs):
    return "; ".join(f"{kind} of {parts}" + ("" if full == "yes" else " (reduced tolerance)")
                     for (parts, kind, full), count in sorted(proofs.items()) for _ in range(count)) or "none"


def compare_proofs(before, now, came_apart_further):
    """Fewer proofs with the full tolerance, or as many and fewer others, are worse: unless parts that were stuck leave now."""
    old, new = collections.Counter(before), collections.Counter(now)
    if old == new:
        return []

    def numbers(proofs):
        full = sum(count for (_, _, is_full), count in proofs.items() if is_full == "yes")
        return full, sum(proofs.values()) - full

    verdict = "worse" if numbers(new) < numbers(old) else "better" if numbers(new) > numbers(old) else "different"
    if verdict == "worse" and came_apart_further:
        verdict = "different"
    return [Finding(verdict, "proofs", proof_text(old - new), proof_text(new - old))]


def compare(before, now, proofs_before, proofs_now):
    """All differences of two results of a row. `before` and `now` map FOUND to text, proofs are (parts, kind, full)."""
    findings = by_rank("exit", before["exit"], now["exit"], lambda code: -int(code))
    findings += by_rank("status", before["status"], now["status"], STATUS.index)
    findings += by_rank("parts", before["parts"], now["parts"], int)
    findings += by_rank("removed", before["removed"], now["removed"], int)
    findings += compare_forced(before["forced"], now["forced"])
    further = any(f.verdict == "better" for f in findings) and all(f.verdict != "worse" for f in findings)
    findings += compare_proofs(proofs_before, proofs_now, further)
    if before["order"] != now["order"]:
        findings.append(Finding("different", "order", before["order"], now["order"]))
    return findings


def verdict_of(findings):
    kinds = {f.verdict for f in findings}
    return next((v for v in ("worse", "better", "different") if v in kinds), "same")


# ---- the tables

def read_table(path, columns):
    if not path.exists():
        return []
    with open(path, newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file)
        if tuple(reader.fieldnames or ()) != columns:
            sys.exit(f"{path}: the first line must be {','.join(columns)}")
        return list(reader)


def write_table(path, columns, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def key_of(row):
    return tuple(row[k] for k in KEY)


class Tables:
    def __init__(self, folder):
        self.folder = folder
        self.rows = read_table(folder / "expected.csv", COLUMNS)
        self.proofs = collections.defaultdict(list)
        for row in read_table(folder / "proofs.csv", PROOF_COLUMNS):
            self.proofs[key_of(row)].append((row["parts"], row["kind"], row["full_tolerance"]))
        repeated = [k for k, n in collections.Counter(map(key_of, self.rows)).items() if n > 1]
        if repeated:
            sys.exit(f"{folder / 'expected.csv'}: repeated: {repeated[0]}")

    def record(self, row, found, proofs):
        row.update(found)
        self.proofs[key_of(row)] = proofs

    def write(self):
        write_table(self.folder / "expected.csv", COLUMNS, self.rows)
        write_table(self.folder / "proofs.csv", PROOF_COLUMNS,
                    [dict(zip(PROOF_COLUMNS, (*key_of(row), *proof)))
                     for row in self.rows for proof in self.proofs[key_of(row)]])


# ---- planning a row

def step_text(step):
    """The groups that a step separates; in brackets what it only shifts."""
    groups = ["+".join(sorted(group)) for group in step["separates"]]
    return " | ".join(groups) if groups else "(" + "+".join(sorted(m["part"] for m in step["moves"])) + ")"


def forced_text(plan):
    entries = []
    for step in plan["disassembly"]:
        if forced := step.get("forced"):
            if forced.get("lower_bound"):
                raise NoResult(f"the depth of forced step {step['step']} depends on the clock although no seconds were given")
            entries.append(f"{step['step']}: {forced['pair'][0]} into {forced['pair'][1]} {forced['depth']:.4g}")
    if any("; " in entry for entry in entries):
        raise NoResult("a part's name contains '; ', which separates forced steps in the table")
    return "; ".join(entries)


def found_in(plan, exit_status, summary):
    """FOUND of a plan, and its proofs: each once, at however many arrangements of the parts it was made."""
    proofs = sorted({(" ".join(c["parts"]), c["kind"], "yes" if c["full_tolerance"] else "no") for c in plan.get("certificates", [])})
    full = sum(1 for proof in proofs if proof[2] == "yes")
    found = {"exit": exit_status, "status": plan["status"], "parts": len(plan["assembly"]["parts"]), "removed": summary["removed"],
             "full_proofs": full, "reduced_proofs": len(proofs) - full,
             "order": " > ".join(map(step_text, plan["disassembly"])), "forced": forced_text(plan)}
    return {k: str(v) for k, v in found.items()}, proofs


def configuration_of(row):
    """The option for a file of this folder or of configs; none for `default`, so that older programs can be compared, too."""
    if row["configuration"] == "default":
        return ()
    own = HERE / f"{row['configuration']}.yaml"
    return "-c", own if own.exists() else ROOT / "configs" / own.name


class Planner:
    def __init__(self, arguments, folder):
        self.program, self.data, self.threads = arguments.program, arguments.data, arguments.threads
        self.cpu_limit, self.folder, self.keep = arguments.cpu_limit, folder, arguments.keep

    def call(self, *command):
        limit = (self.cpu_limit, self.cpu_limit + 5)
        return subprocess.run([self.program, *command], stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace",
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, limit))

    def input_of(self, row, out):
        """The input; None: its data is not there. A sample is made now: `sample/NAME [KEY=VALUE]...`."""
        if not row["assembly"].startswith("sample/"):
            path = self.data / row["assembly"]
            return path if path.exists() else None
        name, *settings = row["assembly"].removeprefix("sample/").split()
        done = self.call("sample", name, "-o", out / name, *(a for s in settings for a in ("--set", s)))
        if done.returncode != 0:
            raise NoResult(f"the sample could not be made: {done.stderr.strip()}")
        return out / name

    def plan(self, row):
        """(FOUND, proofs, CPU seconds), or None if the input is not there."""
        out = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        source = self.input_of(row, out)
        if source is None:
            return None
        target = self.keep / "@".join(key_of(row)).replace("/", "_").replace(" ", "_") if self.keep else out / "plan"
        done = self.call("plan", source, *configuration_of(row), "-o", target,
                         "--set", "objective=[]", "--path-timeout", "0", "--timeout", "0", "--set", f"run.path_steps={row['path_steps']}",
                         "--set", f"verify.max_penetration={row['tolerance']}", "--threads", str(self.threads), "-q",
                         "--format", "json")
        if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            raise NoResult(f"stopped after {self.cpu_limit} CPU seconds (--cpu-limit); a smaller path_steps makes a row shorter")
        try:
            summary = json.loads(done.stdout.splitlines()[-1])
        except (IndexError, ValueError):
            summary = {}
        if done.returncode == 3 and summary.get("status") == "error":  # an input that must be refused
            return dict.fromkeys(FOUND, "0") | {"exit": "3", "status": "error", "order": "", "forced": ""}, [], 0.0
        if done.returncode not in (0, 1) or "removed" not in summary:
            raise NoResult(f"exit status {done.returncode}: {done.stderr.strip() or done.stdout.strip()}")
        self.verify(target / "plan.json", source)
        plan = json.loads((target / "plan.json").read_text(encoding="utf-8"))
        return *found_in(plan, done.returncode, summary), summary["cpu_seconds"]

    def verify(self, plan, source):
        """A plan that `verify` refuses is no result, whatever its planner says of it."""
        done = self.call("verify", plan, "--assembly", source, "-q", "--format", "json")
        try:
            problems = json.loads(done.stdout.splitlines()[-1])["problems"]
        except (IndexError, ValueError, KeyError):
            raise NoResult(f"'verify' ended with exit status {done.returncode}: {done.stderr.strip()}") from None
        if problems:
            raise NoResult(f"'verify' refuses the plan: {json.dumps(problems[0])}")


# ---- the gate

def label(row):
    return f"{row['assembly']}, {row['configuration']}, tolerance {row['tolerance']}"


def selected(rows, arguments):
    sets = {"auto": ("quick", "nightly") if os.environ.get("DISMANTLE_TESTS") == "nightly" else ("quick",),
            "all": ("quick", "nightly")}.get(arguments.set, (arguments.set,))
    return [row for row in rows if row["set"] in sets
            and (arguments.input == "all" or (arguments.input == "samples") == row["assembly"].startswith("sample/"))
            and (not arguments.assembly or any(fnmatch.fnmatchcase(row["assembly"], a) for a in arguments.assembly))
            and not (arguments.new and row["exit"])
            and (not arguments.tolerance or row["tolerance"] in arguments.tolerance)]


def show(text, length=600):
    """Long orders are cut: only the beginning is read anyway."""
    return text if len(text) <= length else text[:length] + f"... ({len(text)} characters)"


def show_findings(row, findings):
    for f in findings:
        if f.field == "proofs":
            print(f"    {f.verdict}: proofs of {label(row)}\n        lost:   {show(f.before)}\n        gained: {show(f.now)}")
        else:
            print(f"    {f.verdict}: {f.field} of {label(row)}\n        before: {show(f.before) or '-'}\n        now:    {show(f.now) or '-'}")


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/dismantle")
    parser.add_argument("--tables", type=pathlib.Path, default=HERE, help="folder of expected.csv and proofs.csv")
    parser.add_argument("--data", type=pathlib.Path, default=os.environ.get("DISMANTLE_DATA") or ROOT.parent / "shared" / "data",
                        help="folder of assemblies; default: $DISMANTLE_DATA, else ../shared/data")
    parser.add_argument("--set", choices=("auto", "quick", "nightly", "all"), default="auto",
                        help="auto: quick, or all with DISMANTLE_TESTS=nightly")
    parser.add_argument("--input", choices=("all", "samples", "data"), default="all")
    parser.add_argument("--assembly", action="append", metavar="PATTERN", help="as in a shell: 'burr/*'; may be repeated")
    parser.add_argument("--tolerance", action="append", metavar="T", help="as in the table: 0.001; may be repeated")
    parser.add_argument("--new", action="store_true", help="only rows that have no result yet")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1, help="of each plan; results do not depend on it")
    parser.add_argument("--cpu-limit", type=int, default=1800, metavar="S", help="a row that needs more fails; never a result")
    parser.add_argument("--keep", type=pathlib.Path, metavar="DIR", help="keep the plans there")
    parser.add_argument("--record", action="store_true", help="write results that are new, better or different into the tables")
    parser.add_argument("--accept-worse", action="store_true", help="with --record: also results that are worse")
    options = parser.parse_args(arguments)
    if options.accept_worse and not options.record:
        parser.error("--accept-worse needs --record")
    if not options.program.exists():
        parser.error(f"{options.program} does not exist; build it, or name another with --program")
    options.program = options.program.resolve()
    return options


def judge(row, outcome, tables, arguments):
    """Compares, prints and records. The verdict: same, new, skipped, failed, worse, better, different, recorded."""
    if isinstance(outcome, NoResult):
        print(f"failed     {label(row)}\n    {outcome}", flush=True)
        return "failed"
    if outcome is None:
        if arguments.data.is_dir():  # else one message at the end says it for all rows
            print(f"skipped    {label(row)}: {arguments.data / row['assembly']} is not there", flush=True)
        return "skipped"
    found, proofs, seconds = outcome
    findings = compare(row, found, tables.proofs[key_of(row)], proofs) if row["exit"] else []
    verdict = verdict_of(findings) if row["exit"] else "new"
    hint = {"worse": ": this was lost", "better": ": record it (--record)", "different": ": record it if it is meant (--record)",
            "new": ": record it (--record)"}.get(verdict, "")
    recorded = arguments.record and (verdict in ("new", "better", "different") or (verdict == "worse" and arguments.accept_worse))
    if recorded:
        tables.record(row, found, proofs)
        tables.write()
        hint = ": recorded"
    print(f"{verdict:10} {label(row)}: {found['status']}, {seconds:.2f} CPU s{hint}", flush=True)
    show_findings(row, findings)
    return "recorded" if recorded else verdict


def main(arguments=None):
    arguments = parse(arguments)
    tables = Tables(arguments.tables)
    rows = selected(tables.rows, arguments)
    if not rows:
        print("No row of expected.csv is selected.", file=sys.stderr)
        return 2
    verdicts = collections.Counter()
    with tempfile.TemporaryDirectory(prefix="dismantle-results-") as name:
        planner = Planner(arguments, pathlib.Path(name))

        def outcome_of(row):
            try:
                return planner.plan(row)
            except NoResult as problem:
                return problem

        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            for row, outcome in zip(rows, pool.map(outcome_of, rows)):
                verdicts[judge(row, outcome, tables, arguments)] += 1
    print(f"{len(rows)} rows: " + ", ".join(f"{n} {v}" for v, n in sorted(verdicts.items())))
    if verdicts["skipped"]:
        print(f"{verdicts['skipped']} rows were skipped: their assemblies are not in {arguments.data} (DISMANTLE_DATA names the folder)")
    if verdicts["skipped"] == len(rows):
        return SKIPPED
    return 0 if set(verdicts) <= {"same", "skipped", "recorded"} else 1


if __name__ == "__main__":
    sys.exit(main())
