"""Usage, configuration and input errors: status, message, and the JSON line."""
import json
import os

from program import CliTest, box, text_of_plan


class Usage(CliTest):
    def test_no_arguments(self):
        self.assert_fails(2, "a command is missing; the commands of 'dismantle' are plan, ")
        self.assert_fails(2, "the commands of 'dismantle plugins' are list, describe, check", "plugins")

    def test_what_to_do_next(self):
        self.assert_fails(2, "INPUT is required\nTry 'dismantle plan --help'.", "plan")
        self.assert_fails(2, "--part needs a value\nTry 'dismantle plan --help'.", "plan", "x", "--part")
        self.assert_fails(2, "Try 'dismantle plugins describe --help'.", "plugins", "describe", "x", "--nonsense")
        self.assert_fails(2, "cannot read 'nope.yaml': No such file or directory", "plan", "x", "-c", "nope.yaml")
        self.assert_fails(3, "'dismantle plan INPUT -o DIR' writes DIR/plan.json", "explain", "nope.json")

    def test_unknown_command_and_option(self):
        self.assert_fails(2, "'dissemble'", "dissemble")
        self.assert_fails(2, "did you mean 'verify'", "verifi", "plan.json")
        self.assert_fails(2, "its commands are list, describe, check", "plugins", "test", "x.so")
        self.run_program("plugins", "check", "nothing.of.this.name", status=2)
        self.assert_fails(2, "--fast", "plan", "x", "--fast")
        self.assert_fails(2, "--format", "plan", "x", "--format", "xml")
        self.assert_fails(2, "INPUT", "plan")
        self.run_program("plan", "x", "-q", "-v", status=2)

    def test_commands_that_do_not_exist_are_not_pretended(self):
        self.run_program("draw", "x", status=2)

    def test_usage_errors_in_json(self):
        done = self.run_program("plan", "--format", "json", status=2)
        result = self.result_of(done)
        self.assertEqual(result["status"], "error")
        self.assertIn("INPUT", result["message"])
        self.result_of(self.run_program("plan", "x", "--nonsense", "--format=json", status=2))

    def test_help_shows_options_and_an_example(self):
        commands = (["plan"], ["prepare"], ["verify"], ["explain"], ["plugins"], ["plugins", "list"], ["plugins", "describe"],
                    ["plugins", "check"], ["plugins", "new"],
                    ["sample"], [])
        for command in commands:
            done = self.run_program(*command, "--help", status=0)
            self.assertIn("Example", done.stdout, command)
            self.assertEqual(done.stderr, "")


class NewPlugin(CliTest):
    """What it writes is built and tried by tests/install."""

    def test_a_project_has_the_name_everywhere(self):
        refused = self.run_program("plugins", "new", "x", "--kind", "nothing", "--name", "a.b", status=2)
        kinds = refused.stderr.split("there are templates for ")[1].split("\n")[0].split(", ")
        self.assertLessEqual({"path_planner", "sequence_planner", "step_check", "importer"}, set(kinds))
        for kind in kinds:
            done = self.run_program("plugins", "new", kind, "--kind", kind, "--name", "zeta.two_words.x", status=0)
            self.assertIn("zeta_two_words_x.cpp", done.stdout)
            files = [os.path.join(folder, name) for folder, _, names in os.walk(self.path(kind)) for name in names]
            self.assertIn(self.path(kind, ".github", "workflows", "build.yml"), files)
            for file in files:
                self.assertNotIn("acme", file.lower())
                self.assertNotIn("acme", self.read(file).lower(), file)
            code = self.read(kind, "zeta_two_words_x.cpp")
            self.assertIn("class ZetaTwoWordsX ", code)
            self.assertIn('DISMANTLE_PLUGIN("zeta.two_words.x"', code)

    def test_what_it_refuses(self):
        def new(message, folder, kind, name):
            self.assert_fails(2, message, "plugins", "new", folder, "--kind", kind, "--name", name)
            self.assertFalse(os.path.exists(self.path("new")))
        new("did you mean 'simulator'?", "new", "simulater", "a.b")
        for name in ("rrt", "a.", ".a", "a..b", "Acme.rrt", "acme.2", "acme.r-t", "acme.r t", ""):
            new("words joined by dots", "new", "path_planner", name)
        self.write("full/mine.txt", "mine")
        new("full: holds files already", "full", "path_planner", "a.b")
        self.assertEqual(os.listdir(self.path("full")), ["mine.txt"])
        self.write("file", "x")
        new("file: ", "file", "path_planner", "a.b")
        self.assert_fails(2, "--kind is required", "plugins", "new", "x", "--name", "a.b")
        os.mkdir(self.path("empty"))
        self.run_program("plugins", "new", "empty", "--kind", "importer", "--name", "a.b", status=0)


class Configuration(CliTest):
    def setUp(self):
        super().setUp()
        self.write("in/a.obj", box((0, 0, 0), (1, 1, 1)))
        self.write("in/b.obj", box((2, 0, 0), (3, 1, 1)))

    def test_all_errors_at_once_with_their_places(self):
        self.write("bad.yaml", "schema: 1\nrun:\n  seed: many\n  path_timeuot: 3\npath_planner: {type: bsf}\n")
        done = self.assert_fails(2, "bad.yaml:3:9: error:", "plan", "in", "-c", "bad.yaml")
        self.assertIn("bad.yaml:4:3: error:", done.stderr)
        self.assertIn("path_timeout", done.stderr)
        self.assertIn("bad.yaml:5:", done.stderr)
        self.assertFalse(os.path.exists(self.path("in.plan")), "nothing is made when nothing can be done")
        result = self.result_of(self.run_program("plan", "in", "-c", "bad.yaml", "--format", "json", status=2))
        self.assertIn("bad.yaml:3:9", result["message"])

    def test_missing_file_and_broken_yaml(self):
        self.assert_fails(2, "nowhere.yaml", "plan", "in", "-c", "nowhere.yaml")
        self.write("broken.yaml", "run: [1, 2\n")
        self.assert_fails(2, "broken.yaml", "plan", "in", "-c", "broken.yaml")

    def test_options_that_set_keys(self):
        self.assert_fails(2, "bsf", "plan", "in", "--path-planner", "bsf")
        self.assert_fails(2, "progressive", "plan", "in", "--simulator", "progressive")
        self.assert_fails(2, "--seed", "plan", "in", "--seed", "soon")
        self.assert_fails(2, "unknown key 'sed' in run", "plan", "in", "--set", "run.sed=1")
        self.assert_fails(2, "--timeout", "plan", "in", "--timeout", "-1")

    def test_output_that_cannot_be_written(self):
        self.write("file", "x")
        self.assert_fails(2, "file/out", "plan", "in", "-o", "file/out")
        self.assert_fails(2, "file", "plan", "in", "-o", "file")
        self.assert_fails(2, "file/out", "prepare", "in", "-o", "file/out")
        self.assert_fails(2, "file/out", "sample", "peg_in_hole", "-o", "file/out")


class Input(CliTest):
    def test_missing_and_empty(self):
        self.assert_fails(3, "nowhere", "plan", "nowhere")
        os.mkdir(self.path("empty"))
        self.assert_fails(3, "empty", "plan", "empty")
        self.assert_fails(3, "empty", "prepare", "empty", "-o", "out")
        self.write("notes.txt", "no mesh")
        self.assert_fails(3, "notes.txt", "plan", "notes.txt")

    def test_json_line_on_bad_input(self):
        result = self.result_of(self.run_program("plan", "nowhere", "--format", "json", status=3))
        self.assertEqual(result["status"], "error")
        self.assertIn("nowhere", result["message"])
        self.assertIsNone(result["plan"])

    def test_one_part_only_and_broken_files(self):
        self.write("one/a.obj", box((0, 0, 0), (1, 1, 1)))
        self.assert_fails(3, "a", "plan", "one")
        self.write("broken/a.obj", box((0, 0, 0), (1, 1, 1)))
        self.write("broken/b.stl", "solid b\nfacet normal 0 0 1\nouter")
        self.assert_fails(3, "b.stl", "plan", "broken")
        self.assertFalse(os.path.exists(self.path("broken.plan")))

    def test_unknown_part(self):
        self.write("in/a.obj", box((0, 0, 0), (1, 1, 1)))
        self.write("in/b.obj", box((2, 0, 0), (3, 1, 1)))
        self.assert_fails(3, "'nut'", "plan", "in", "--part", "nut", "-q")


class Plans(CliTest):
    def test_verify_and_explain_name_what_is_wrong(self):
        for command in ("verify", "explain"):
            self.assert_fails(3, "nowhere.json", command, "nowhere.json")
            self.assert_fails(3, ".", command, ".")
            self.write("bad.json", "{")
            self.assert_fails(3, "bad.json", command, "bad.json")
            self.write("other.json", '{"format": "else"}')
            self.assert_fails(3, "other.json", command, "other.json")

    def test_explain_says_what_the_plan_knows(self):
        self.write("plan.json", text_of_plan())
        text = self.run_program("explain", "plan.json", status=0).stdout
        for word in ("a did not come out", "depth_limit", "blocked by: b", "0.25 input units (25.0 %", "12 nodes", "not watertight", "without a failed search on record: b"):
            self.assertIn(word, text)

    def test_verify_wants_the_files_that_the_plan_is_for(self):
        self.write("plan.json", text_of_plan())
        self.assert_fails(3, "--assembly", "verify", "plan.json")
        self.write("in/a.obj", box((0, 0, 0), (1, 1, 1)))
        self.write("in/b.obj", box((2, 0, 0), (3, 1, 1)))
        self.assert_fails(3, "SHA-256", "verify", "plan.json", "--assembly", "in")
        result = self.result_of(self.run_program("verify", "plan.json", "--assembly", "in", "--format", "json", status=3))
        self.assertIn("SHA-256", result["message"])


class Plugins(CliTest):
    def test_list_names_every_kind(self):
        text = self.run_program("plugins", "list", status=0).stdout
        for word in ("simulator", "path_planner", "sequence_planner", "importer"):
            self.assertIn(word, text)

    def test_broken_libraries_are_warnings(self):
        self.write("more/libbroken.so", "not a library")
        done = self.run_program("plugins", "list", status=0,
                                env={"DISMANTLE_PLUGIN_PATH": os.environ["DISMANTLE_PLUGIN_PATH"] + ":" + self.path("more")})
        self.assertIn("libbroken.so", done.stderr)
        self.assertIn("simulator", done.stdout)

    def test_describe(self):
        first = self.run_program("plugins", "list", status=0).stdout.split()[0]
        self.assertIn(first, self.run_program("plugins", "describe", first, status=0).stdout)
        self.assertIn("#", self.run_program("plugins", "describe", first, "--format", "markdown", status=0).stdout)
        described = json.loads(self.run_program("plugins", "describe", first, "--format", "json", status=0).stdout)
        self.assertEqual(described["id"], first)
        self.assert_fails(2, "no_such_thing", "plugins", "describe", "no_such_thing")


    def test_the_size_of_the_assembly_has_a_range(self):
        self.run_program("sample", "l_slot", "-o", "in", status=0)
        for size in ("0", "-1", "1e9"):
            self.assert_fails(2, "assembly.size must be in [0.01, 10000]", "plan", "in", "-o", "out", "--set", f"assembly.size={size}")


class Samples(CliTest):
    def test_every_sample_can_be_made_and_prepared(self):
        text = self.run_program("sample", "list", status=0).stdout
        names = [line.split(":")[0] for line in text.splitlines() if not line.startswith(" ")]
        self.assertGreater(len(names), 5)
        for name in names:
            self.run_program("sample", name, "-o", name, status=0)
            self.assertGreaterEqual(len(os.listdir(self.path(name))), 2, name)
        done = self.run_program("prepare", names[0], "-o", "clean", "--format", "json", status=0)
        result = self.result_of(done)
        self.assertEqual(result["status"], "complete")
        self.assertEqual(result["parts"], len(os.listdir(self.path(names[0]))))
        self.assertTrue(os.path.exists(self.path(result["report"])))

    def test_mistakes_are_named(self):
        self.assert_fails(2, "-o", "sample", "machine")
        self.assert_fails(2, "did you mean 'machine'", "sample", "machin", "-o", "out")
        self.assert_fails(2, "did you mean 'parts'", "sample", "machine", "-o", "out", "--set", "part=3")
        self.assert_fails(2, "whole number", "sample", "machine", "-o", "out", "--set", "parts=few")
        self.assert_fails(2, "parts", "sample", "machine", "-o", "out", "--set", "parts=1")
        self.assert_fails(2, "KEY=VALUE", "sample", "machine", "-o", "out", "--set", "parts")
        self.assertFalse(os.path.exists(self.path("out")))
