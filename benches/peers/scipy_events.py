"""SciPy's solve_ivp, each contact state to its first event."""

from scipy.integrate import solve_ivp

from common import answers, run


def segment(method, rtol):
    def go(slope, guards, t, until, z):
        events = []
        for row, offset, direction, *_ in guards:
            def event(_, z, row=row, offset=offset):
                return row @ z - offset

            event.terminal, event.direction = True, direction
            events.append(event)
        solved = solve_ivp(slope, (t, until), z, method=method, rtol=rtol, atol=1e-2 * rtol, events=events)
        if not solved.success:
            raise RuntimeError(solved.message)
        is_event = solved.status == 1
        return solved.t[-1] if is_event else until, solved.y[:, -1].copy(), is_event

    return go


if __name__ == "__main__":
    answers(
        ["DOP853", "LSODA"],
        [1e-4, 1e-6, 1e-9, 1e-12],
        lambda scene, method, rtol: run(scene, segment(method, rtol)),
        lambda method, rtol: f"SciPy {method}, rtol {rtol:.0e}",
        segment=segment,
    )
