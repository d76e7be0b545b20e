"""Proofs of third parties: where their checker is not found, they are not checked, and verify says so."""
import json

from program import CliTest


class ThirdParty(CliTest):
    def test_a_proof_that_nothing_here_can_check_is_not_checked(self):
        self.run_program("sample", "closed_box", "-o", "box", status=0)
        self.run_program("plan", "box", "-o", "out", "--set", "run.force=off", status=1)
        plan = json.loads(self.read("out/plan.json"))
        self.assertTrue(plan["certificates"])
        for certificate in plan["certificates"]:
            certificate["kind"] = "acme.unknown"
        self.write("out/plan.json", json.dumps(plan))
        said = self.run_program("verify", "out/plan.json", status=1).stdout
        self.assertIn("not checked here: certificate 0: there is no immobility prover 'acme.unknown'", said)
        self.assertIn("The plan is valid", said)
        self.assert_fails(2, "nowhere.yaml", "verify", "out/plan.json", "-c", "nowhere.yaml")
