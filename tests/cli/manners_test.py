"""Completion, manual page, versions, colours, progress, examples: what a command line owes its users."""
import os
import pty
import re
import shutil
import subprocess

from program import PROGRAM, VIEWER, CliTest, text_of_plan

ESCAPE = "\x1b["


def options_of(text):
    """The long options that a --help shows, without --help itself."""
    return set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", text.split("Examples:")[0].split("Example:")[0])) - {"--help"}


class Tree(CliTest):
    """What is made from the parser's tree has all that --help has."""

    def commands(self):
        """Every command with its options, as its own --help says."""
        pending, found = [[]], {}
        while pending:
            path = pending.pop()
            text = self.run_program(*path, "--help", status=0).stdout
            found[tuple(path)] = options_of(text.split("Subcommands:")[0])
            if "Subcommands:" in text:
                below = text.split("Subcommands:")[1]
                pending += [path + [name] for name in re.findall(r"^  ([a-z]+)  ", below, re.M)]
        self.assertIn(("plugins", "describe"), found)
        self.assertIn(("completion", "bash"), found)
        return found

    def complete(self, *words):
        script = "source <(%s completion bash)\nCOMP_WORDS=(dismantle %s)\nCOMP_CWORD=%d\n_dismantle\nprintf '%%s\\n' \"${COMPREPLY[@]}\"" % (
            PROGRAM, " ".join("'%s'" % w for w in words), len(words))
        done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
        self.assertEqual(done.stderr, "")
        return set(done.stdout.split())

    def test_bash_completes_every_command_and_option(self):
        commands = self.commands()
        for path, options in commands.items():
            self.assertEqual({o for o in self.complete(*path, "--") if o != "--help"}, options | ({"--version"} if not path else set()), path)
            below = {p[-1] for p in commands if p[:-1] == path and p != path}
            self.assertLessEqual(below, self.complete(*path, ""), path)
        self.assertEqual(self.complete("plan", "x", "--format", ""), {"text", "json"})
        self.assertEqual(self.complete("plugins", "describe", "x", "--format", "m"), {"markdown"})
        self.assertEqual(self.complete("plan", "-o", ""), set(), "bash completes the names of files")
        self.assertIn("--seed", self.complete("plan", "verify", "--s"), "an argument that is called like a command is none")

    def test_the_other_scripts_and_the_manual_page_name_all(self):
        texts = {what: self.run_program(*what.split(), status=0).stdout for what in ("completion zsh", "completion fish", "manual-page")}
        for path, options in self.commands().items():
            for what, text in texts.items():
                text = text.replace("\\-", "-")
                for word in [*path, *options]:
                    self.assertIn(word.lstrip("-") if "fish" in what else word, text, what)
        for shell in ("zsh", "fish"):
            if shutil.which(shell):
                self.write("script", texts["completion " + shell])
                subprocess.run([shell, "-n", self.path("script")], check=True)
        if shutil.which("groff"):
            done = subprocess.run(["groff", "-man", "-ww", "-Tascii"], input=texts["manual-page"], capture_output=True, text=True, check=True)
            self.assertEqual(done.stderr, "")
            self.assertIn("--path-timeout", re.sub("\x1b\\[[0-9;]*m|.\b", "", done.stdout))
        self.assertNotIn("manual-page", self.run_program("--help", status=0).stdout)

    def test_version_names_the_libraries(self):
        lines = self.run_program("--version", status=0).stdout.splitlines()
        self.assertRegex(lines[0], r"^dismantle \d+\.\d+\.\d+$")
        for library in ("Eigen", "fmt", "nlohmann_json", "yaml-cpp", "CLI11", "assimp", "SQLite"):
            self.assertRegex(lines[1], rf"\b{library} \d+\.\d+")


class Examples(CliTest):
    def test_examples_of_the_help_work(self):
        """Those that need nothing but a sample; in the order in which they stand."""
        self.run_program("sample", "machine", "-o", "gearbox", status=0)
        self.run_program("plan", "gearbox", "-o", "out", "-q", status=0)
        ran = 0
        for command in ("plan", "check", "prepare", "verify", "explain", "view", "sample", "plugins list", "plugins describe"):
            text = self.run_program(*command.split(), "--help", status=0).stdout
            examples = re.findall(r"^  (\S*.*\bdismantle .*)$", re.split(r"Examples?:\n", text)[1], re.M)
            self.assertTrue(examples, command)
            for example in examples:
                if command == "view" and not VIEWER:
                    continue
                folder = os.path.join(self.folder, "bin")
                os.makedirs(folder, exist_ok=True)
                if not os.path.exists(os.path.join(folder, "dismantle")):
                    os.symlink(PROGRAM, os.path.join(folder, "dismantle"))
                done = subprocess.run(["bash", "-o", "pipefail", "-c", example], cwd=self.folder, capture_output=True, text=True, timeout=300,
                                      env={**os.environ, "PATH": folder + ":" + os.environ["PATH"]})
                self.assertEqual(done.returncode, 0, f"{example}\n{done.stdout}{done.stderr}")
                ran += 1
        self.assertGreater(ran, 9)


class Terminals(CliTest):
    def setUp(self):
        super().setUp()
        self.run_program("sample", "machine", "-o", "machine", "--set", "parts=5", status=0)

    def on_terminal(self, *arguments, **environment):
        """Standard error as a terminal gets it."""
        master, slave = pty.openpty()
        environment = {**os.environ, "TERM": "xterm", **environment}
        environment = {k: v for k, v in environment.items() if v is not None}
        process = subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stdout=subprocess.PIPE, stderr=slave, stdin=subprocess.DEVNULL, env=environment)
        os.close(slave)
        text = b""
        while True:
            try:
                block = os.read(master, 65536)
            except OSError:  # the other end is closed
                break
            if not block:
                break
            text += block
        os.close(master)
        output = process.stdout.read().decode()
        process.stdout.close()
        process.wait()
        return text.decode(), output

    def test_colours_only_on_terminals_that_want_them(self):
        said, output = self.on_terminal("plan", "nowhere", NO_COLOR=None)
        self.assertIn("\x1b[1;31merror:", said)
        self.assertEqual(output, "")
        for environment in ({"NO_COLOR": "1"}, {"TERM": "dumb", "NO_COLOR": None}):
            said, _ = self.on_terminal("plan", "nowhere", **environment)
            self.assertNotIn(ESCAPE, said)
        said, output = self.on_terminal("plan", "machine", NO_COLOR="")
        self.assertIn("\x1b[1;32m[", said, "the bar is green; an empty NO_COLOR is none")
        self.assertNotIn(ESCAPE, output)
        said, _ = self.on_terminal("plan", "machine", NO_COLOR="1")
        self.assertIn("\r[", said, "a bar without colours is still a bar")
        self.assertNotIn("\x1b[1", said)
        done = self.run_program("plan", "machine", status=0)
        self.assertNotIn("\x1b", done.stdout + done.stderr)
        self.assertNotIn("\r", done.stdout + done.stderr)

    def test_one_plain_line_per_event(self):
        done = self.run_program("plan", "machine", status=0)
        lines = done.stderr.splitlines()
        self.assertEqual([l for l in lines if l.startswith("step ")], [l for l in lines if re.match(r"step \d+: \S+ out, \d+ left", l)])
        self.assertEqual(len([l for l in lines if l.startswith("step ")]), 4)
        self.assertTrue(all(l.strip() for l in lines))


class Counters(CliTest):
    def test_the_summary_speaks_plainly_and_json_has_all(self):
        self.run_program("sample", "machine", "-o", "machine", "--set", "parts=5", status=0)
        text = self.run_program("plan", "machine", status=0).stdout
        for word in ("relations", "spared", "remembered", "proposed", "_steps"):
            self.assertNotIn(word, text)
        self.assertIn("counters:", self.run_program("plan", "machine", "-v", status=0).stdout)
        result = self.result_of(self.run_program("plan", "machine", "--format", "json", status=0))
        for key in ("searches", "remembered", "proposed", "refused", "relations"):
            self.assertIn(key, result["counters"])


class Explanations(CliTest):
    def test_part_json_and_lengths(self):
        self.write("plan.json", text_of_plan())
        result = self.result_of(self.run_program("explain", "plan.json", "--format", "json", status=0))
        self.assertEqual([p["part"] for r in result["left"] for p in r["parts"]], ["a"])
        self.assertEqual(result["untried"], ["b"])
        self.assertAlmostEqual(result["left"][0]["parts"][0]["travel"], 0.25)
        self.assertTrue(result["left"][0]["advice"])
        text = self.run_program("explain", "plan.json", "--part", "b", status=0).stdout
        self.assertNotIn("a did not", text)
        self.assert_fails(3, "was left out of the plan: not watertight", "explain", "plan.json", "--part", "foil")
        self.assert_fails(3, "its parts: a, b", "explain", "plan.json", "--part", "zzzzz")

    def test_advice_names_the_value_of_the_run(self):
        self.run_program("sample", "zigzag", "-o", "zigzag", status=0)
        self.run_program("plan", "zigzag", "-o", "out", "-q", "--sequence-planner", "progressive", "--path-planner", "contact_search", "--path-timeout", "0",
                         "--set", "sequence_planner.max_depth=1", "--set", "run.path_steps=3000", "--set", "run.force=off", status=1)
        text = self.run_program("explain", "out/plan.json", status=0).stdout
        for words in ("2 parts did not come out", "1 search by contact_search to depth 1", "blocked by: housing at (",
                      "`--set sequence_planner.max_depth=2`, key sequence_planner.max_depth (was 1)", "--path-planner guided"):
            self.assertIn(words, text)
        self.assertNotIn("assembly units", text)

    def test_why_this_order(self):
        self.run_program("sample", "stacked_box", "-o", "stack", status=0)
        self.run_program("plan", "stack", "-o", "out", "-q", status=0)
        text = self.run_program("explain", "out/plan.json", status=0).stdout
        self.assertIn("every part came out", text)
        self.assertRegex(text, r"needed step 1 \(\S+\) first")
