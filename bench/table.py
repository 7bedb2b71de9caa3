"""What a sitting found, as tables in Markdown."""

# A spring evaluated once: axis 3, its square 5, an inverse root by Newton's method 13, length 1, speed along the axis
# 9, tension 4, force 4, added to both ends 6.
FLOPS = 45
# What a plain layout moves: a point's position and velocity, read and written; a spring's two ends and three numbers.
POINT_BYTES, SPRING_BYTES = 48, 20

LIMITS = {
    "fused_gflops": "fused multiply-adds, GFLOP/s",
    "separate_gflops": "separate multiplications and additions, GFLOP/s",
    "triad_l2_gbs": "triad within L2, GB/s",
    "triad_l3_gbs": "triad within L3, GB/s",
    "triad_memory_gbs": "triad from memory, GB/s",
    "inverse_root_ns": "exact 1/√x, ns",
    "gather_near_ns": "gather from 16 kB, ns",
    "gather_far_ns": "gather at random from 6 MB, ns",
}


def of(results):
    """The whole page."""
    parts = ["# sprung and its peers\n", about(results), summary(results), limits(results["limits"])]
    return "\n".join([*parts, *(details(scene) for scene in results["scenes"]), notes(results)])


def bounds(scene, limits):
    """ns per spring and step that arithmetic alone and traffic alone would take, and from which cache or memory."""
    traffic = POINT_BYTES * scene["points"] + SPRING_BYTES * scene["springs"]
    room = {"l2": limits["l2_bytes"] * limits["threads"], "l3": limits["l3_bytes"], "memory": float("inf")}
    level = next(level for level, size in room.items() if traffic <= size)
    return FLOPS / limits["separate_gflops"], traffic / scene["springs"] / limits[f"triad_{level}_gbs"], level


def about(results):
    machine = results["machine"]
    lines = [
        f"{machine['processor']}, {machine['processors']} processors, {machine['system']}; {results['when']}.",
        f"{machine['g++']}; {machine['rustc']}; Python {machine['python']};",
        ", ".join(f"{package} {version}" for package, version in results["versions"].items()) + ".",
    ]
    if results["quick"]:
        lines += ["", "**Quick: small scenes and short runs. This shows that everything works, not how fast it is.**"]
    return "\n".join(lines) + "\n"


def summary(results):
    """ns per spring and step, engines down, scenes across."""
    cells = {}
    for scene in results["scenes"]:
        for entry in scene["entries"]:
            star = "\\*" if entry["differs"] else ""
            cells.setdefault(label(entry), {})[scene["name"]] = number(entry["ns"]) + star
    scenes = results["scenes"]
    rows = [[engine, *(found.get(scene["name"], "–") for scene in scenes)] for engine, found in cells.items()]
    for limits in results["limits"]:
        across = [bounds(scene, limits) for scene in scenes]
        rows.append([f"*arithmetic alone* [{limits['threads']}]", *(number(flops) for flops, _, _ in across)])
        rows.append([f"*traffic alone* [{limits['threads']}]", *(number(traffic) for _, traffic, _ in across)])
    title = "ns per spring and step, the fastest turn; [n] threads; float32 unless said; \\* not the same motion.\n"
    return "\n".join([title, *markdown(["engine", *(scene["name"] for scene in scenes)], rows)]) + "\n"


def limits(measured):
    heads = ["the machine's limits", *(plural(limits["threads"], "thread") for limits in measured)]
    rows = [[text, *(number(limits[key]) for limits in measured)] for key, text in LIMITS.items()]
    return "\n".join(markdown(heads, rows)) + "\n"


def details(scene):
    heads = "engine, ns/spring/step, its median turn, set-up (s), peak (MB), from the twin (m)".split(", ")
    rows = []
    for entry in scene["entries"]:
        measured = [number(entry[key]) for key in ("ns", "median_ns", "setup_s", "peak_mb")]
        rows.append([label(entry), *measured, motion(entry)])
    title = f"## {scene['name']}: {scene['points']:,} points, {scene['springs']:,} springs\n"
    allowed = f"\nThe same motion: within {scene['tolerance_m']:.1e} m of the float64 twin.\n"
    return "\n".join([title, *markdown(heads, rows), allowed])


def motion(entry):
    if entry["setup_s"] is None:
        return "did not run"
    return "not the same motion" if entry["differs"] else f"{entry['deviation_m']:.1e}"


def notes(results):
    lines = {}  # for its order, and as each is to stand there once
    for entry in (entry for scene in results["scenes"] for entry in scene["entries"]):
        if entry["failed"]:
            lines[f"- Did not run, {label(entry)}: {entry['failed']}."] = None
        elif entry["differs"]:
            lines[f"- Not the same motion, {entry['name']}: {entry['differs']}."] = None
    return "\n".join(lines) + "\n"


def markdown(heads, rows):
    ruler = "|---|" + "---:|" * (len(heads) - 1)
    return ["| " + " | ".join(heads) + " |", ruler, *("| " + " | ".join(row) + " |" for row in rows)]


def label(entry):
    precision = ", float64" if entry["precision"] == "f64" else ""
    return f"{entry['name']}{precision} [{entry['threads']}]"


def plural(count, noun):
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def number(value):
    """As many digits as these measurements bear."""
    if value is None:
        return "–"
    if value < 0.001:
        return "< 0.001"
    digits = 0 if value >= 100 else 1 if value >= 10 else 2 if value >= 0.1 else 3
    return f"{value:,.{digits}f}"
