"""Makes the wheel of a build, unpacks it, and uses what is inside without the build tree. `./check --packages` also installs it in a
clean root.

usage: wheel_test.py SOURCE_DIR BUILD_DIR WORK_DIR"""
import base64
import csv
import hashlib
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

SOURCE, BUILD, WORK = (Path(argument).resolve() for argument in sys.argv[1:4])
ENVIRONMENT = {key: value for key, value in os.environ.items()
               if key not in ("DISMANTLE_PLUGIN_PATH", "LD_LIBRARY_PATH", "PYTHONPATH", "DISMANTLE")}


def run(*command, **more):
    return subprocess.run([str(part) for part in command], check=True, text=True, stdout=subprocess.PIPE,
                          env=ENVIRONMENT | more).stdout


def check_record(package):
    """Each file is listed with its digest, and nothing else is."""
    info = next(package.glob("*.dist-info"))
    with (info / "RECORD").open(newline="", encoding="utf-8") as file:
        rows = {row[0]: row for row in csv.reader(file)}
    files = {path.relative_to(package).as_posix() for path in package.rglob("*") if path.is_file()}
    assert files == set(rows), f"listed and there: {sorted(files ^ set(rows))}"
    for name, digest, size in rows.values():
        if name == f"{info.name}/RECORD":
            continue
        data = (package / name).read_bytes()
        assert digest == "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode(), name
        assert int(size) == len(data), name
    tag = re.search(r"^Tag: (.*)$", (info / "WHEEL").read_text(encoding="utf-8"), re.M).group(1)
    assert tag in next((WORK / "made").glob("*.whl")).name


def check_libraries(package):
    """What is not of the C or C++ runtime is loaded from the wheel."""
    of_the_system = re.compile(r"(linux-vdso|/lib.*/ld-linux|lib(c|m|dl|rt|pthread|stdc\+\+|gcc_s|resolv|util|nsl|anl)\.so)")
    binaries = 0
    for path in sorted((package / "dismantle").rglob("*")):
        if not path.is_file() or path.open("rb").read(4) != b"\x7fELF":
            continue
        binaries += 1
        for line in run("ldd", path).splitlines():
            name, _, where = line.strip().partition(" => ")
            if of_the_system.match(name) or not where:
                continue
            assert where.startswith(str(package)), f"{path.name} loads {name} from {where}"
    assert binaries > 60, binaries
    return binaries


def main():
    shutil.rmtree(WORK, ignore_errors=True)
    print(run(sys.executable, SOURCE / "tools/make_wheel.py", BUILD, WORK / "made"), end="")
    wheels = list((WORK / "made").glob("*.whl"))
    assert len(wheels) == 1, wheels
    package = WORK / "unpacked"
    with zipfile.ZipFile(wheels[0]) as archive:
        archive.extractall(package)
        for entry in archive.infolist():
            (package / entry.filename).chmod(entry.external_attr >> 16 or 0o644)
    check_record(package)
    print(check_libraries(package), "binaries load nothing else from the system")
    program = package / "dismantle/bin/dismantle"
    run(program, "sample", "peg_in_hole", "-o", WORK / "peg")
    run(program, "plan", WORK / "peg", "-o", WORK / "plan")
    run(program, "verify", WORK / "plan/plan.json", "--assembly", WORK / "peg")
    run(sys.executable, SOURCE / "tests/packages/step_boxes.py", WORK / "boxes.step")
    run(program, "plan", WORK / "boxes.step", "-o", WORK / "boxes")
    run(sys.executable, "-c", f"import dismantle; plan = dismantle.run({str(WORK / 'boxes.step')!r}); assert plan.complete, plan",
        PYTHONPATH=str(package))


if __name__ == "__main__":
    main()
