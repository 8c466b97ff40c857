"""The table of relations: which two witnesses say the same, and who is to blame if they differ."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from sensorfault.relations import witnesses as w
from sensorfault.relations.grid import Grid, unwrapped, wrapped
from sensorfault.relations.witnesses import Witness

# Who moves a relation: (device, part of the device) and the sign. A device may be wrong in several parts at once.
Blame = dict[tuple[str, str], float]
# Families of tests that show an error for as long as it lasts; the others (of velocities, of slopes) show only how it
# changes.
LASTING = ("up", "north", "east", "way", "yaw", "roll", "pitch")


@dataclass(frozen=True)
class Relation:
    """One row. `kind`: name for limits, the same for alike relations. `family`: what one fault moves together.

    `order`: 1 compares changes, 2 changes of slope. `circular`: an angle. `lagged`: a lag is fitted.
    """

    name: str
    kind: str
    family: str
    order: int
    left: Witness
    right: Witness
    blame: tuple[tuple[tuple[str, str], float], ...]
    circular: bool = False
    lagged: bool = True

    def difference(self, grid: Grid) -> tuple[Float[np.ndarray, " T"], Float[np.ndarray, " T"]] | None:
        """Left and right on the grid, if both are there."""
        left = self.left(grid)
        right = None if left is None else self.right(grid)
        return None if left is None or right is None else (left, right)


def residual(
    relation: Relation, left: Float[np.ndarray, " T"], right: Float[np.ndarray, " T"]
) -> Float[np.ndarray, " T"]:
    """Left minus right."""
    return unwrapped(wrapped(left - right)) if relation.circular else left - right


def _row(name, kind, family, order, left, right, blame: Blame, **more):  # type: ignore[no-untyped-def]
    return Relation(name, kind, family, order, left, right, tuple(blame.items()), **more)


def rows(keys: set[str], courses: bool) -> Iterator[Relation]:
    """The relations of a log that has these signals. `courses`: the vehicle goes where it points."""
    receivers = sorted({key.partition(".")[0] for key in keys if key.startswith("gnss")})
    yield from _heights(keys, receivers)
    yield from _places(keys, receivers)
    yield from _angles(keys, receivers, courses)
    yield from _speeds(keys, receivers)
    yield from _twins(keys)


def _numbers(keys: set[str], role: str) -> list[str]:
    return sorted(
        key.removeprefix(role) for key in keys if key.startswith(role) and key.removeprefix(role) in ("", "2", "3", "4")
    )


def _heights(keys: set[str], receivers: list[str]) -> Iterator[Relation]:
    acc = w.pulled(2, 2), ("accelerometer", "up")
    heights = [
        (f"barometer{n}", w.measured(f"barometer{n}"), (f"barometer{n}", "")) for n in _numbers(keys, "barometer")
    ]
    heights += [("depth", w.measured("depth"), ("depth", ""))] if "depth" in keys else []
    for g in receivers:
        height, climb = w.measured(f"{g}.height"), w.summed(f"{g}.climb")
        yield _row(f"{g}.height | climb", "height|climb", "up", 1, height, climb, {(g, "height"): 1, (g, "climb"): -1})
        for name, baro, who in heights:
            yield _row(f"{g}.height | {name}", "height|baro", "up", 1, height, baro, {(g, "height"): 1, who: -1})
            yield _row(f"{name} | {g}.climb", "baro|climb", "up", 1, baro, climb, {who: 1, (g, "climb"): -1})
        yield _row(f"{g}.height | acceleration", "height|acc", "up2", 2, height, acc[0], {(g, "height"): 1, acc[1]: -1})
        yield _row(
            f"{g}.climb | acceleration",
            "climb|acc",
            "vup",
            1,
            w.measured(f"{g}.climb"),
            w.pulled(2, 1),
            {(g, "climb"): 1, acc[1]: -1},
        )
    for i, (name, baro, who) in enumerate(heights):
        yield _row(f"{name} | acceleration", "baro|acc", "up2", 2, baro, acc[0], {who: 1, acc[1]: -1})
        for other, second, whom in heights[i + 1 :]:
            yield _row(f"{name} | {other}", "baro|baro", "up", 1, baro, second, {who: 1, whom: -1})


def _places(keys: set[str], receivers: list[str]) -> Iterator[Relation]:
    level = ("accelerometer", "level")
    reckoning: Blame = {("dvl", ""): -1}
    if "heading" in keys:
        reckoning[("heading", "")] = -1  # what turns the way is a suspect
    for g in receivers:
        for i, axis in enumerate(("north", "east")):
            place, speed = w.measured(f"{g}.position", i), w.velocity(i, g)
            yield _row(
                f"{g}.position | velocity, {axis}",
                "position|velocity",
                axis,
                1,
                place,
                w.displaced(i, g),
                {(g, "position"): 1, (g, "velocity"): -1},
            )
            yield _row(
                f"{g}.velocity | acceleration, {axis}",
                "velocity|acc",
                "v" + axis,
                1,
                speed,
                w.pulled(i, 1),
                {(g, "velocity"): 1, level: -1},
            )
            yield _row(
                f"{g}.position | acceleration, {axis}",
                "position|acc",
                axis + "2",
                2,
                place,
                w.pulled(i, 2),
                {(g, "position"): 1, level: -1},
            )
            yield _row(
                f"{g}.position | dead reckoning, {axis}",
                "position|reckoned",
                axis,
                1,
                place,
                w.reckoned(i),
                {(g, "position"): 1, **reckoning},
            )


def _angles(keys: set[str], receivers: list[str], courses: bool) -> Iterator[Relation]:
    for i, name in enumerate(("roll", "pitch")):
        yield _row(
            f"attitude.{name} | gyro",
            "tilt|gyro",
            name,
            1,
            w.angle("attitude", i),
            w.turned(i),
            {("attitude", ""): 1, ("gyro", ""): -1},
            lagged=False,
        )
    yaws: list[tuple[str, str, Witness, Blame]] = []
    # What turns an angle of the wheels or a side force into a yaw is a suspect, too: a speed that is too large makes
    # the one turn too much, the other too little.
    speed = ("wheel", "") if "wheel" in keys else ("gnss", "velocity")
    yaws += [("gyro", f"gyro{n}", w.turned(2, n), {(f"gyro{n}", ""): 1.0}) for n in _numbers(keys, "gyro")]
    if "yaw_rate" in keys and "gyro" not in keys:
        yaws.append(("gyro", "yaw rate", w.turned(2), {("yaw_rate", ""): 1.0}))
    if "steering" in keys:
        yaws.append(("steering", "steering", w.steered, {("steering", ""): 1.0, speed: 1.0}))
    yaws.append(("side", "side acceleration", w.leaned, {("accelerometer", "level"): 1.0, speed: -1.0}))
    yaws.append(("attitude", "attitude.yaw", w.angle("attitude", 2), {("attitude", ""): 1.0}))
    if "heading" in keys:
        yaws.append(("heading", "heading", w.angle("heading", 0), {("heading", ""): 1.0}))
    for n in _numbers(keys, "magnetometer"):
        yaws.append(("compass", f"magnetometer{n}", w.compass(n), {(f"magnetometer{n}", ""): 1.0}))
    for g in receivers if courses else []:
        part = "velocity" if f"{g}.velocity" in keys else "course"  # of which it is made
        yaws.append(("course", f"{g}.course", w.course(g), {(g, part): 1.0}))
    for i, (kind, name, left, mine) in enumerate(yaws):
        for other, second, right, theirs in yaws[i + 1 :]:
            if kind == other == "gyro":
                continue  # twins are compared by axis
            blame = {part: mine.get(part, 0.0) - theirs.get(part, 0.0) for part in (*mine, *theirs)}
            lagged = other in ("course", "steering")
            name_of = f"{name} | {second}"
            yield _row(name_of, f"{kind}|{other}", "yaw", 1, left, right, blame, circular=True, lagged=lagged)


def _speeds(keys: set[str], receivers: list[str]) -> Iterator[Relation]:
    wheel = ("wheel", "")
    for g in receivers:
        yield _row(
            f"wheel | {g}.speed",
            "wheel|speed",
            "way",
            1,
            w.summed("wheel"),
            w.run(g, 1),
            {wheel: 1, (g, "velocity"): -1},
        )
        yield _row(
            f"wheel | {g}.position",
            "wheel|position",
            "way",
            1,
            w.summed("wheel"),
            w.path(g),
            {wheel: 1, (g, "position"): -1},
        )
        yield _row(
            f"airspeed | {g}.speed",
            "airspeed|speed",
            "air",
            1,
            w.measured("airspeed"),
            w.run(g, 0),
            {("airspeed", ""): 1, (g, "velocity"): -1},
        )
        if "wheel" in keys or "attitude" not in keys:
            yield _row(
                f"{g}.speed | acceleration",
                "speed|acc",
                "push",
                1,
                w.run(g, 0),
                w.pushed,
                {(g, "velocity"): 1, ("accelerometer", "level"): -1},
            )
    yield _row(
        "wheel | acceleration",
        "wheel|acc",
        "push",
        1,
        w.measured("wheel"),
        w.pushed,
        {wheel: 1, ("accelerometer", "level"): -1},
    )


def _twins(keys: set[str]) -> Iterator[Relation]:
    for role, part in (("gyro", ("", "", "")), ("accelerometer", ("level", "level", "up"))):
        numbers = _numbers(keys, role)
        for i, first in enumerate(numbers):
            for second in numbers[i + 1 :]:
                for axis in range(3):
                    left, right = w.summed(role + first, axis), w.summed(role + second, axis)
                    who = (role + first, part[axis] if not first else ""), (role + second, "")
                    yield _row(
                        f"{role}{first} | {role}{second}, {'xyz'[axis]}",
                        f"{role}|{role}",
                        role + "xyz"[axis],
                        1,
                        left,
                        right,
                        {who[0]: 1, who[1]: -1},
                        lagged=False,
                    )
