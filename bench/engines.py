"""What is measured: one line for each engine, how it is built, and how it is started."""

import platform
import subprocess
import sys
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

BENCH = Path(__file__).resolve().parent
ROOT = BENCH.parent
BUILT = ROOT / "target" / "bench-peers" / "built"

ONE, BOTH, ALL = "one", "one and all", "all"  # threads


@dataclass(frozen=True)
class Engine:
    key: str  # for --engines
    name: str
    source: str  # in bench/; its ending says how it is built
    threads: str
    package: str = ""  # what it is called on PyPI
    precision: str = "f32"
    most_springs: int = 30_000_000  # beyond this it takes minutes or all memory to get ready
    one_material: bool = False
    differs: str = ""  # why it does not compute the same motion, if it does not

    def takes(self, network):
        alike = (network.stiffness == network.stiffness[0]).all()
        return network.springs <= self.most_springs and (alike or not self.one_material)

    def thread_counts(self, cores):
        return {ONE: [1], BOTH: sorted({1, cores}), ALL: [cores]}[self.threads]

    def version(self):
        try:
            return metadata.version(self.package)
        except metadata.PackageNotFoundError:
            return "missing"

    def command(self, network, threads):
        """What starts it on a network's file."""
        source = Path(self.source)
        if source.suffix == ".py":
            return [sys.executable, BENCH / "measure.py", source.stem, network, str(threads)]
        program = SPRUNG if self.key == "sprung" else BUILT / self.key
        return [program, network, str(threads)]


SPRUNG = ROOT / "target" / "release" / "examples" / "bench_network"
SPRUNG_COMMAND = ROOT / "target" / "release" / "sprung"

ENGINES = [
    Engine("sprung", "sprung", "../crates/sprung/examples/bench_network.rs", BOTH),
    Engine("lanes", "C++, 16 lanes, gather", "peers/lanes.cpp", BOTH),
    Engine("plain", "C++, plain", "peers/plain.cpp", ONE),
    Engine("plain-rust", "Rust, plain", "peers/plain.rs", ONE),
    Engine("numba-scatter", "Numba, scatter", "peers/numba_scatter.py", ONE, "numba"),
    Engine("numba-gather", "Numba, gather", "peers/numba_gather.py", BOTH, "numba"),
    Engine("quadrants", "Quadrants, gather", "peers/quadrants_gather.py", BOTH, "quadrants"),
    Engine("taichi", "Taichi, gather", "peers/taichi_gather.py", BOTH, "taichi"),
    Engine("newton", "Newton SemiImplicit", "peers/newton_semi_implicit.py", ONE, "newton", most_springs=3_000_000),
    Engine("jax", "JAX, scatter", "peers/jax_scatter.py", ALL, "jax", most_springs=3_000_000),
    Engine("numpy", "NumPy, bincount", "peers/numpy_bincount.py", ONE, "numpy", most_springs=3_000_000),
    Engine(
        "mujoco", "MuJoCo flex", "peers/mujoco_flex.py", ONE, "mujoco", "f64",
        most_springs=40_000, one_material=True,
    ),
    Engine(
        "pybullet", "PyBullet soft body", "peers/pybullet_soft.py", ONE, "pybullet",
        most_springs=20_000, one_material=True,
        differs="it takes meshes and not springs, starts at rest, steps partly implicitly and damps by its own rule",
    ),
]  # fmt: skip

#: GCC tunes for no processor in particular where it does not know this one, and then loads lanes one by one.
TUNE = ["-mtune=skylake-avx512", "-mprefer-vector-width=512"] if platform.machine() in ("x86_64", "AMD64") else []
GXX = ["g++", "-std=c++17", "-O3", "-march=native"]
RUSTC = ["rustc", "--edition", "2024", "-C", "opt-level=3", "-C", "target-cpu=native"]
FLAGS = {
    "lanes": [*TUNE, "-ffast-math", "-fopenmp"],
    "limits": [*TUNE, "-fno-math-errno", "-fno-trapping-math", "-fopenmp"],
}


def build(key, source):
    """Builds what has to be built; raises CalledProcessError or FileNotFoundError."""

    def run(*command):
        subprocess.run(command, check=True, cwd=ROOT)

    BUILT.mkdir(parents=True, exist_ok=True)
    if key == "sprung":
        run("cargo", "build", "-q", "--release", "-p", "sprung", "--features", "rayon", "--example", "bench_network")
        run("cargo", "build", "-q", "--release", "-p", "sprung-cli", "--no-default-features")
    elif source.endswith(".cpp"):
        run(*GXX, *FLAGS.get(key, []), BENCH / source, "-o", BUILT / key)
    elif source.endswith(".rs"):
        run(*RUSTC, BENCH / source, "-o", BUILT / key)
