// What is drawn of a view: lines in metres through one matrix with y up, marks in pixels above them.

const SVG = "http://www.w3.org/2000/svg";
const MARGIN = { left: 38, bottom: 24, top: 6, right: 6 }; // pixels about the map, for its numbers
const DIGIT = 6.5; // pixels of a number's width
const WRITTEN = 0.01; // a lighter hypothesis is drawn, and its weight not written

function element(name, attributes = {}, text = "") {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text) made.textContent = text;
  return made;
}

function trace(points, close = false) {
  let d = "",
    pen = "M";
  for (let i = 0; i + 1 < points.length; i += 2) {
    if (points[i] === null) {
      pen = "M";
      continue;
    } // here a way breaks
    d += pen + points[i] + " " + points[i + 1];
    pen = "L";
  }
  return close && d ? d + "z" : d;
}

// The recorded positions up to a step that the filter is not given.
function fixesUntil(step) {
  const [steps, points] = lesson.fixes ?? [[], []],
    n = steps.findIndex(each => each > step);
  return points.slice(0, 2 * (n < 0 ? steps.length : n));
}

class Picture {
  // close : whether it is the close-up, which has no robot that could cover its ellipse
  constructor(svg, close) {
    Object.assign(this, { svg, close, parts: new Map(), marks: [] });
    this.ground = svg.appendChild(
      element("rect", { class: lesson.world.boundary.length ? "ground" : "ground open" }),
    );
    const clip = svg.appendChild(element("clipPath", { id: svg.id + "-clip" }));
    this.window = clip.appendChild(element("rect"));
    const inside = svg.appendChild(element("g", { "clip-path": `url(#${svg.id}-clip)` }));
    this.plane = inside.appendChild(element("g"));
    this.above = inside.appendChild(element("g"));
    this.words = svg.appendChild(element("g"));
    this.world();
  }

  // A line or an area, made once and then moved.
  line(key, name, points, closed = false, symbol = "") {
    let part = this.parts.get(key);
    if (!part) {
      part = this.plane.appendChild(element("path", { class: name }));
      this.parts.set(key, part);
      if (symbol && !this.close) ask(part, symbol);
      else if (symbol) part.dataset.symbol = symbol;
    }
    part.setAttribute("class", name);
    part.setAttribute("d", trace(points, closed));
    part.style.display = points.length ? "" : "none";
    return part;
  }

  // A mark at each of some points.
  mark(key, name, shape, points) {
    let part = this.parts.get(key);
    if (!part) {
      part = this.above.appendChild(element("g"));
      this.parts.set(key, part);
    }
    this.marks.push(part);
    part.replaceChildren();
    for (let i = 0; i + 1 < points.length; i += 2) {
      const one = part.appendChild(element("path", { class: name, d: MARKS[shape] }));
      one.place = [points[i], points[i + 1]];
    }
    return part;
  }

  world() {
    const { world, told, meant, landmarks } = lesson;
    if (world.boundary.length) this.line("floor", "floor", world.boundary, true);
    world.obstacles.forEach((each, i) => this.line("obstacle" + i, "obstacle", each.ring, true));
    if (meant) this.line("meant", "meant", meant, true);
    if (world.boundary.length) this.line("boundary", "boundary", world.boundary, true);
    world.walls.forEach((line, i) => this.line("wall" + i, "boundary", line));
    if (told) {
      [told.boundary, ...told.obstacles.map(each => each.ring)].forEach((ring, i) =>
        this.line("told" + i, "told", ring, true),
      );
      told.walls.forEach((line, i) => this.line("told-wall" + i, "told", line));
    }
    this.landmarks = landmarks.flatMap(([x, y]) => [x, y]);
  }

  // Fit a rectangle of the plane into so many pixels.
  fit([left, bottom, right, top], width, height, margin) {
    const wide = width - margin.left - margin.right,
      high = height - margin.top - margin.bottom;
    const scale = Math.min(wide / (right - left), high / (top - bottom));
    const east = margin.left + (wide - scale * (right - left)) / 2,
      south = margin.top + (high + scale * (top - bottom)) / 2;
    const box = { x: margin.left, y: margin.top, width: wide, height: high };
    for (const rect of [this.ground, this.window])
      for (const [key, value] of Object.entries(box)) rect.setAttribute(key, value);
    this.matrix = [scale, 0, 0, -scale, east - scale * left, south + scale * bottom];
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.plane.setAttribute("transform", `matrix(${this.matrix.join(" ")})`);
    this.box = box;
  }

  pixel([x, y]) {
    const [a, , , d, e, f] = this.matrix;
    return [a * x + e, d * y + f];
  }

  // unit : m, the robot's radius; told : which filter's numbers and reading are shown
  show(view, before, unit, told, shown) {
    this.marks = [];
    const ways = lesson.ways;
    this.line("true-path", "true-path", ways.true.slice(0, 2 * view.true));
    this.line("reckoned", "reckoned", ways.reckoned.slice(0, 2 * view.reckoned));
    view.by.forEach((belief, i) =>
      this.belief(belief, before?.by[i], unit, i, i === told, shown[i]),
    );
    this.reading(shown[told] ? view.by[told].seen : null);
    const truth = view.truth;
    this.line(
      "true-heading",
      "true-heading",
      truth ? [truth[0], truth[1], ...ahead(truth, TRUE_HEADING * unit)] : [],
    );
    this.mark("landmarks", "landmark", "triangle", this.landmarks);
    lesson.filters.forEach((filter, i) =>
      this.mark(
        "reference" + i,
        i ? "second reference" : "reference",
        filter.mark ?? "o",
        shown[i] && !view.by[i].unplaced ? view.by[i].pose.slice(0, 2) : [],
      ).style.setProperty("--own", filter.ink ?? ""),
    );
    this.mark("fixes", "fix", "plus", view.fix ?? fixesUntil(view.step));
    this.mark("truth", "truth", "dot", truth ? truth.slice(0, 2) : []);
    this.arrange();
  }

  belief(belief, before, unit, i, told, wanted) {
    const shown = wanted && !belief.unplaced; // a crowd all over the room tells no place
    const { pose } = belief,
      P = poseBlock(symmetric(belief.P), lesson.places),
      k = lesson.k;
    const path = wanted
      ? [...lesson.ways.paths[i].slice(0, 2 * belief.path), ...(shown ? pose.slice(0, 2) : [])]
      : [];
    const oval = shown ? outline(pose, P, k) : [];
    const old = shown && before && !before.unplaced ? before.pose : null;
    if (i) {
      const { ink, dashes } = lesson.filters[i];
      for (const part of [
        this.line("path" + i, "second", path),
        this.line("ellipse" + i, "second", oval, true, told ? "P" : ""),
        this.line(
          "heading" + i,
          "second",
          shown ? [pose[0], pose[1], ...ahead(pose, NOSE * unit)] : [],
        ),
      ]) {
        part.style.setProperty("--own", ink);
        part.style.strokeDasharray = dashes;
      }
      return;
    }
    const half = lesson.cone * Math.sqrt(Math.max(P[2][2], 0)),
      [off, turned] = belief.outside ?? [0, 0];
    this.line(
      "cone",
      turned ? "cone wrong" : "cone",
      shown ? sector(pose, half, CONE * unit) : [],
      true,
      "P",
    );
    const was = old ? poseBlock(symmetric(before.P), lesson.places) : null;
    this.line(
      "ghost-cone",
      "ghost",
      old ? sector(old, lesson.cone * Math.sqrt(Math.max(was[2][2], 0)), CONE * unit) : [],
      true,
    );
    if (lesson.conditional)
      for (const [sign, name] of [
        [1, "plus"],
        [-1, "minus"],
      ])
        this.line(
          "conditional" + name,
          "conditional " + name,
          shown ? outline(...conditioned(pose, P, sign * half), k) : [],
          true,
        );
    this.line("path", "path", path);
    const covers = ellipse(P, k).major < lesson.covered * unit; // then it is hollow
    if (!this.close)
      this.line("body", covers ? "body hollow" : "body", shown ? robot(pose, unit) : [], true);
    const moved = old && belief.K ? [old[0], old[1], pose[0], pose[1]] : [];
    this.line("shift", "shift", moved);
    this.line("shift-hit", "hit", moved, false, "K");
    this.line("ellipse", off ? "ellipse wrong" : "ellipse", oval, true, "P");
    this.line("ghost", "ghost", old ? outline(old, was, k) : [], true);
    this.several((shown && belief.several) || [], k);
    this.mark("crowd", "particle", "dot", (wanted && belief.crowd) || []);
  }

  // The ellipses of a belief of several Gaussians, as bold as each is heavy; parts : lightest first.
  several(parts, k) {
    const written = [];
    for (let i = 0; i < parts.length || this.parts.has("hypothesis" + i); i++) {
      const [weight, x, y, xx, xy, yy] = parts[i] ?? [];
      const oval = parts[i] ? outline([x, y], [[xx, xy], [xy, yy]], k) : [];
      const part = this.line("hypothesis" + i, "hypothesis", oval, true);
      part.style.opacity = 0.35 + 0.65 * (weight ?? 0);
      part.replaceChildren();
      if (parts[i]) part.appendChild(element("title")).textContent = `weight ${weight.toFixed(3)}`;
      if (weight >= WRITTEN) written.unshift([weight.toFixed(2), oval]);
    }
    const group = this.mark("weights", "", "dot", []);
    for (const [weight, oval] of written) {
      const one = group.appendChild(element("text", { class: "weight" }, weight));
      const [xs, ys] = [0, 1].map(side => oval.filter((_, i) => i % 2 === side));
      const [left, right, low, high] = [xs, ys].flatMap(all => [Math.min(...all), Math.max(...all)]);
      one.place = [(left + right) / 2, (low + high) / 2];
      one.half = [(right - left) / 2, (high - low) / 2];
    }
  }

  // Each weight beside its ellipse, where it covers none of a heavier one; nowhere without room.
  weigh() {
    const [scale] = this.matrix,
      taken = [];
    for (const one of this.parts.get("weights")?.children ?? []) {
      const [x, y] = this.pixel(one.place),
        [across, up] = one.half.map(half => half * scale);
      const spots = [
        [x, y - up - 3],
        [x, y + up + 12],
        [x + across + 15, y + 4],
        [x - across - 15, y + 4],
      ];
      const spot = spots.find(([u, v]) =>
        taken.every(([a, b]) => Math.abs(u - a) > 28 || Math.abs(v - b) > 12),
      );
      one.style.display = spot ? "" : "none";
      if (!spot) continue;
      taken.push(spot);
      one.setAttribute("transform", `translate(${spot.join(" ")})`);
    }
  }

  reading(seen) {
    const {
      line = [],
      style = "used",
      way = [],
      end = [],
      expected = [],
      place = [],
      probes = [],
      walls = [],
    } = seen ?? {};
    this.line(
      "walls",
      "other-wall",
      walls.flatMap(wall => [...wall, null, null]),
    );
    this.line(
      "probes",
      "probe",
      probes.flatMap(probe => [...probe, null, null]),
    );
    this.line("way", "way", way);
    this.line("beam", "beam " + style, line);
    this.line("beam-hit", "hit", line, false, "H");
    this.mark("place", "place", "ring", place);
    this.mark("end", seen?.hollow ? "end hollow" : "end", seen?.in ?? "air", end);
    this.mark("expected", "expected", "diamond", expected);
    this.mark(
      "starts",
      "end",
      "dot",
      probes.flatMap(probe => probe.slice(0, 2)),
    );
  }

  // Put the marks where the matrix puts their points.
  arrange() {
    for (const group of this.marks) {
      for (const one of group.children)
        one.setAttribute("transform", `translate(${this.pixel(one.place).join(" ")})`);
    }
    this.weigh();
  }

  // Numbers along two sides, and the obstacles' names where they have room.
  label() {
    this.words.replaceChildren();
    const { x, y, width, height } = this.box,
      [scale, , , , east, south] = this.matrix,
      [ox, oy] = lesson.origin;
    const step = oneTwoFive(60 / scale);
    const number = m => m.toFixed(Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
    const write = (place, text, more) =>
      this.words.appendChild(element("text", { x: place[0], y: place[1], ...more }, text));
    const each = (step, from, to, put) => {
      for (let i = Math.ceil(from / step); i * step <= to; i++) put(i * step);
    };
    const longest = (...values) => DIGIT * Math.max(...values.map(m => number(m).length));
    const [left, right] = [x, x + width].map(place => (place - east) / scale + ox);
    const long = longest(left, right) + 2 * DIGIT;
    each(Math.max(step, oneTwoFive((12 + long) / scale)), left, right, m => {
      const place = scale * (m - ox) + east;
      if (place + long / 2 <= x + width + MARGIN.right)
        write([place, y + height + 14], number(m) + " m", {
          class: "tick",
          "text-anchor": "middle",
        });
    });
    const [low, high] = [y + height, y].map(place => (south - place) / scale + oy);
    const beside = longest(low, high) < x - 4; // else they stand on the map, whole
    each(step, low, high, m =>
      write([beside ? x - 4 : x + 4, south - scale * (m - oy) + 4], number(m), {
        class: "tick",
        "text-anchor": beside ? "end" : "start",
      }),
    );
    const taken = lesson.landmarks.map(mark => this.pixel(mark)); // no number stands on another
    for (const [east, north, number] of lesson.landmarks) {
      const [a, b] = this.pixel([east, north]),
        place = [a + 7 + 3 * number.length, b + 6];
      if (
        taken.some(
          ([c, d]) =>
            Math.abs(c - place[0]) < 6 + 4 * number.length &&
            Math.abs(d - place[1]) < 9 &&
            (c !== a || d !== b),
        )
      )
        continue;
      taken.push(place);
      write([a + 6, b + 10], number, { class: "tick" });
    }
    for (const { name, ring, at } of lesson.world.obstacles) {
      const half = (3.3 * name.length) / scale,
        room = [-half, half].every(by => inside(ring, [at[0] + by, at[1]]));
      const place = this.pixel(at);
      if (room) write([place[0], place[1] + 4], name, { class: "name" });
    }
    for (const { name, at } of lesson.world.names) {
      const [a, b] = this.pixel(at);
      write([a, b - 5], name, { class: "name" });
    }
    this.words.appendChild(element("rect", { class: "frame", ...this.box }));
  }
}
