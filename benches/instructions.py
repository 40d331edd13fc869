"""Instructions of a run, and how many of them belong to effects that its scene does not name.

    export CARGO_PROFILE_RELEASE_STRIP=none CARGO_PROFILE_RELEASE_DEBUG=line-tables-only
    cargo build --release --bench instructions
    python3 benches/instructions.py target/release/deps/instructions-*     (needs valgrind)

The settings keep the tables that tell lines of the engine. Each scene is run once and eleven times under `valgrind --tool=callgrind`;
a tenth of the difference is a run with its contact states known. Lines that speak of an effect (what a scene without it has to pass
by) are summed: their share is what the effect costs a scene that does not name it. Prints Markdown.
"""

import os
import re
import subprocess
import sys
import tempfile
from collections import defaultdict

EFFECTS = {
    "limit stop": re.compile(r"stop", re.I),
    "contact without tension": re.compile(r"no_tension|released|recovered|again", re.I),
    "equivalent viscous damping": re.compile(r"half_cycle|self\.half|rows\.bend|equivalent"),
    "soft walls": re.compile(r"squeez|wall|across|opposite", re.I),
}
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def counts(binary, scene, runs):
    """Instructions by (file, line), without those of callees."""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out")
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", "--dump-line=yes",
                   "--compress-strings=no", "--compress-pos=no", binary, scene, str(runs)]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        lines, file, skip = defaultdict(int), "", False
        with open(out) as text:
            for line in text:
                if line.startswith(("fl=", "fi=", "fe=")):
                    file = line[3:].strip()
                elif line.startswith("calls="):
                    skip = True
                elif line[:1].isdigit():
                    if not skip:
                        number, cost = line.split()[:2]
                        lines[file, int(number)] += int(cost)
                    skip = False
        return lines, int(done.stdout)


def source(file, number, known={}):
    path = file if os.path.isabs(file) else os.path.join(ROOT, file)
    if path not in known:
        known[path] = open(path).read().splitlines() if os.path.isfile(path) else []
    text = known[path]
    return text[number - 1] if 0 < number <= len(text) else ""


def main():
    binary = next(path for path in sys.argv[1:] if os.access(path, os.X_OK) and not path.endswith(".d"))
    scenes = subprocess.run([binary], capture_output=True, text=True, check=True).stdout.split()
    print("| Scene | Events | Instructions of a run | Against plain |" + "".join(f" {name} |" for name in EFFECTS))
    print("| --- | ---: | ---: | ---: |" + " ---: |" * len(EFFECTS))
    plain = None
    for scene in scenes:
        once, events = counts(binary, scene, 1)
        often, _ = counts(binary, scene, 11)
        run = {place: (often[place] - once.get(place, 0)) / 10 for place in often}
        total = sum(run.values())
        plain = plain or total
        cells = []
        for pattern in EFFECTS.values():
            own = sum(cost for (file, number), cost in run.items()
                      if "dynamics/src" in file and pattern.search(source(file, number)))
            cells.append(f" {100 * own / total:.2f} % |")
        print(f"| {scene.replace('_', ' ')} | {events} | {total:,.0f} | {100 * (total / plain - 1):+.1f} % |" + "".join(cells))


if __name__ == "__main__":
    main()
