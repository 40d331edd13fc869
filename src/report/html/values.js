// Values of a figure under the pointer, and with the arrow keys. The SVG carries the axes of each frame; a place on a curve is
// read from its path, a cell of a map from the numbers beside it.
(() => {
  const box = document.getElementById("value");
  const NS = "http://www.w3.org/2000/svg";

  const axis = (words) => {
    const [scale, from, to] = words.split(" ");
    const ends = [from, to].map(Number).map(scale === "log" ? Math.log10 : (x) => x);
    return (share) => {
      const along = ends[0] + share * (ends[1] - ends[0]);
      return scale === "log" ? 10 ** along : along;
    };
  };

  // A path of the figures is `M x y` and relative steps; its corners.
  const corners = (d) => {
    const found = [];
    let [x, y] = [0, 0];
    for (const [, command, numbers] of d.matchAll(/([Mlz])([^Mlz]*)/g)) {
      const all = (numbers.match(/-?[\d.]+/g) ?? []).map(Number);
      for (let i = 0; i + 1 < all.length; i += 2) {
        [x, y] = command === "M" ? [all[i], all[i + 1]] : [x + all[i], y + all[i + 1]];
        found.push([x, y]);
      }
    }
    return found;
  };

  const known = new WeakMap();
  const frames = (svg) => {
    if (!known.has(svg)) {
      known.set(svg, [...svg.querySelectorAll("[data-frame]")].map((group) => {
        const [left, top, right, bottom] = group.dataset.frame.split(" ").map(Number);
        const curves = [...group.querySelectorAll("[data-name]")].map((one) => ({
          name: one.dataset.name,
          color: one.querySelector("[stroke]")?.getAttribute("stroke"),
          // Dots are stretches of their own, each from an M on.
          stretches: [...one.querySelectorAll("path[fill=none]")].flatMap((path) => path.getAttribute("d").split(/(?=M)/).map(corners)),
        }));
        return { group, left, top, right, bottom, curves, x: axis(group.dataset.x), y: axis(group.dataset.y) };
      }));
    }
    return known.get(svg);
  };

  const number = (value) => {
    if (!Number.isFinite(value)) return "no value";
    const size = Math.abs(value);
    const text = size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(2) : String(Number(value.toPrecision(4)));
    return text.replace("-", "−");
  };
  const named = (label, value) => {
    const unit = label.match(/ \(([^()]*)\)$/);
    return (unit ? label.slice(0, unit.index) : label) + ": " + number(value) + (unit ? " " + unit[1] : "");
  };

  // The place on any of these stretches that is nearest to a point; across counts less than up and down.
  const nearest = (stretches, px, py) => {
    let best = null;
    for (const points of stretches) {
      for (let i = 0; i < points.length; i++) {
        const [ax, ay] = points[i];
        const [bx, by] = points[Math.min(i + 1, points.length - 1)];
        const [dx, dy] = [bx - ax, by - ay];
        const long = dx * dx + dy * dy;
        const along = long ? Math.min(1, Math.max(0, ((px - ax) * dx + (py - ay) * dy) / long)) : 0;
        const [x, y] = [ax + along * dx, ay + along * dy];
        const off = (x - px) ** 2 + (y - py) ** 2;
        if (!best || off < best.off) best = { x, y, off };
      }
    }
    return best;
  };

  // The place of a curve at x, or the corner that comes nearest to it.
  const above = (stretches, x) => {
    let best = null;
    for (const points of stretches) {
      for (let i = 0; i < points.length; i++) {
        const [[ax, ay], [bx, by]] = [points[i], points[Math.min(i + 1, points.length - 1)]];
        if (ax < bx && ax <= x && x <= bx) return [x, ay + ((x - ax) / (bx - ax)) * (by - ay)];
        if (!best || Math.abs(ax - x) < Math.abs(best[0] - x)) best = [ax, ay];
      }
    }
    return best;
  };

  const at = (frame, x, y) => {
    const across = (x - frame.left) / (frame.right - frame.left);
    const up = (frame.bottom - y) / (frame.bottom - frame.top);
    return [frame.x(across), frame.y(up)];
  };

  const cell = (frame, px, py) => {
    const { columns, rows, values, valueLabel, xLabel, yLabel } = frame.group.dataset;
    const [xs, ys] = [columns, rows].map((list) => list.split(" ").map(Number));
    const [x, y] = at(frame, px, py);
    const close = (list, value) => list.reduce((best, one, i) => (Math.abs(one - value) < Math.abs(list[best] - value) ? i : best), 0);
    const [column, row] = [close(xs, x), close(ys, y)];
    const value = Number(values.split(" ")[row * xs.length + column]);
    return [named(valueLabel, value), named(xLabel, xs[column]), named(yLabel, ys[row])];
  };

  const clear = () => {
    box.hidden = true;
    document.querySelector("#spot")?.remove();
  };
  const tell = (lines, x, y) => {
    box.replaceChildren(...lines.map((line) => Object.assign(document.createElement("div"), { textContent: line })));
    box.hidden = false;
    const { offsetWidth: wide, offsetHeight: high } = box;
    box.style.left = Math.max(4, Math.min(x + 14, innerWidth - wide - 4)) + "px";
    box.style.top = (y + 14 + high > innerHeight ? y - high - 10 : y + 14) + "px";
  };
  const spot = (svg, x, y, color) => {
    document.querySelector("#spot")?.remove();
    const circle = document.createElementNS(NS, "circle");
    for (const [name, value] of Object.entries({ id: "spot", cx: x, cy: y, r: 110, fill: "none", stroke: color ?? "#888", "stroke-width": 35 })) {
      circle.setAttribute(name, value);
    }
    svg.append(circle);
  };

  const show = (svg, frame, x, y, client, only) => {
    if (frame.group.dataset.values) return tell(cell(frame, x, y), client.x, client.y);
    const found = (only ? [only] : frame.curves)
      .map((curve) => ({ curve, place: nearest(curve.stretches, x, y) }))
      .filter(({ place }) => place)
      .sort((a, b) => a.place.off - b.place.off)[0];
    if (!found) return clear();
    const { curve, place } = found;
    spot(svg, place.x, place.y, curve.color);
    const [vx, vy] = at(frame, place.x, place.y);
    const { xLabel, yLabel } = frame.group.dataset;
    const lines = [named(xLabel, vx), named(yLabel, vy)];
    if (curve.name && yLabel.toLowerCase() !== curve.name.toLowerCase()) lines.unshift(curve.name);
    tell(lines, client.x, client.y);
  };

  const inside = (svg, client) => new DOMPoint(client.x, client.y).matrixTransform(svg.getScreenCTM().inverse());

  addEventListener("pointermove", (event) => {
    const svg = event.target.closest?.("figure svg");
    if (!svg) return clear();
    const note = event.target.closest("[data-note]");
    const client = { x: event.clientX, y: event.clientY };
    if (note) return tell([note.dataset.note], client.x, client.y);
    const { x, y } = inside(svg, client);
    const frame = frames(svg).find((one) => x >= one.left && x <= one.right && y >= one.top && y <= one.bottom);
    if (frame) show(svg, frame, x, y, client);
    else clear();
  });

  // With the keyboard: left and right along a curve, up and down to the next one.
  for (const svg of document.querySelectorAll("figure svg")) {
    if (!svg.querySelector("[data-frame]")) continue;
    svg.setAttribute("tabindex", "0");
    svg.setAttribute("aria-roledescription", "figure; arrow keys read its values");
    let [frame, curve, share] = [0, 0, 0.5];
    svg.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (event.key === "Escape") clear();
      if (!step) return;
      event.preventDefault();
      const all = frames(svg).flatMap((one, i) => (one.curves.length ? one.curves : [null]).map((_, j) => [i, j]));
      const now = Math.max(0, all.findIndex(([i, j]) => i === frame && j === curve));
      [frame, curve] = all[(now + step[1] + all.length) % all.length];
      share = Math.min(1, Math.max(0, share + step[0] / 50));
      const one = frames(svg)[frame];
      // A curve need not reach over the whole axis.
      const stretches = one.curves[curve]?.stretches ?? [];
      const reach = ([from, to], [x]) => [Math.min(from, x), Math.max(to, x)];
      const [from, to] = stretches.length ? stretches.flat().reduce(reach, [Infinity, -Infinity]) : [one.left, one.right];
      const x = from + share * (to - from);
      const [px, py] = above(stretches, x) ?? [x, (one.top + one.bottom) / 2];
      const client = new DOMPoint(px, py).matrixTransform(svg.getScreenCTM());
      show(svg, one, px, py, client, one.curves[curve]);
    });
    svg.addEventListener("blur", clear);
  }
})();
