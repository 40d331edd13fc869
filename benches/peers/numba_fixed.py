"""Classical Runge-Kutta with a fixed step, compiled; the contact state is looked up once a step."""

import numba
import numpy as np

from common import CEILING, FLIGHT, FLOOR, answers

WORDS = {
    (FLIGHT, FLOOR): "floor_contact",
    (FLIGHT, CEILING): "ceiling_contact",
    (FLOOR, FLIGHT): "floor_release",
    (CEILING, FLIGHT): "ceiling_release",
}


@numba.njit(cache=False)
def go(z, stiffness, damping, rows, answers, masses, gaps, laws, gravity, jump, observed, period, skip, cycles, steps, log):
    n, p = stiffness.shape[0], rows.shape[0]
    v = n + p
    order = 2 * v
    h = period / steps
    contacts = np.ones(p, dtype=np.int64)
    slopes = np.zeros((4, order))
    at = np.zeros(order)
    total, count = 0.0, 0
    for cycle in range(cycles):
        z[v : v + n] += jump
        for step in range(steps):
            speed = 0.0
            for i in range(n):
                speed += observed[i] * z[v + i]
            before = speed * speed
            for stage in range(4):
                back = 0.0 if stage == 0 else (h if stage == 3 else 0.5 * h)
                for i in range(order):
                    at[i] = z[i] + (back * slopes[stage - 1, i] if stage > 0 else 0.0)
                out = slopes[stage]
                for i in range(v):
                    out[i] = at[v + i]
                for i in range(n):
                    sum_ = 0.0
                    for k in range(n):
                        sum_ -= stiffness[i, k] * at[k] + damping[i, k] * at[v + k]
                    out[v + i] = sum_
                for j in range(p):
                    out[v + n + j] = -gravity
                    if contacts[j] != 0:
                        side = contacts[j] - 1
                        u = at[n + j] - (gaps[j] if side == 1 else 0.0)
                        w = at[v + n + j]
                        for i in range(n):
                            u -= rows[j, i] * at[i]
                            w -= rows[j, i] * at[v + i]
                        push = -laws[j, side, 0] * u - laws[j, side, 1] * w
                        out[v + n + j] += push / masses[j]
                        for i in range(n):
                            out[v + i] -= answers[j, i] * push
            for i in range(order):
                z[i] += h / 6.0 * (slopes[0, i] + 2.0 * slopes[1, i] + 2.0 * slopes[2, i] + slopes[3, i])
            if cycle >= skip:
                speed = 0.0
                for i in range(n):
                    speed += observed[i] * z[v + i]
                total += 0.5 * h * (before + speed * speed)
            for j in range(p):
                u = z[n + j]
                for i in range(n):
                    u -= rows[j, i] * z[i]
                now = 1 if u < 0.0 else (2 if u > gaps[j] else 0)
                if now != contacts[j]:
                    if count < log.shape[0]:
                        log[count, 0] = cycle * period + (step + 1) * h
                        log[count, 1], log[count, 2], log[count, 3] = j, contacts[j], now
                    count += 1
                    contacts[j] = now
    return total, count


def once(problem, step):
    steps = max(1, round(problem.period / step))
    masses = np.array([particle["mass"] for particle in problem.particles])
    gaps = np.array([particle["gap"] for particle in problem.particles])
    laws = np.array(
        [[[particle[side]["stiffness"], particle[side]["damping"]] for side in ("floor", "ceiling")] for particle in problem.particles]
    )
    log = np.zeros((100_000, 4))
    total, count = go(
        problem.start[:-1].copy(), problem.stiffness, problem.damping, problem.rows, problem.answers, masses, gaps, laws,
        problem.gravity, problem.jump, problem.observed, problem.period, problem.skip, problem.cycles, steps, log,
    )
    rms = float(np.sqrt(total / ((problem.cycles - problem.skip) * problem.period)))
    known = [(float(t), int(j), WORDS.get((int(a), int(b)), "jump")) for t, j, a, b in log[:count]]
    return rms, known


if __name__ == "__main__":
    answers(
        ["RK4"],
        [1e-3, 1e-4, 1e-5, 1e-6],
        lambda problem, _, step: once(problem, step),
        lambda method, step: f"numba {method}, step {step:.0e} s",
        prepare=lambda problem: once(problem, problem.period),  # Compiles.
    )
