"""The gate itself: what is worse fails and is never recorded by accident. A script takes the place of the program."""
import contextlib
import csv
import io
import json
import os
import pathlib
import tempfile
import unittest
import unittest.mock

import gate

PLANNED = {"exit": "1", "status": "forced", "parts": "4", "removed": "3", "full_proofs": "1", "reduced_proofs": "0",
           "order": "lid > clip > pin", "forced": "2: clip into ledge 0.5"}
PROOF = ("clip ledge", "hook", "yes")
# Answers `plan` and `verify` with what answer.json beside it holds, `sample` with nothing.
PROGRAM = """#!/usr/bin/env python3
import json, pathlib, sys
answer = json.loads((pathlib.Path(__file__).parent / "answer.json").read_text())
if sys.argv[1] == "sample":
    sys.exit(0)
if sys.argv[1] == "verify":
    print(json.dumps({"problems": answer["problems"]}))
    sys.exit(1)
(pathlib.Path(__file__).parent / "arguments.json").write_text(json.dumps(sys.argv))
target = pathlib.Path(sys.argv[sys.argv.index("-o") + 1])
target.mkdir(parents=True)
(target / "plan.json").write_text(json.dumps(answer["plan"]))
print(json.dumps({"removed": answer["removed"], "cpu_seconds": 0.5, "status": answer["plan"]["status"]}))
sys.exit(answer["exit"])
"""


def step(number, *parts, forced=None):
    made = {"step": number, "separates": [list(parts)], "moves": [{"part": p} for p in parts]}
    return made | ({"forced": {"pair": forced[:2], "depth": forced[2]}} if forced else {})


def answer(**changes):
    """What the program says for PLANNED."""
    plan = {"status": "forced", "assembly": {"parts": [{}] * 4},
            "disassembly": [step(1, "lid"), step(2, "clip", forced=("clip", "ledge", 0.5)), step(3, "pin")],
            "certificates": [{"parts": ["clip", "ledge"], "kind": "hook", "full_tolerance": True}]}
    return {"exit": changes.pop("exit", 1), "removed": changes.pop("removed", 3), "problems": changes.pop("problems", []),
            "plan": plan | changes}


class Comparison(unittest.TestCase):
    def verdict(self, proofs=(PROOF,), **changes):
        return gate.verdict_of(gate.compare(PLANNED, PLANNED | changes, [PROOF], list(proofs)))

    def test_the_same_is_the_same(self):
        self.assertEqual(self.verdict(), "same")

    def test_fewer_parts_removed_is_worse(self):
        self.assertEqual(self.verdict(removed="2", status="partial", order="lid > clip"), "worse")

    def test_a_complete_plan_is_better(self):
        self.assertEqual(self.verdict(proofs=(), exit="0", status="complete", forced="", full_proofs="0"), "better")

    def test_status_and_exit_status(self):
        self.assertEqual(self.verdict(status="partial"), "worse")
        self.assertEqual(self.verdict(status="complete"), "better")
        self.assertEqual(self.verdict(exit="3"), "worse")
        self.assertEqual(self.verdict(parts="3"), "worse")

    def test_forced_steps(self):
        self.assertEqual(self.verdict(forced="2: clip into ledge 0.52"), "worse")
        self.assertEqual(self.verdict(forced="2: clip into ledge 0.48"), "better")
        self.assertEqual(self.verdict(forced="2: clip into ledge 0.501"), "different")
        self.assertEqual(self.verdict(forced="3: clip into ledge 0.5"), "different")
        self.assertEqual(self.verdict(forced=""), "better")
        self.assertEqual(self.verdict(forced="1: lid into ledge 0.1; 2: clip into ledge 0.3"), "worse")

    def test_fewer_but_deeper_forced_steps_are_worse(self):
        two = PLANNED | {"forced": "1: lid into ledge 0.4; 2: clip into ledge 0.4"}
        findings = gate.compare(two, PLANNED | {"forced": "2: clip into ledge 0.6"}, [PROOF], [PROOF])
        self.assertEqual(gate.verdict_of(findings), "worse")

    def test_another_order_is_different(self):
        self.assertEqual(self.verdict(order="pin > clip > lid"), "different")

    def test_proofs(self):
        reduced = ("clip ledge", "hook", "no")
        self.assertEqual(self.verdict(proofs=()), "worse")
        self.assertEqual(self.verdict(proofs=(reduced,)), "worse")
        self.assertEqual(self.verdict(proofs=(PROOF, reduced)), "better")
        self.assertEqual(self.verdict(proofs=(PROOF, ("pin ledge", "ring", "yes"))), "better")
        self.assertEqual(self.verdict(proofs=(("clip ledge", "ring", "yes"),)), "different")

    def test_a_lost_proof_does_not_hide_behind_a_lost_part(self):
        findings = gate.compare(PLANNED, PLANNED | {"removed": "2"}, [PROOF], [])
        self.assertEqual({f.field for f in findings if f.verdict == "worse"}, {"removed", "proofs"})


class WholeGate(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="dismantle-gate-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = self.folder / "program"
        self.program.write_text(PROGRAM)
        self.program.chmod(0o755)
        (self.folder / "data" / "cad" / "lamp").mkdir(parents=True)
        self.write_tables(["cad/lamp"])
        self.answer()

    def write_tables(self, assemblies, **changes):
        row = {"set": "quick", "configuration": "default", "tolerance": "0.01", "path_steps": "100"}
        gate.write_table(self.folder / "expected.csv", gate.COLUMNS,
                         [dict.fromkeys(gate.COLUMNS, "") | row | PLANNED | {"assembly": a} | changes for a in assemblies])
        gate.write_table(self.folder / "proofs.csv", gate.PROOF_COLUMNS,
                         [dict(zip(gate.PROOF_COLUMNS, (a, "default", "0.01", *PROOF))) for a in assemblies])

    def answer(self, **changes):
        (self.folder / "answer.json").write_text(json.dumps(answer(**changes)))

    def run_gate(self, *options):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            status = gate.main(["--program", str(self.program), "--tables", str(self.folder), "--set", "all",
                                "--data", str(self.folder / "data"), *options])
        return status, out.getvalue()

    def tables(self):
        return [(self.folder / name).read_text() for name in ("expected.csv", "proofs.csv")]

    def assert_fails_and_records_nothing(self, word, *options):
        before = self.tables()
        status, text = self.run_gate(*options)
        self.assertEqual(status, 1, text)
        self.assertIn(word, text)
        self.assertEqual(self.tables(), before)
        return text

    def test_as_recorded(self):
        status, text = self.run_gate()
        self.assertEqual(status, 0, text)
        self.assertEqual(self.run_gate("--jobs", "2", "--assembly", "cad/*", "--tolerance", "0.01")[0], 0)

    def test_the_same_proof_at_two_arrangements_counts_once(self):
        self.answer(certificates=2 * answer()["plan"]["certificates"])
        self.assertEqual(self.run_gate()[0], 0)

    def test_no_seconds_decide(self):
        self.run_gate("--threads", "2")
        command = json.loads((self.folder / "arguments.json").read_text())
        for option, value in (("--path-timeout", "0"), ("--timeout", "0"), ("--threads", "2")):
            self.assertEqual(command[command.index(option) + 1], value)
        self.assertIn("run.path_steps=100", command)
        self.assertIn("verify.max_penetration=0.01", command)

    def test_a_part_that_is_lost_fails(self):
        self.answer(removed=2, status="partial", disassembly=[step(1, "lid"), step(2, "pin")])
        text = self.assert_fails_and_records_nothing("worse", "--record")
        self.assertIn("worse: removed of cad/lamp, default, tolerance 0.01\n        before: 3\n        now:    2\n", text)
        status, _ = self.run_gate("--record", "--accept-worse")
        self.assertEqual(status, 0)
        self.assertEqual(self.run_gate()[0], 0)

    def test_a_better_row_fails_until_it_is_recorded(self):
        self.answer(exit=0, status="complete", certificates=[], disassembly=[step(1, "lid"), step(2, "clip"), step(3, "pin")])
        self.assert_fails_and_records_nothing("record it")
        self.assertEqual(self.run_gate("--record")[0], 0)
        self.assertEqual(self.run_gate()[0], 0)
        with open(self.folder / "expected.csv", newline="") as file:
            row = next(csv.DictReader(file))
        self.assertEqual((row["status"], row["forced"], row["full_proofs"]), ("complete", "", "0"))

    def test_another_order_fails_until_it_is_recorded(self):
        self.answer(disassembly=[step(1, "pin"), step(2, "clip", forced=("clip", "ledge", 0.5)), step(3, "lid")])
        self.assert_fails_and_records_nothing("different: order")
        self.assertEqual(self.run_gate("--record")[0], 0)
        self.assertEqual(self.run_gate()[0], 0)

    def test_a_failure_is_never_recorded(self):
        self.answer(exit=4)
        self.assert_fails_and_records_nothing("exit status 4", "--record", "--accept-worse")

    def test_a_plan_that_verify_refuses_fails(self):
        self.answer(problems=[{"step": 2, "message": "it cuts in deeper"}])
        self.assert_fails_and_records_nothing("it cuts in deeper", "--record", "--accept-worse")

    def test_a_depth_that_depends_on_the_clock_fails(self):
        forced = step(1, "clip", forced=("clip", "ledge", 0.5))
        forced["forced"]["lower_bound"] = True
        self.answer(disassembly=[forced])
        self.assert_fails_and_records_nothing("depends on the clock", "--record")

    def test_a_row_without_result_fails_until_it_is_recorded(self):
        self.write_tables(["cad/lamp"], **dict.fromkeys(gate.FOUND, ""))
        self.assert_fails_and_records_nothing("new")
        self.assertEqual(self.run_gate("--record")[0], 0)
        self.assertEqual(self.run_gate()[0], 0)

    def test_data_that_is_missing_is_skipped_with_a_message(self):
        self.write_tables(["cad/chair"])
        status, text = self.run_gate()
        self.assertEqual(status, gate.SKIPPED)
        self.assertIn(f"{self.folder / 'data' / 'cad' / 'chair'} is not there", text)
        self.write_tables(["cad/chair", "cad/lamp"])
        self.assertEqual(self.run_gate()[0], 0)

    def test_samples_are_never_skipped(self):
        self.write_tables(["sample/peg_in_hole"])
        self.assertEqual(self.run_gate("--input", "samples")[0], 0)
        self.answer(removed=2)
        self.assertEqual(self.run_gate("--input", "samples")[0], 1)

    def test_the_nightly_rows_wait_for_the_night(self):
        self.write_tables(["cad/lamp"], set="nightly")
        with unittest.mock.patch.dict(os.environ, DISMANTLE_TESTS=""), contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(self.run_gate("--set", "auto")[0], 2)
        with unittest.mock.patch.dict(os.environ, DISMANTLE_TESTS="nightly"):
            self.assertEqual(self.run_gate("--set", "auto")[0], 0)


if __name__ == "__main__":
    unittest.main()
