"""Which axes an inertial unit has: found from turns, gravity and course, before anything is compared.

Inside, a vehicle's axes are forward, right, down, and an accelerometer at rest reads -g on down.
"""

from dataclasses import dataclass, replace
from itertools import permutations, product

import numpy as np
from jaxtyping import Float

from sensorfault.relations.grid import GRAVITY, Grid, integrated, unwrapped
from sensorfault.relations.signals import Signal

TURN_RAD = 0.35  # all turns together must be at least this, else they decide nothing
MARGIN = 1.5  # the best mounting must explain the turns this much better than the next one
SURE = 1.15  # the same for the forward axis
CLIP_RAD, ALIKE = 0.3, 0.4  # a turn counts no more than this; how alike turns by gyro and by course must be
RATE_S = 1.0  # turns are compared over steps of this
ASKEW = np.radians(6)  # a unit turned further than this from the vehicle's axes is mounted askew
INERTIAL = ("gyro", "accelerometer", "magnetometer")


@dataclass(frozen=True)
class Mounting:
    """The axes of one inertial unit.

    `turn`: rotation to forward, right, down; None if undecided. `gravity`: -1 where the accelerometer has the sign of
    gravity. `forward`, `yaw`: whether the forward axis and the sign of turns are known, not only the vertical axis.
    `why`: what was lacking.
    """

    turn: Float[np.ndarray, "3 3"] | None
    gravity: float = 1.0
    forward: bool = True
    yaw: bool = True
    why: str = ""


def _rotations() -> list[Float[np.ndarray, "3 3"]]:
    """The 24 ways to mount a box along the vehicle's axes."""
    found = []
    for order, signs in product(permutations(range(3)), product((1.0, -1.0), repeat=3)):
        turn = np.zeros((3, 3))
        turn[range(3), order] = signs
        if np.linalg.det(turn) > 0:
            found.append(turn)
    return found


ROTATIONS = _rotations()


def mounted(
    signals: dict[str, Signal], known: dict[str, Mounting] | None = None
) -> tuple[dict[str, Signal], dict[str, Mounting]]:
    """The signals with every inertial unit turned to forward, right, down, and how each was mounted.

    `known`: mountings that a model stores; they are taken as they are.
    """
    mountings: dict[str, Mounting] = {}
    numbers = dict.fromkeys(key.removeprefix(role) for key, s in signals.items() for role in INERTIAL if s.role == role)
    for number in numbers:
        gyro, acc = signals.get(f"gyro{number}"), signals.get(f"accelerometer{number}")
        mounting = _known(known, number) or _mounting(signals, gyro, acc, mountings.get(""))
        mountings[number] = mounting
    return turned(signals, mountings), mountings


def turned(signals: dict[str, Signal], mountings: dict[str, Mounting]) -> dict[str, Signal]:
    """The signals with every unit turned whose mounting is decided."""
    found = dict(signals)
    for (number, mounting), role in product(mountings.items(), INERTIAL):
        signal = signals.get(role + number)
        if signal is not None and mounting.turn is not None:
            sign = mounting.gravity if role == "accelerometer" else 1.0
            found[role + number] = replace(signal, value=sign * signal.value @ mounting.turn.T)
    return found


def _known(known: dict[str, Mounting] | None, number: str) -> Mounting | None:
    """A stored mounting that is decided."""
    one = (known or {}).get(number)
    return one if one is not None and one.turn is not None else None


def _mounting(signals: dict[str, Signal], gyro: Signal | None, acc: Signal | None, first: Mounting | None) -> Mounting:
    if gyro is None:
        return first or Mounting(None, why="no gyro shows how it is mounted")
    if "attitude" in signals and signals["attitude"].value.shape[1] == 3:
        turn = _by_attitude(signals["attitude"], gyro)
        if turn is not None:
            return Mounting(turn, _sign(acc, turn, signals["attitude"]))
        if first is not None and first.turn is not None:
            return first
        by_course = _by_course(signals, gyro, acc)
        if by_course.turn is not None and by_course.yaw:
            return by_course
        return Mounting(
            np.eye(3),
            _sign(acc, np.eye(3), signals["attitude"]),
            why="too few turns: axes taken as forward, right, down",
        )
    return _by_course(signals, gyro, acc)


def _by_attitude(attitude: Signal, gyro: Signal) -> Float[np.ndarray, "3 3"] | None:
    """The mounting whose turns are those of the attitude."""
    grid = Grid(
        {"attitude": attitude, "gyro": gyro}, max(attitude.time[0], gyro.time[0]), min(attitude.time[-1], gyro.time[-1])
    )
    n = round(RATE_S / 0.2)
    if len(grid.time) < 5 * n:
        return None
    angle = np.stack([np.interp(grid.time, attitude.time, np.unwrap(column)) for column in attitude.value.T], axis=1)
    angle[grid.hole("attitude")] = np.nan
    moved, turned = angle[n::n] - angle[:-n:n], grid.integral("gyro")[n::n] - grid.integral("gyro")[:-n:n]
    roll, pitch, _ = ((angle[n::n] + angle[:-n:n]) / 2).T
    dr, dp, dy = moved.T
    # Body rates from angle rates (Groves 2.57).
    body = np.stack(
        [
            dr - dy * np.sin(pitch),
            dp * np.cos(roll) + dy * np.cos(pitch) * np.sin(roll),
            -dp * np.sin(roll) + dy * np.cos(pitch) * np.cos(roll),
        ],
        axis=1,
    )
    there = np.isfinite(body).all(axis=1) & np.isfinite(turned).all(axis=1)
    body, turned = body[there], turned[there]
    if np.abs(body).sum() < TURN_RAD:
        return None
    left = [_left(turned, body, turn) for turn in ROTATIONS]
    order = np.argsort(left)
    straight = ROTATIONS[order[0]] if left[order[1]] > MARGIN * left[order[0]] else None
    askew = _askew(turned, body)
    if askew is None or (straight is not None and _between(straight, askew) < ASKEW):
        return straight
    return askew if left[order[0]] > MARGIN * _left(turned, body, askew) else straight


def _left(turned: Float[np.ndarray, "n 3"], body: Float[np.ndarray, "n 3"], turn: Float[np.ndarray, "3 3"]) -> float:
    """What a mounting leaves unexplained of the turns."""
    return float(np.minimum(np.abs(turned @ turn.T - body), CLIP_RAD).mean())


def _askew(turned: Float[np.ndarray, "n 3"], body: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "3 3"] | None:
    """The rotation that fits the turns best (Kabsch 1976); None if they are about one axis only."""
    sizes = np.linalg.norm(body - np.median(body, axis=0), axis=1)
    few = sizes <= np.percentile(sizes, 98)  # without what may be jumps of the attitude
    left, size, right = np.linalg.svd((body[few] - body[few].mean(0)).T @ (turned[few] - turned[few].mean(0)))
    if size[1] < 0.02 * size[0]:
        return None
    return np.asarray(left @ np.diag([1.0, 1.0, np.linalg.det(left @ right)]) @ right)


def _between(one: Float[np.ndarray, "3 3"], other: Float[np.ndarray, "3 3"]) -> float:
    """The angle between two rotations [rad]."""
    return float(np.arccos(np.clip((np.trace(one.T @ other) - 1) / 2, -1.0, 1.0)))


def _sign(acc: Signal | None, turn: Float[np.ndarray, "3 3"], attitude: Signal) -> float:
    """Whether an accelerometer reads -g or +g on the axis that is down, given the attitude."""
    if acc is None:
        return 1.0
    roll, pitch = (np.interp(acc.time, attitude.time, attitude.value[:, i]) for i in (0, 1))
    down = np.stack([-np.sin(pitch), np.cos(pitch) * np.sin(roll), np.cos(pitch) * np.cos(roll)], axis=1)
    return -1.0 if np.median(((acc.value @ turn.T) * down).sum(axis=1)) > 0 else 1.0


def _by_course(signals: dict[str, Signal], gyro: Signal, acc: Signal | None) -> Mounting:
    """A vehicle that stays level: gravity gives the vertical, course or heading its sign, speed the forward axis."""
    if acc is None:
        return Mounting(None, why="no accelerometer shows where down is")
    mean = np.median(acc.value, axis=0)
    if np.linalg.norm(mean) < 0.7 * GRAVITY:
        return Mounting(None, why="the accelerometer does not show gravity")
    vertical = _vertical(mean)
    turning = _turning(signals, gyro.value @ vertical, gyro.time)
    down = vertical * (turning or -1.0)
    gravity = -1.0 if mean @ down > 0 else 1.0
    forward, sure = _forward(signals, acc, gravity, vertical)
    lacks = [] if turning else ["no turns with a course to compare: the sign of the yaw rate is unknown"]
    lacks += [] if sure else ["too little braking: the forward axis is unknown"]
    turn = np.stack([forward, np.cross(down, forward), down])
    return Mounting(turn, gravity, sure, bool(turning), "; ".join(lacks))


def _vertical(mean: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    """The direction of gravity: that of an axis of the unit, unless it is mounted askew."""
    there = mean / np.linalg.norm(mean)
    axis = np.zeros(3)
    largest = int(np.argmax(np.abs(there)))
    axis[largest] = np.sign(there[largest])
    return axis if np.arccos(min(there @ axis, 1.0)) < ASKEW else there


def _turning(signals: dict[str, Signal], rate: Float[np.ndarray, " n"], time: Float[np.ndarray, " n"]) -> float:
    """+1 if a rate is positive in right turns, -1 if in left ones, 0 if that is undecided."""
    angle = integrated(time, rate[:, None])[:, 0]
    for at, course in _courses(signals):
        n = max(round(4.0 / max(float(np.median(np.diff(at))), 1e-3)), 1)
        moved, turned = course[n:] - course[:-n], np.interp(at[n:], time, angle) - np.interp(at[:-n], time, angle)
        # How turns change from one window to the next: an offset of the gyro, lasting or new, has no say.
        moved, turned = (np.clip(x[n:] - x[:-n], -CLIP_RAD, CLIP_RAD) for x in (moved, turned))
        there = np.isfinite(moved) & np.isfinite(turned)
        moved, turned = moved[there], turned[there]
        if np.abs(moved).sum() < TURN_RAD * n:
            continue
        alike = float((moved * turned).sum() / np.sqrt((moved**2).sum() * max((turned**2).sum(), 1e-12)))
        if abs(alike) > ALIKE:
            return float(np.sign(alike))
    return 0.0


def _courses(signals: dict[str, Signal]) -> list[tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]]:
    """What tells the direction of the vehicle: time and angle from north, clockwise [rad], NaN while it stands."""
    found = []
    if "heading" in signals:
        found.append((signals["heading"].time, unwrapped(signals["heading"].value[:, 0])))
    if "gnss.course" in signals and "gnss.speed" in signals:
        time, speed = signals["gnss.course"].time, signals["gnss.speed"]
        moving = np.interp(time, speed.time, speed.value[:, 0]) > 2.0
        found.append((time, unwrapped(np.where(moving, signals["gnss.course"].value[:, 0], np.nan))))
    for key in ("gnss.velocity", "gnss.position"):
        if key in signals:
            time, value = signals[key].time, signals[key].value
            if key == "gnss.position":
                n = max(round(1.0 / max(signals[key].period_s, 1e-3)), 1)
                time, value = time[n:], (value[n:] - value[:-n]) / (time[n:] - time[:-n])[:, None]
            course = np.arctan2(value[:, 1], value[:, 0])
            found.append((time, unwrapped(np.where(np.hypot(*value.T) > 2.0, course, np.nan))))
    return found


def _forward(
    signals: dict[str, Signal], acc: Signal, gravity: float, vertical: Float[np.ndarray, "3"]
) -> tuple[Float[np.ndarray, "3"], bool]:
    """The horizontal direction along which speed changes, and whether that is sure."""
    choices = _level(vertical)
    speed = next((signals[key] for key in ("wheel", "gnss.speed") if key in signals), None)
    if speed is None and "gnss.velocity" in signals:
        velocity = signals["gnss.velocity"]
        speed = replace(velocity, value=np.hypot(*velocity.value.T)[:, None])
    if speed is None or len(speed.time) < 3 * round(2.0 / max(speed.period_s, 1e-3)) + 10:
        return choices[0], False
    n = max(round(2.0 / max(speed.period_s, 1e-3)), 1)
    gained = speed.value[n:, 0] - speed.value[:-n, 0]
    pulled = integrated(acc.time, gravity * (acc.value - np.median(acc.value, axis=0)))
    pulled = np.stack([np.interp(speed.time, acc.time, column) for column in pulled.T], axis=1)
    pulled = pulled[n:] - pulled[:-n]
    left = [float(np.abs(gained - pulled @ choice).mean()) for choice in choices]
    order = np.argsort(left)
    best, sure = choices[order[0]], bool(left[order[1]] > SURE * left[order[0]] and np.abs(gained).max() > 1.0)
    # the direction that fits best: g = arg min |gained - pulled (cos a e1 + sin a e2)|
    plane = np.stack(choices[:2])
    there = np.isfinite(gained) & np.isfinite(pulled).all(axis=1)
    share = np.linalg.lstsq(pulled[there] @ plane.T, gained[there], rcond=None)[0]
    askew = share @ plane / max(float(np.linalg.norm(share)), 1e-12)
    between = float(np.arccos(np.clip(askew @ best, -1.0, 1.0)))
    if between > ASKEW and left[order[0]] > SURE * float(np.abs(gained - pulled @ askew).mean()):
        return askew, bool(np.abs(gained).max() > 1.0)
    return best, sure


def _level(vertical: Float[np.ndarray, "3"]) -> list[Float[np.ndarray, "3"]]:
    """Four directions across the vertical, at right angles; those of the unit's axes if it is not askew."""
    least = np.zeros(3)
    least[int(np.argmin(np.abs(vertical)))] = 1.0
    first = least - (least @ vertical) * vertical
    first /= np.linalg.norm(first)
    second = np.cross(vertical, first)
    return [first, second, -first, -second]
