#!/usr/bin/env python3
"""Writes docs/gallery.md and its pictures (docs/images/gallery) from samples and from a folder of test assemblies.

  tools/make_gallery.py --data DIR [--program build/release/bin/dismantle] [--work build/gallery] [--only NAME]...

DIR contains `step/` and `cad/` with the assemblies of ENTRIES; missing assemblies are left out of the page. Plans are kept in
the work folder and reused: delete it for new plans. Needs node, Chromium, and the viewer (built with the project)."""
import argparse
import json
import os
import subprocess
import sys

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))

# Name, title, input (a sample with its options, or a path below DIR), author, description, options of `plan`, viewer shots.
ENTRIES = [
    ("as1_oc_214", "Plate with brackets, bolts and nuts", "step/as1_oc_214.stp", "CAx-IF public test case, BSD-3-Clause",
     "One STEP file with repeated parts and colours: 18 parts of 5 shapes.", [],
     [{"explode": 1}, {"step": 11, "share": 0.55, "refit": True}]),
    ("gripper", "A servo gripper", "step/or_gripper.step", "OpenRobotics, MIT",
     "144 solids of one STEP file, screws and bought-in parts included.", ["--timeout", "300"],
     [{"explode": 1}, {"mode": "assembly", "step": 40, "share": 0.5}]),
    ("chair", "A chair", "cad/ikea_chair_sigurd", "CC-BY-4.0", "A folder of OBJ files, one part each.", [],
     [{"explode": 1, "up": "y"}, {"step": 3, "share": 0.5, "up": "y"}]),
    ("mykroscope", "What does not come out, and why", "step/mykroscope.step", "Mykroscope, Apache-2.0",
     "Made with `--set run.force=off`: parts that are enclosed or clipped in CAD stay. The page shows how far each came, what holds it, the proof if there is one, and what to do.",
     ["--timeout", "150", "--set", "run.force=off"], [{"whole": True, "problem": 1, "size": [1280, 760]}, {"explode": 1}]),
    ("machine", "A machine of any number of parts", ["machine", "--set", "parts=24"], "made by `dismantle sample machine`",
     "Shafts, washers, forks, bridges and pinned towers: a parametric sample with known truth.", [],
     [{"explode": 1}, {"mode": "assembly", "step": 12, "share": 0.45}]),
    ("bolt_and_nut", "An M6 nut on its bolt", ["bolt_and_nut", "--set", "diameter=6", "--set", "pitch=1", "--set", "clearance=0.05"],
     "made by `dismantle sample bolt_and_nut`", "A thread: the only way out is a screw motion.", [],
     [{"step": 0, "share": 0.75, "size": [1180, 720]}, {"explode": 1, "size": [1180, 720]}]),
]
BOOK = ("as1_oc_214", [0, 1, 7, 12])  # pages of instructions to show


def run(*command, statuses=(0,)):
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode not in statuses:
        sys.exit(f"{' '.join(command)}: status {done.returncode}\n{done.stdout}")


def plan_of(entry, arguments):
    """The folder with the plan of an entry; None when its input is missing."""
    name, _, source, _, _, options, _ = entry
    folder = os.path.join(arguments.work, name)
    if isinstance(source, list):
        parts = os.path.join(arguments.work, name + ".parts")
        if not os.path.isdir(parts):
            run(arguments.program, "sample", source[0], "-o", parts, *source[1:])
    else:
        parts = os.path.join(arguments.data, source)
        if not os.path.exists(parts):
            print(f"{name}: left out, {parts} is missing", file=sys.stderr)
            return None
    if not os.path.exists(os.path.join(folder, "plan.json")):
        print(f"planning {name}")
        run(arguments.program, "plan", parts, "-o", folder, "-q", *options, statuses=(0, 1))
    run(arguments.program, "view", os.path.join(folder, "plan.json"), "--assembly", parts, "-q")
    if name == BOOK[0]:
        run(arguments.program, "book", os.path.join(folder, "plan.json"), "--assembly", parts, "-o",
            os.path.join(folder, "book.html"), "-q")
    return folder


def result_of(folder):
    with open(os.path.join(folder, "plan.json"), encoding="utf-8") as file:
        plan = json.load(file)
    steps, parts = len(plan["disassembly"]), len(plan["assembly"]["parts"])
    if plan["status"] == "complete":
        return f"{parts} parts, {steps} steps, complete"
    if plan["status"] == "forced":
        return f"{parts} parts, {steps} steps, {sum(1 for s in plan['disassembly'] if 'forced' in s)} of them forced"
    proved = sum(1 for u in plan["unsolved"] if u["outcome"] == "infeasible")
    text = f"{parts} parts, {steps} steps, {len(plan['remaining'])} parts stay together"
    return text + (f" ({proved} proved)" if proved else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", default=os.environ.get("DISMANTLE_DATA", ""), help="folder of test assemblies; default: $DISMANTLE_DATA")
    parser.add_argument("--program", default=os.path.join(ROOT, "build/release/bin/dismantle"))
    parser.add_argument("--modules", default=os.path.join(ROOT, "build/release/viewer"), help="the viewer's node_modules")
    parser.add_argument("--work", default=os.path.join(ROOT, "build/gallery"))
    parser.add_argument("--only", action="append", default=[], metavar="NAME", help="new pictures of these; the page is not written")
    arguments = parser.parse_args()
    os.makedirs(arguments.work, exist_ok=True)
    images = os.path.join(ROOT, "docs/images/gallery")
    os.makedirs(images, exist_ok=True)

    text = ("# Gallery\n\nReal results, made by `tools/make_gallery.py`. Each picture is of the page that `dismantle plan` writes beside its plan; "
            "the assemblies are those of others, under the licences named, or samples that the project makes itself.\n")
    shots = []
    for entry in ENTRIES:
        name, title, source, owner, words, _, wanted = entry
        if arguments.only and name not in arguments.only:
            continue
        folder = plan_of(entry, arguments)
        if folder is None:
            continue
        text += f"\n## {title}\n\n{words}\n\n"
        for i, shot in enumerate(wanted):
            file = f"{name}-{i + 1}.jpg"
            shots.append({"page": os.path.abspath(os.path.join(folder, "index.html")), "out": os.path.join(images, file), **shot})
            text += f"![{title}](images/gallery/{file})\n"
        shown = source[0] if isinstance(source, list) else os.path.basename(source)
        text += f"\n*{shown}: {result_of(folder)}. {owner[0].upper() + owner[1:]}.*\n"
        if name == BOOK[0]:
            text += "\nIts instructions, by `dismantle book`:\n\n"
            for page in BOOK[1]:
                file = f"{name}-book-{page}.jpg"
                shots.append({"page": os.path.abspath(os.path.join(folder, "book.html")), "out": os.path.join(images, file),
                              "section": page, "size": [1180, 800]})
                text += f"![A page of instructions](images/gallery/{file})\n"
    listed = os.path.join(arguments.work, "shots.json")
    with open(listed, "w", encoding="utf-8") as file:
        json.dump(shots, file)
    subprocess.run(["node", os.path.join(ROOT, "tools/gallery_shots.mjs"), listed], check=True,
                   env={**os.environ, "VIEWER_MODULES": os.path.abspath(arguments.modules)})
    if not arguments.only:
        with open(os.path.join(ROOT, "docs/gallery.md"), "w", encoding="utf-8") as file:
            file.write(text)


if __name__ == "__main__":
    main()
