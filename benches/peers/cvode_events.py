"""CVODE with root finding, each contact state to its first event; initialised anew beyond it."""

import numpy as np
from sksundae.cvode import CVODE

from common import answers, run

ROOT = 2


def segment(method, rtol):
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
            atol=1e-2 * rtol,
            eventsfn=events,
            num_events=len(guards),
            max_num_steps=100_000,
        )
        solver.init_step(t, z)
        solved = solver.step(until, method="normal", tstop=until)
        if solved.status < 0:
            raise RuntimeError(solved.message)
        # The status tells; the list of events may be an old one.
        is_event = solved.status == ROOT
        return float(np.ravel(solved.t)[-1]) if is_event else until, np.array(solved.y).ravel(), is_event

    return go


if __name__ == "__main__":
    answers(
        ["Adams", "BDF"],
        [1e-4, 1e-6, 1e-9, 1e-12],
        lambda scene, method, rtol: run(scene, segment(method, rtol)),
        lambda method, rtol: f"scikit-sundae {method}, rtol {rtol:.0e}",
    )
