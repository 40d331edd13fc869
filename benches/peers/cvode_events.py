"""CVODE with root finding, each contact state to its first event; initialised anew beyond it."""

import numpy as np
from sksundae.cvode import CVODE

from common import answer, run, scene

ROOT = 2


def segment(method, rtol, scale):
    def go(slope, guards, t, until, z):
        rows = np.array([guard[0] for guard in guards])
        offsets = np.array([guard[1] for guard in guards])

        def rhs(t, z, out):
            out[:] = slope(t, z)

        def events(_, z, out):
            out[:] = rows @ z - offsets

        events.terminal = [True] * len(guards)
        events.direction = [guard[2] for guard in guards]
        solver = CVODE(
            rhs,
            method=method,
            rtol=rtol,
            atol=rtol * scale,
            eventsfn=events,
            num_events=len(guards),
            max_num_steps=100_000,
        )
        solver.init_step(t, z)
        solved = solver.step(until, method="normal", tstop=until)
        if solved.status < 0:
            raise RuntimeError(solved.message)
        if solved.status != ROOT:
            return until, np.array(solved.y).ravel(), None
        z = np.array(solved.y).ravel()
        # Of those that move towards their surfaces in the right direction, the one that is there; the solver's own list may be
        # an old one.
        speeds = rows @ slope(0.0, z)
        wrong = speeds * np.array([guard[2] for guard in guards]) < 0.0
        off = np.abs(rows @ z - offsets) / (np.abs(speeds) + 1e-300)
        off[wrong] = np.inf
        return float(np.ravel(solved.t)[-1]), z, guards[int(np.argmin(off))]

    return go


if __name__ == "__main__":
    problem = scene()
    for method in ["Adams", "BDF"]:
        for rtol in [1e-4, 1e-6, 1e-9, 1e-12]:
            answer(f"CVODE {method}, rtol {rtol:.0e}", lambda: run(problem, segment(method, rtol, 1e-2)))
