#!/usr/bin/env python3
"""Makes a wheel of a finished build: program, plugins and Python module in one package, with the libraries of the system that they need
inside. It installs with pip where none of these libraries are, on any Linux with the C and C++ libraries of this one or later.

usage: make_wheel.py BUILD_DIR OUT_DIR

Needs cmake, ldd and patchelf. `pip install .` builds everything from the source instead (docs/python.md)."""
import argparse
import base64
import hashlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# What every Linux brings, and what the interpreter has loaded already: the rule of manylinux (PEP 600).
OF_THE_SYSTEM = re.compile(r"(linux-vdso|ld-linux.*|libc|libm|libdl|librt|libpthread|libutil|libresolv|libnsl|libanl"
                           r"|libstdc\+\+|libgcc_s)\.so(\.\d+)*$")


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{command[0]} failed with status {done.returncode}: {' '.join(map(str, command))}\n{done.stderr.strip()}")
    return done.stdout


def is_elf(path):
    if path.is_symlink() or not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(4) == b"\x7fELF"


def needed_libraries(binary):
    """Libraries of the system that `binary` loads, directly or not: name -> file."""
    found = {}
    for line in run("ldd", binary).splitlines():
        name, _, rest = line.strip().partition(" => ")
        if not rest:
            continue
        if rest.startswith("not found"):
            sys.exit(f"{binary}: its library {name} was not found")
        if not OF_THE_SYSTEM.match(name):
            found[name] = Path(rest.split(" (")[0])
    return found


def lay_out(build, stage):
    """Installs into `stage`, and makes the folder of the package of it: Python files, bin/, lib/ with the plugins, share/."""
    package = stage / "dismantle"
    run("cmake", "--install", build, "--prefix", package, "--strip")
    inits = [path for path in package.glob("lib/python3*/*-packages/dismantle/__init__.py")]
    if len(inits) != 1:
        sys.exit(f"{build} has no Python module: configure it with -D DISMANTLE_PYTHON=ON")
    module = inits[0].parent
    for path in list(module.iterdir()):
        path.rename(package / path.name)
    shutil.rmtree(package / next(part for part in module.relative_to(package).parents if len(part.parts) == 2))
    for development in ("include", "lib/cmake"):
        shutil.rmtree(package / development, ignore_errors=True)
    # A wheel holds no links: a library gets the name by which it is loaded.
    for link in [path for path in package.rglob("*") if path.is_symlink()]:
        link.unlink()
    for library in package.glob("lib/*.so.*"):
        library.rename(library.with_name(run("patchelf", "--print-soname", library).strip()))
    for core in package.glob("_core*.so"):
        run("patchelf", "--set-rpath", "$ORIGIN/lib", core)
    return package


def put_libraries_in(package):
    """Copies the libraries of the system beside the own ones, where all of the binaries look."""
    own = [path for path in sorted(package.rglob("*")) if is_elf(path)]
    names = {path.name for path in own}
    libraries = {}
    for binary in own:
        libraries.update((name, file) for name, file in needed_libraries(binary).items() if name not in names)
    for name, file in sorted(libraries.items()):
        copy = package / "lib" / name
        shutil.copyfile(file.resolve(), copy)
        copy.chmod(0o755)
        run("patchelf", "--set-rpath", "$ORIGIN", copy)
    return sorted(libraries)


def write_wheel(package, out):
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    name, version = project["name"], project["version"]
    libc = platform.libc_ver()[1].replace(".", "_")
    python = "cp" + re.search(r"cpython-(\d+)", next(package.glob("_core*.so")).name).group(1)
    tag = f"{python}-{python}-manylinux_{libc}_{platform.machine()}"
    info = f"{name}-{version}.dist-info"
    texts = {
        "METADATA": "".join(
            [f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\nSummary: {project['description']}\n",
             f"Requires-Python: {project['requires-python']}\n"]
            + [f"Requires-Dist: {needs}\n" for needs in project["dependencies"]]
            + ["Description-Content-Type: text/markdown\n\n", (ROOT / "README.md").read_text(encoding="utf-8")]),
        "WHEEL": f"Wheel-Version: 1.0\nGenerator: dismantle make_wheel\nRoot-Is-Purelib: false\nTag: {tag}\n",
        "entry_points.txt": "[console_scripts]\n" + "".join(f"{key} = {value}\n" for key, value in project["scripts"].items()),
        "LICENSE": (ROOT / "LICENSE").read_text(encoding="utf-8"),
    }
    out.mkdir(parents=True, exist_ok=True)
    wheel = out / f"{name}-{version}-{tag}.whl"
    record = []

    def add(archive, where, data, mode):
        entry = zipfile.ZipInfo(where)  # its date is fixed: equal builds make equal wheels
        entry.external_attr = (0o100000 | mode) << 16
        entry.compress_type = zipfile.ZIP_DEFLATED
        archive.writestr(entry, data)
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record.append(f"{where},sha256={digest},{len(data)}\n")

    with zipfile.ZipFile(wheel, "w") as archive:
        for path in sorted(package.rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                executable = path.stat().st_mode & 0o111
                add(archive, path.relative_to(package.parent).as_posix(), path.read_bytes(), 0o755 if executable else 0o644)
        for file, text in texts.items():
            add(archive, f"{info}/{file}", text.encode(), 0o644)
        archive.writestr(zipfile.ZipInfo(f"{info}/RECORD"), "".join(record) + f"{info}/RECORD,,\n")
    return wheel


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path, metavar="BUILD_DIR")
    parser.add_argument("out", type=Path, metavar="OUT_DIR")
    options = parser.parse_args()
    if shutil.which("patchelf") is None:
        sys.exit("there is no patchelf (Debian: patchelf)")
    with tempfile.TemporaryDirectory() as folder:
        package = lay_out(options.build.resolve(), Path(folder))
        libraries = put_libraries_in(package)
        wheel = write_wheel(package, options.out)
    print(f"{wheel} ({wheel.stat().st_size / 2**20:.0f} MiB, {len(libraries)} libraries of the system inside)")


if __name__ == "__main__":
    main()
