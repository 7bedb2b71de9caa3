"""One engine, with so many threads, on one scene."""

from statistics import median

import numpy as np

from talk import Failed, Talk

CHECKED_STEPS = 50
#: A run has so many steps at most: later on, things that fall freely are where float32 is coarse.
MOST_STEPS = 500
MOST_TIMES = 1000


class Entrant:
    """Starts, shows that it computes the same motion, takes its turns and leaves. What fails ends up in `failed`."""

    def __init__(self, engine, threads, springs):
        self.engine, self.threads, self.springs = engine, threads, springs
        self.talk = None
        self.setup_s = self.peak_mb = self.deviation_m = None
        self.seconds_per_step = []  # of each turn
        self.differs, self.failed = engine.differs, ""

    def start(self, file, processors, twin, tolerance):
        """From the network's file to the first checked steps."""
        try:
            log = file.with_name(f"{self.engine.key}.log")
            self.talk = Talk(self.engine.command(file, self.threads), processors[-self.threads :], log)
            self.setup_s, self.springs = self.talk.ready["setup_s"], self.talk.ready.get("springs", self.springs)
            self.first_guess = self.talk.ask("run", CHECKED_STEPS, 1)["best_s"] / CHECKED_STEPS
            positions = file.with_name("positions")
            self.talk.ask("save", positions)
            self.compare(np.fromfile(positions, "<f8"), twin, tolerance)
        except (OSError, Failed) as error:
            self.failed = str(error)

    def compare(self, positions, twin, tolerance):
        """Whether it has computed the same motion. An engine that says it does not is not held to it."""
        if positions.size == twin.size:
            self.deviation_m = float(np.abs(positions.reshape(twin.shape) - twin).max())
        if not self.differs and not (self.deviation_m is not None and self.deviation_m <= tolerance):
            self.differs = f"it is {self.deviation_m} m from the float64 twin after {CHECKED_STEPS} steps"

    def take_turn(self, budget):
        """Runs from the start over and over for about so many seconds; the fastest counts."""
        if self.failed:
            return
        steps = int(min(max(budget / self.first_guess, 1), MOST_STEPS))
        times = int(min(max(budget / (self.first_guess * steps), 1), MOST_TIMES))
        try:
            self.seconds_per_step.append(self.talk.ask("run", steps, times)["best_s"] / steps)
            self.peak_mb = self.talk.peak_mb()
        except Failed as error:
            self.failed = str(error)

    def leave(self):
        if self.talk:
            self.talk.end()

    def ns_per_spring_step(self, of):
        return 1e9 * of(self.seconds_per_step) / self.springs if self.seconds_per_step else None

    def result(self):
        return {
            "key": self.engine.key,
            "name": self.engine.name,
            "precision": self.engine.precision,
            "threads": self.threads,
            "springs": self.springs,
            "ns": self.ns_per_spring_step(min),
            "median_ns": self.ns_per_spring_step(median),
            "setup_s": self.setup_s,
            "peak_mb": self.peak_mb,
            "deviation_m": self.deviation_m,
            "differs": self.differs,
            "failed": self.failed,
        }
