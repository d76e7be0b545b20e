"""Uses the installed Python module on the input that is named."""
import sys

import dismantle

assembly = dismantle.Assembly.load(sys.argv[1])
plan = dismantle.run(assembly, seed=1)
assert plan.complete and dismantle.verify(plan, assembly).complete
print(dismantle.__file__)
