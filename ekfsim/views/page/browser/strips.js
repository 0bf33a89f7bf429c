// Two curves of all views, NIS and NEES, each with the bound that one of a thousand right values passes.

class Strip {
  constructor(place, key, name, go) {
    Object.assign(this, { key, name, go });
    this.svg = place.appendChild(
      element("svg", { class: "strip", role: "img", "aria-label": name }),
    );
    this.svg.addEventListener("click", event => {
      const box = this.svg.getBoundingClientRect();
      const share = (event.clientX - box.left - 38) / (box.width - 44);
      this.go(Math.round(Math.min(1, Math.max(0, share)) * (lesson.views.length - 1)));
    });
  }

  get any() {
    return lesson.views.some(view => view.by.some(belief => belief[this.key]));
  }

  // Draw everything that stays; `show` moves the cursor alone.
  draw(width, shown) {
    const height = 74,
      svg = this.svg,
      { key } = this,
      n = Math.max(1, lesson.views.length - 1);
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.replaceChildren();
    this.x = i => 38 + ((width - 44) * i) / n;
    const values = lesson.views
      .flatMap(view => view.by.flatMap((belief, f) => (shown[f] && belief[key] ? belief[key] : [])))
      .filter(value => value > 0);
    const low = Math.log10(Math.max(0.01, Math.min(1, ...values))),
      high = Math.log10(Math.max(20, values.reduce((a, b) => Math.max(a, b), 0) * 1.3));
    const y = value =>
      height -
      16 -
      ((height - 22) * (Math.min(high, Math.log10(Math.max(value ?? Infinity, 10 ** low))) - low)) /
        (high - low);
    for (
      let power = Math.ceil(low);
      power <= high;
      power += Math.max(1, Math.round((high - low) / 3))
    )
      svg.appendChild(
        element(
          "text",
          { x: 34, y: y(10 ** power) + 4, "text-anchor": "end" },
          power < 5 ? String(Number((10 ** power).toPrecision(1))) : "1e" + power,
        ),
      );
    svg.appendChild(element("text", { x: 40, y: height - 3 }, this.name));
    const bounds = [];
    lesson.views.forEach((view, i) => {
      const told = view.by[0][key];
      if (told?.[1]) bounds.push(this.x(i), y(told[1]));
    });
    svg.appendChild(element("path", { class: "bound", d: trace(bounds) }));
    lesson.filters.forEach((filter, f) => {
      if (!shown[f]) return;
      const points = [];
      lesson.views.forEach((view, i) => {
        const told = view.by[f][key];
        if (told) points.push([this.x(i), y(told[0]), told[0] === null || told[0] > told[1]]);
      });
      const line = svg.appendChild(
        element("path", {
          class: f ? "second" : "value",
          d: trace(points.flatMap(([a, b]) => [a, b])),
        }),
      );
      if (f) {
        line.style.setProperty("--own", filter.ink);
        line.style.strokeDasharray = filter.dashes;
      }
      if (!f)
        for (const [a, b, over] of points)
          if (over || points.length < 150)
            svg.appendChild(
              element("path", {
                class: over ? "dot over" : "dot",
                d: over ? MARKS.diamond : MARKS.dot,
                transform: `translate(${a} ${b}) scale(.8)`,
              }),
            );
    });
    this.cursor = svg.appendChild(element("path", { class: "cursor" }));
  }

  show(i) {
    this.cursor.setAttribute("d", `M${this.x(i)} 2V60`);
  }
}
