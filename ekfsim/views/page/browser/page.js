// The run, stepped through: which view is shown, and what asks for another.

const lesson = JSON.parse(document.getElementById("lesson").textContent);
const views = lesson.views,
  at = id => document.getElementById(id);
const TEMPO = { beam: 1300, other: 900, driven: 120 }; // ms that a view stays while the run plays
const still = matchMedia("(prefers-reduced-motion: reduce)");
let current = 0,
  told = 0,
  symbol = "P",
  clock = 0,
  linking = 0;
const shown = lesson.filters.map(() => true);

const map = new Picture(at("map"), false),
  close = new Picture(at("close"), true);
const strips = [
  ["nis", "NIS, with its 99.9 % bound"],
  ["nees", "NEES, with its 99.9 % bound"],
]
  .map(([key, name]) => new Strip(at("strips"), key, name, go))
  .filter(strip => strip.any || !strip.svg.remove());
let room = [], // pixels of the map
  limits = null; // what it shows of the plane

function go(i) {
  current = Math.min(views.length - 1, Math.max(0, i));
  show();
  clearTimeout(linking);
  linking = setTimeout(link, 200); // not at each of many: browsers bear few changes a second
}

function link() {
  const to = "#" + name(views[current]);
  if (location.hash !== to)
    try {
      history.replaceState(null, "", to);
    } catch {
      /* a sandbox has no history */
    }
}

// A step's link, as `render --step` has it: 13 is the step as it ended, 13b its beam.
function name(view) {
  return view.step + (view.beam ? "b" : "");
}

// The view that a link names; where it is not held, the last one before it.
function linked() {
  const found = /^#(\d+)(b?)$/.exec(location.hash);
  if (!found) return 0;
  const exact = views.findIndex(view => name(view) === found[1] + found[2]),
    step = Number(found[1]);
  return exact >= 0
    ? exact
    : Math.max(
        0,
        views.findLastIndex(view => view.step <= step),
      );
}

function show() {
  const view = views[current],
    belief = view.by[told],
    before = ghost();
  at("title").textContent = view.title;
  list(
    at("notes"),
    view.notes.filter(note => note !== view.say),
  );
  say();
  at("judgement").textContent = view.judged;
  at("judgement").className = view.by.some(one => one.outside || one.lost) ? "warns" : "";
  at("narrative").textContent = lines(belief.told);
  at("more").hidden = !belief.long;
  at("long").textContent = belief.long ? lines(belief.long) : "";
  at("spread").textContent = belief.spread;
  const spoken = `step ${view.step} of ${lesson.last}: ${view.title.replace(/^[^:]*: /, "")}`;
  at("slider").value = current;
  at("slider").setAttribute("aria-valuetext", spoken);
  at("count").textContent = `step ${view.step} of ${lesson.last}`;
  at("map-told").textContent =
    `${spoken}. ${belief.unplaced ? "" : where(belief.pose) + "; "}${belief.spread}. ${view.judged}.`;
  at("close-told").textContent = [belief.spread, view.away].filter(Boolean).join("; ");
  survey();
  const [, left, bottom, right, top] = limits;
  map.show(view, before, 0.022 * Math.max(right - left, top - bottom), told, shown);
  const [x, y] = belief.pose,
    w = view.wide / 2;
  close.fit([x - w, y - w, x + w, y + w], 300, 300, { left: 0, bottom: 0, top: 0, right: 0 });
  close.show(view, before, 0.07 * view.wide, told, shown);
  frame(view);
  for (const strip of strips) strip.show(current);
  for (const [id, off] of [
    ["first", current === 0],
    ["back", current === 0],
    ["next", current === views.length - 1],
    ["last", current === views.length - 1],
  ])
    at(id).disabled = off;
  choose(symbol);
}

// The map grows from where on the estimate, or the truth, has left what it shows.
function survey() {
  const now = lesson.limits.findLast(([first]) => first <= current);
  if (now === limits) return;
  limits = now;
  map.fit(limits.slice(1), ...room, MARGIN);
  map.label();
}

// What was believed before this view's step, where it is held and something else.
function ghost() {
  const before = views[current - 1],
    view = views[current];
  if (!before || view.beam || view.apart) return null;
  return view.by.some(
    (one, i) => String([one.pose, one.P]) !== String([before.by[i].pose, before.by[i].P]),
  )
    ? before
    : null;
}

function where([x, y, turn]) {
  const [east, north] = [x + lesson.origin[0], y + lesson.origin[1]].map(value => value.toFixed(2));
  return `The estimate is at x ${east} m, y ${north} m, heading ${((turn * 180) / Math.PI).toFixed(1)} degrees`;
}

// The lecture's text: that of this step, or else the last one that was said.
function say() {
  const last = views.findLastIndex((view, i) => i <= current && view.say);
  at("say").hidden = last < 0;
  at("say").textContent = last < 0 ? "" : views[last].say;
  at("say").className = last === current ? "" : "past";
}

function choose(asked) {
  symbol = asked;
  const belief = views[current].by[told];
  at("matrix").replaceChildren(...tables(asked, belief, views[current].inputs));
  const buttons = symbols(belief).map(one => {
    const made =
      [...at("symbols").children].find(each => each.dataset.symbol === one) ??
      document.createElement("button");
    if (!made.type || made.type !== "button") made.type = "button";
    if (!made.dataset.symbol) {
      ask(made, one);
      made.textContent = TOGETHER[one].join(" ");
    }
    made.setAttribute("aria-pressed", String(TOGETHER[one].includes(belief[asked] ? asked : "P")));
    return made;
  });
  if (
    buttons.length !== at("symbols").children.length ||
    buttons.some((each, i) => each !== at("symbols").children[i])
  )
    at("symbols").replaceChildren(...buttons);
}

function lines(places) {
  return places.map(place => lesson.lines[place]).join("\n");
}

function list(place, texts) {
  place.replaceChildren(
    ...texts.map(text => Object.assign(document.createElement("li"), { textContent: text })),
  );
}

// The close-up's frame, its scale, and where the truth is when that lies beyond it.
function frame({ wide, away }) {
  const length = oneTwoFive(wide / 6),
    pixels = (300 * length) / wide;
  close.words.replaceChildren(
    element("path", { class: "bar", d: `M14 286h${pixels}` }),
    element("text", { x: 14, y: 279 }, metres(length)),
    element("text", { x: 14, y: 22 }, away ?? ""),
    element("rect", { class: "frame", x: 0.5, y: 0.5, width: 299, height: 299 }),
  );
}

// Everything that depends on the width of the page.
function lay() {
  const widths = strips.map(strip => strip.svg.clientWidth); // asked for before anything is changed
  const width = Math.max(280, at("pictures").clientWidth),
    [, left, bottom, right, top] = lesson.limits[0];
  const wide = width - MARGIN.left - MARGIN.right,
    most = Math.max(220, 0.42 * innerHeight);
  const height =
    Math.min(most, (wide * (top - bottom)) / (right - left)) + MARGIN.top + MARGIN.bottom;
  [room, limits] = [[width, height], null];
  strips.forEach((strip, i) => strip.draw(widths[i], shown));
  show();
}

function play(on) {
  clearTimeout(clock);
  clock = 0;
  at("play").textContent = on ? "❚❚ pause" : "▶ play";
  at("narrative").setAttribute("aria-live", on ? "off" : "polite"); // nobody reads so fast
  if (!on) return;
  if (current === views.length - 1) go(0);
  const tick = () => {
    if (current === views.length - 1) return play(false);
    go(current + 1);
    clock = setTimeout(tick, pause());
  };
  clock = setTimeout(tick, pause());
}

// Why the run was lost, where the page was asked to tell.
function why() {
  const reason = at("why");
  if (!reason) return;
  reason.open = !reason.open;
  if (reason.open) reason.scrollIntoView({ block: "nearest" });
}

// Who wants little motion gets as much time as it takes to read.
function pause() {
  const tempo = lesson.driven ? TEMPO.driven : views[current].beam ? TEMPO.beam : TEMPO.other;
  return still.matches ? Math.max(2500, tempo) : tempo;
}

const KEYS = {
  n: () => go(current + 1),
  ArrowRight: () => go(current + 1),
  p: () => go(current - 1),
  ArrowLeft: () => go(current - 1),
  Home: () => go(0),
  End: () => go(views.length - 1),
  " ": () => play(!clock),
  w: why,
};

addEventListener("keydown", event => {
  if (event.ctrlKey || event.metaKey || event.altKey || !KEYS[event.key]) return;
  const on = event.target.closest?.("button, summary, input, [role=button]");
  if (on && (event.key === " " || (on.matches("input") && event.key.length > 1))) return; // they have a meaning there
  if (event.key !== " ") play(false);
  event.preventDefault();
  KEYS[event.key]();
});
for (const [id, key] of [
  ["first", "Home"],
  ["back", "p"],
  ["next", "n"],
  ["last", "End"],
])
  at(id).addEventListener("click", () => {
    play(false);
    KEYS[key]();
  });
at("play").addEventListener("click", () => play(!clock));
at("slider").max = views.length - 1;
at("slider").addEventListener("input", () => {
  play(false);
  go(Number(at("slider").value));
});
addEventListener("hashchange", () => {
  current = linked();
  show();
});
addEventListener("resize", lay);

// A swipe over a picture is a step.
let start = null;
for (const svg of [at("map"), at("close")]) {
  svg.addEventListener("pointerdown", event => {
    start = event.pointerType === "mouse" ? null : [event.clientX, event.clientY];
  });
  svg.addEventListener("pointerup", event => {
    const [x, y] = start ? [event.clientX - start[0], event.clientY - start[1]] : [0, 0];
    if (Math.abs(x) > 40 && Math.abs(x) > 2 * Math.abs(y)) go(current + (x < 0 ? 1 : -1));
    start = null;
  });
}

if (at("why")) at("keys").append(" · w why");
legend(at("legend"));
toggles(at("filters"));
current = linked();
lay();
