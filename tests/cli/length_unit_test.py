"""--unit: the unit of length of an input that names none."""
import json

from program import CliTest


class LengthUnit(CliTest):
    QUICK = ("--set", "immobility.provers=[]", "--set", "objective=[]", "--set", "layout.enabled=false")

    def setUp(self):
        super().setUp()
        self.run_program("sample", "peg_in_hole", "-o", "peg", status=0)

    def unit_of(self, *options):
        self.run_program("plan", "peg", "-o", "out", *self.QUICK, *options, status=0)
        return json.loads(self.read("out", "plan.json"))["assembly"].get("unit", "")

    def test_it_is_stated_in_the_plan(self):
        self.assertEqual(self.unit_of(), "")
        self.assertEqual(self.unit_of("--unit", "Inches"), "inch")
        self.run_program("verify", "out/plan.json", status=0)
        self.assertIn("inch", self.run_program("export", "out/plan.json", "--format", "markdown", "-o", "-", status=0).stdout)

    def test_a_word_that_is_no_unit(self):
        failed = self.run_program("plan", "peg", "-o", "out", "--unit", "parsec", status=2)
        self.assertIn("parsec", failed.stderr)
