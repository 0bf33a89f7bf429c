// What the signs of the pictures mean, of those that occur in this run; and which filters are shown.

function legend(place) {
  const any = of => views.some(view => view.by.some(of)),
    seen = of => any(belief => belief.seen && of(belief.seen));
  const { labels, filters, told, meant, landmarks } = lesson,
    several = filters.length > 1;
  const first = several ? filters[0].name + ": " : "";
  const entries = [
    [true, first + "estimate", ["body", "area"], ["reference", "o"]],
    [true, first + "path of the estimates", ["path", "line"]],
    [true, labels.ellipse, ["ellipse", "area"]],
    [true, labels.cone, ["cone", "area"]],
    [any(belief => belief.outside), "… while the truth is outside", ["ellipse wrong", "area"]],
    [views.length > 1, "belief before", ["ghost", "area"]],
    ...filters
      .slice(1)
      .map(filter => [
        true,
        filter.name + ": estimate, ellipse, path",
        ["second", "line", filter],
        ["second reference", filter.mark, filter],
      ]),
    [any(belief => belief.several), "hypotheses, by weight", ["hypothesis", "line"]],
    [any(belief => belief.crowd), "particles", ["particle", "dot"]],
    [views.some(view => view.truth), "truth", ["true-heading", "line"], ["truth", "dot"]],
    [views.some(view => view.truth), "true way", ["true-path", "line"]],
    [true, "way by odometry alone", ["reckoned", "line"]],
    [seen(() => true), "reading, as measured", ["beam", "line"]],
    [seen(one => one.style === "refused"), "… is refused", ["beam refused", "line"]],
    [seen(one => one.style === "silent"), "… has no echo", ["beam silent", "line"]],
    [seen(one => one.in === "air"), "… ends in the air", ["end hollow", "air"]],
    [seen(one => one.in === "wall"), "… ends in or behind a wall", ["end", "wall"]],
    [seen(one => one.expected), "where it was expected", ["way", "line"], ["expected", "diamond"]],
    [seen(one => one.probes), "ambiguous: from within 3 σ", ["probe", "line"]],
    [seen(one => one.walls), "… the other wall", ["other-wall", "line"]],
    [seen(one => one.place), "landmark that it is of", ["place", "ring"]],
    [landmarks.length, "landmark", ["landmark", "triangle"]],
    ...(lesson.conditional ?? []).map((words, i) => [
      true,
      words,
      ["conditional " + ["plus", "minus"][i], "line"],
    ]),
    [
      lesson.fixes?.[0].length || views.some(view => view.fix),
      "fix, recorded and not used",
      ["fix", "plus"],
    ],
    [told, "filter's map", ["told", "area"]],
    [meant, "way that was meant", ["meant", "line"]],
  ];
  for (const [occurs, words, ...signs] of entries) {
    if (!occurs) continue;
    const line = place.appendChild(document.createElement("li"));
    line.append(sample(signs), words);
  }
}

function sample(signs) {
  const svg = element("svg", { viewBox: "0 0 30 18", "aria-hidden": "true" });
  for (const [name, shape, filter] of signs) {
    const d = { line: "M1 9H29", area: "M4 3H26V15H4z" }[shape];
    const part = svg.appendChild(
      element(
        "path",
        d ? { class: name, d } : { class: name, d: MARKS[shape], transform: "translate(15 9)" },
      ),
    );
    if (filter) part.style.setProperty("--own", filter.ink);
    if (filter && d) part.style.strokeDasharray = filter.dashes;
  }
  return svg;
}

// A box for each filter to show or hide it, and a choice whose numbers are told.
function toggles(place) {
  place.hidden = lesson.filters.length < 2;
  for (const [type, words] of [
    ["checkbox", "shown"],
    ["radio", "numbers of"],
  ]) {
    const line = place.appendChild(document.createElement("div"));
    line.append(words);
    lesson.filters.forEach((filter, i) => {
      const box = Object.assign(document.createElement("input"), {
        type,
        name: type,
        checked: type === "checkbox" || i === 0,
      });
      box.addEventListener("change", () => {
        if (type === "radio") told = i;
        else shown[i] = box.checked;
        lay();
      });
      const label = line.appendChild(document.createElement("label"));
      label.append(box, " " + filter.name);
    });
  }
}
