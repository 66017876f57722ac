#!/usr/bin/env python3
"""Writes joints.json: the angles of chains of rods, from Lagrange's equations. No engine takes part.

    pip install numpy scipy
    tools/peers/joints_truth.py

Angles count from the downward vertical. Extrapolation with 64 bits of mantissa gives the answers. Half the step and other
orders tell how well they are known; DOP853 in double precision is a check by another method.
"""

import json
import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

import problems

WIDE = np.longdouble


@dataclass(frozen=True)
class Rods:
    """Uniform rods, each hung on the one above; `ball` is a point mass at the lowest end."""

    masses: tuple
    lengths: tuple
    ball: float = 0.0
    servos: tuple = ()  # target, kp, kd of each joint
    angles: tuple = ()  # at the start, in rad

    def rate(self, kind):
        """The derivative of angles and rates, as a function of both, in numbers of a kind."""
        count = len(self.masses)
        masses, lengths = np.array(self.masses, kind), np.array(self.lengths, kind)
        # How far the middle of a rod moves along its own direction or that of a rod above it.
        arm = np.array([[lengths[j] if j < k else lengths[j] / 2 if j == k else 0 for j in range(count)] for k in range(count)], kind)
        coupling = (arm * masses[:, None]).T @ arm + kind(self.ball) * np.outer(lengths, lengths)
        weight = kind(problems.GRAVITY) * (masses @ arm + kind(self.ball) * lengths)
        inertia = np.diag(masses * lengths**2 / 12)

        def of(state):
            angle, speed = state[:count], state[count:]
            apart = angle[:, None] - angle[None, :]
            torque = -(coupling * np.sin(apart)) @ speed**2 - weight * np.sin(angle)
            for joint, (target, kp, kd) in enumerate(self.servos):
                above = joint - 1
                turned, turning = (angle[joint] - angle[above], speed[joint] - speed[above]) if joint else (angle[0], speed[0])
                push = kind(kp) * (kind(target) - turned) - kind(kd) * turning
                torque[joint] += push
                if joint:
                    torque[above] -= push
            return np.concatenate([speed, solved(coupling * np.cos(apart) + inertia, torque)])

        return of

    def start(self, kind):
        return np.array([*self.angles, *[0.0] * len(self.angles)], kind)


def solved(matrix, right):
    """Gauss without pivots: the matrix is symmetric and positive. numpy's own has no long double."""
    matrix, right = matrix.copy(), right.copy()
    count = len(right)
    for i in range(count - 1):
        share = matrix[i + 1 :, i] / matrix[i, i]
        matrix[i + 1 :, i:] -= np.outer(share, matrix[i, i:])
        right[i + 1 :] -= share * right[i]
    for i in range(count - 1, -1, -1):
        right[i] = (right[i] - matrix[i, i + 1 :] @ right[i + 1 :]) / matrix[i, i]
    return right


def extrapolated(rods, times, step, columns):
    """Gragg's midpoint rule with 2, 4, .. substeps of a step, extrapolated to none (Hairer, Norsett and Wanner II.9)."""
    of, state, time, found = rods.rate(WIDE), rods.start(WIDE), 0.0, []
    for until in times:
        steps = max(1, round((until - time) / step))
        length = (WIDE(repr(until)) - WIDE(repr(time))) / steps
        for _ in range(steps):
            rows, slope = [], of(state)
            for row in range(1, columns + 1):
                count = 2 * row
                h = length / count
                before, now = state, state + h * slope
                for _ in range(count - 1):
                    before, now = now, before + 2 * h * of(now)
                new = [(before + now + h * of(now)) / 2]
                for k in range(1, row):
                    ratio = WIDE(row) / (row - k)
                    new.append(new[k - 1] + (new[k - 1] - rows[-1][k - 1]) / (ratio**2 - 1))
                rows.append(new)
            state = rows[-1][-1]
        time = until
        found.append(state[: len(rods.angles)].copy())
    return np.array(found)


def truth(name, rods, times, step):
    best = extrapolated(rods, times, step / 2, 8)
    other = extrapolated(rods, times, step / 3, 7)
    span = (0.0, times[-1])
    of = rods.rate(np.float64)
    check = solve_ivp(lambda _, state: of(state), span, rods.start(np.float64), "DOP853", times, rtol=2.3e-14, atol=1e-15).y.T
    # How much a start that is wrong by 1e-10 counts: the growth of errors.
    moved = extrapolated(replace(rods, angles=(rods.angles[0] + 1e-10, *rods.angles[1:])), times, step, 8)
    known, checked = float(abs(best - other).max()), float(abs(best - check[:, : best.shape[1]]).max())
    growth = [float(abs(row).max() / 1e-10) for row in moved - best]
    print(f"{name}: known to {known:.1e}, DOP853 differs by {checked:.1e}, errors grow by {growth}")
    return {"known_to": known, "dop853_differs_by": checked, "samples": times, "angles": [[float(x) for x in row] for row in best]}


def main():
    level, thirty = math.pi / 2, math.radians(problems.CHAIN_START)
    chain = problems.CHAIN
    found = {
        "double_pendulum": truth(
            "double_pendulum", Rods((1.0, 1.0), (1.0, 1.0), angles=(level, level)), problems.DOUBLE_TIMES, 0.05
        ),
        "chain_and_ball": truth(
            "chain_and_ball",
            Rods((chain["mass"],) * chain["count"], (chain["length"],) * chain["count"], chain["ball"], angles=(thirty,) * chain["count"]),
            problems.CHAIN_TIMES,
            0.005,
        ),
        "two_link_arm": truth(
            "two_link_arm",
            Rods((1.0, 0.8), (0.5, 0.4), servos=tuple((target, problems.KP, problems.KD) for target in problems.TARGETS), angles=(0.0, 0.0)),
            problems.ARM_TIMES,
            0.01,
        ),
    }
    (Path(__file__).parent / "joints.json").write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
