"""SciPy's solve_ivp, each contact state to its first event."""

from scipy.integrate import solve_ivp

from common import answer, run, scene


def segment(method, rtol, scale):
    def go(slope, guards, t, until, z):
        events = []
        for row, offset, direction, *_ in guards:
            def event(_, z, row=row, offset=offset):
                return row @ z - offset

            event.terminal, event.direction = True, direction
            events.append(event)
        solved = solve_ivp(slope, (t, until), z, method=method, rtol=rtol, atol=rtol * scale, events=events)
        if not solved.success:
            raise RuntimeError(solved.message)
        hit = next((i for i, times in enumerate(solved.t_events) if len(times)), None)
        end = until if hit is None else solved.t[-1]
        return end, solved.y[:, -1].copy(), None if hit is None else guards[hit]

    return go


if __name__ == "__main__":
    problem = scene()
    for method in ["DOP853", "LSODA"]:
        for rtol in [1e-4, 1e-6, 1e-9, 1e-12]:
            answer(f"SciPy {method}, rtol {rtol:.0e}", lambda: run(problem, segment(method, rtol, 1e-2)))
