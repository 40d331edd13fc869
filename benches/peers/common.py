"""What the peers share: a scene from JSON, its equations in each contact state, timing, and the answer as JSON."""

import json
import sys
import time

import numpy as np

FLIGHT, FLOOR, CEILING = 0, 1, 2


class Scene:
    """M q'' + C q' + K q = forces, particles between resilient faces that move with a row of the structure.

    State: q, y, q', y', and the integral of the squared observed velocity over the window.
    """

    def __init__(self, path):
        with open(path) as file:
            data = json.load(file)
        n = self.n = len(data["force_row"])
        inverse = np.linalg.inv(np.array(data["mass"]).reshape(n, n))
        self.damping = inverse @ np.array(data["damping"]).reshape(n, n)
        self.stiffness = inverse @ np.array(data["stiffness"]).reshape(n, n)
        self.gravity = data["gravity"]
        self.particles = data["particles"]
        self.p = len(self.particles)
        self.rows = np.array([particle["row"] for particle in self.particles]).reshape(self.p, n)
        self.answers = (inverse @ self.rows.T).T
        self.jump = inverse @ np.array(data["force_row"]) * data["impulse"]
        self.observed = np.array(data["observed_row"])
        self.period, self.skip, self.cycles = data["period"], data["skip"], data["cycles"]
        self.start = np.array(data["start"] + [0.0])
        self.size = len(self.start)

    def matrix(self, contacts):
        """A and b of z' = A z + b, without the integral."""
        n, p = self.n, self.p
        order = 2 * (n + p)
        a, b = np.zeros((order, order)), np.zeros(order)
        v = n + p
        a[:v, v:] = np.eye(v)
        a[v : v + n, :n] = -self.stiffness
        a[v : v + n, v : v + n] = -self.damping
        b[v + n :] = -self.gravity
        for j, particle in enumerate(self.particles):
            if contacts[j] == FLIGHT:
                continue
            face = particle["floor" if contacts[j] == FLOOR else "ceiling"]
            offset = 0.0 if contacts[j] == FLOOR else particle["gap"]
            k, c = face["stiffness"], face["damping"]
            # u and u' as rows; the push on the particle is -k u - c u'.
            u = np.zeros(order)
            u[:n], u[n + j] = -self.rows[j], 1.0
            push = -k * u - c * np.roll(u, v)
            for row, factor in [(v + n + j, 1.0 / particle["mass"])]:
                a[row] += factor * push
                b[row] += factor * k * offset
            a[v : v + n] -= np.outer(self.answers[j], push)
            b[v : v + n] -= self.answers[j] * k * offset
        return a, b

    def guards(self, contacts):
        """(row, offset, direction, particle, next contact, word) of each surface that ends a contact state."""
        guards = []
        for j, particle in enumerate(self.particles):
            row = np.zeros(self.size)
            row[: self.n], row[self.n + j] = -self.rows[j], 1.0
            gap = particle["gap"]
            if contacts[j] == FLIGHT:
                guards.append((row, 0.0, -1, j, FLOOR, "floor_contact"))
                guards.append((row, gap, 1, j, CEILING, "ceiling_contact"))
            elif contacts[j] == FLOOR:
                guards.append((row, 0.0, 1, j, FLIGHT, "floor_release"))
            else:
                guards.append((row, gap, -1, j, FLIGHT, "ceiling_release"))
        return guards

    def slope(self, contacts, averaged):
        a, b = self.matrix(contacts)
        n, v = self.n, self.n + self.p
        observed, size = self.observed, self.size

        def slope(_, z):
            out = np.empty(size)
            out[:-1] = a @ z[:-1] + b
            out[-1] = (observed @ z[v : v + n]) ** 2 if averaged else 0.0
            return out

        return slope

    def strike(self, z):
        z[self.n + self.p : 2 * self.n + self.p] += self.jump

    def rms(self, z):
        return float(np.sqrt(z[-1] / ((self.cycles - self.skip) * self.period)))


def run(scene, segment):
    """From impulse to impulse."""
    z, events, _ = to_the_end(scene, segment)
    return scene.rms(z), events


def to_the_end(scene, segment):
    z, events, contacts = scene.start.copy(), [], [FLOOR] * scene.p
    for number in range(scene.cycles):
        z, within = cycle(scene, segment, z, contacts, number >= scene.skip)
        events += [[number * scene.period + t, j, word] for t, j, word in within]
    return z, events, contacts


def cycle(scene, segment, z, contacts, averaged):
    """From event to event, contacts in place; `segment` goes to the first event or to the end: (t, z, whether it is one)."""
    z, events = z.copy(), []
    scene.strike(z)
    t, last = 0.0, 0
    while t < scene.period:
        before = t
        slope, guards = scene.slope(contacts, averaged), scene.guards(contacts)
        t, z, is_event = segment(slope, guards, t, scene.period, z)
        if is_event:
            for j, contact, word in met(guards, slope(t, z), z):
                contacts[j] = contact
                events.append([t, j, word])
        last = last + 1 if t == before else 0
        if last > 64:
            raise RuntimeError(f"no progress at {t} s of a cycle")
    return z, events


def orbit(scene, segment, rtol, z, contacts):
    """The RMS velocity of the motion that comes again, by shooting: Newton on the map of a cycle, its matrix by differences."""
    order = scene.size - 1

    def through(state):
        end, _ = cycle(scene, segment, np.append(state, 0.0), list(contacts), True)
        return end

    state = z[:order].copy()
    size = np.linalg.norm(state)
    kick = np.sqrt(rtol) * size
    for _ in range(20):
        end = through(state)[:order]
        matrix = np.column_stack([(through(state + kick * unit)[:order] - end) / kick for unit in np.eye(order)])
        step = np.linalg.solve(np.eye(order) - matrix, end - state)
        state = state + step
        if np.linalg.norm(step) <= 10.0 * rtol * size:
            return float(np.sqrt(through(state)[-1] / scene.period)), []
    raise RuntimeError("shooting does not converge")


def met(guards, slope, z):
    """The surface that is nearest in time, of those that are approached from the right side; with it all that lie behind already."""
    nearest, behind = None, []
    for row, offset, direction, *then in guards:
        speed, off = direction * (row @ slope), direction * (row @ z - offset)
        if speed <= 0.0:
            continue
        if nearest is None or abs(off) < nearest[0] * speed:
            nearest = (abs(off) / speed, then)
        if off > 0.0:
            behind.append(then)
    if nearest is None:
        raise RuntimeError("an event without a surface")
    return [nearest[1]] + [then for then in behind if then is not nearest[1]]


def answers(methods, settings, once, word, prepare=lambda scene: None, segment=None):
    """Prints a line of JSON an answer. A scene is run in all settings, repeatedly; after `--tightest` once, in the last of them; after
    `--orbit` the motion that comes again is looked for from the state in which a run ends, which is not timed."""
    tightest, is_orbit = sys.argv[1] == "--tightest", sys.argv[1] == "--orbit"
    for path in sys.argv[2 if tightest or is_orbit else 1 :]:
        scene = Scene(path)
        prepare(scene)
        for method in methods:
            for setting in settings[-1:] if tightest else settings:
                told = {"file": path, "solver": method, "setting": word(method, setting)}
                asked = lambda: once(scene, method, setting)
                if is_orbit:
                    ahead = segment(method, setting)
                    z, _, contacts = to_the_end(scene, ahead)
                    asked = lambda: orbit(scene, ahead, setting, z, contacts)
                print(json.dumps(told | answer(asked, tightest)), flush=True)


def answer(once, untimed, patience=0.7):
    """Result, events, times of repeated runs."""
    try:
        times, begun = [], time.perf_counter()
        # A slow run is its own median.
        while not times or (
            not untimed and times[0] < patience and len(times) < 200 and time.perf_counter() - begun < 3.0 * patience
        ):
            begin = time.perf_counter()
            rms, events = once()
            times.append(time.perf_counter() - begin)
        return {"rms": rms, "events": events, "times": times}
    except Exception as error:  # A peer that fails is a result too.
        return {"failure": f"{type(error).__name__}: {error}"}
