"""The examples in help texts and documents: every sub-command, option and key that they use is there."""
import pathlib
import re

from program import CliTest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
COMMAND = re.compile(r"(?:^|[\s`(/\"])dismantle ((?:[a-z]+ )*[a-z]+)(?= |$|`)([^`\n#|;]*)")


class Examples(CliTest):
    def commands(self):
        """Names of all sub-commands, from the program's own help."""
        told = self.run_program("no_such_command", status=2).stderr
        return re.findall("[a-z]+", told.split("its commands are", 1)[1])

    def texts(self):
        for document in DOCUMENTS:
            yield document.name, document.read_text()
        for command in self.commands():
            yield f"{command} --help", self.run_program(command, "--help", status=0).stdout

    def test_options_of_examples_are_options_of_their_command(self):
        commands = self.commands()
        self.assertIn("plan", commands)
        helps = {c: self.run_program(c, "--help", status=0).stdout for c in commands}
        tried = 0
        for place, text in self.texts():
            for words, rest in COMMAND.findall(text):
                command = words.split()[0]
                if command not in commands:
                    continue  # prose
                told = helps[command]
                for sub in words.split()[1:2]:
                    if re.search(rf"^  {sub}\s", told, re.MULTILINE):
                        told += self.run_program(command, sub, "--help", status=0).stdout
                for option in re.findall(r"(?<=\s)--[a-z][a-z-]*", rest):
                    tried += 1
                    with self.subTest(place, example=f"dismantle {words}{rest}"):
                        self.assertRegex(told, rf"{re.escape(option)}\b")
        self.assertGreater(tried, 20)

    def test_keys_of_examples_are_accepted(self):
        self.run_program("sample", "stacked_box", "-o", "in", "-q", status=0)
        found = set()
        for place, text in self.texts():
            if place.startswith("write-a-"):
                continue  # keys of the reader's own plugin
            found |= {(place, s) for s in re.findall(r"--set ([a-z_]+\.[a-z_.]+=[A-Za-z0-9_.]+)", text)}
        self.assertTrue(found)
        for place, setting in sorted(found):
            with self.subTest(place, setting=setting):
                done = self.run_program("plan", "in", "-o", "out", "-q", "--timeout", "20", "--set", setting)
                self.assertIn(done.returncode, (0, 1), done.stderr)
