// The matrices that a view's numbers come from, as tables with symbols.

const MEANT = {
  P: "P  covariance of the estimate",
  F: "F = ∂f/∂x",
  G: "G = ∂f/∂u",
  H: "H = ∂h/∂x",
  R: "R  covariance of the reading's noise",
  S: "S = H P⁻ Hᵀ + R, covariance of the innovation",
  ν: "ν = z − h(x⁻), the innovation",
  K: "K = P⁻ Hᵀ S⁻¹, the gain",
};
const TOGETHER = {
  P: ["P"],
  F: ["F", "G"],
  G: ["F", "G"],
  H: ["H", "S", "ν"],
  S: ["H", "S", "ν"],
  ν: ["H", "S", "ν"],
  R: ["R"],
  K: ["K"],
};

// Let a shape or a button tell its matrix: to the mouse, to the finger, to the keyboard.
function ask(part, symbol) {
  part.dataset.symbol = symbol;
  if (part instanceof SVGElement) {
    part.setAttribute("tabindex", "0");
    part.setAttribute("role", "button");
    part.setAttribute("aria-label", MEANT[symbol]);
  }
  for (const event of ["mouseenter", "focus", "click"])
    part.addEventListener(event, () => choose(symbol));
}

// inputs : how many a view of a driven robot gathers
function table(symbol, belief, inputs = 1) {
  const state = lesson.state,
    read = belief.z ?? [],
    given = belief.u ?? [];
  const [across, down] = {
    P: [state, state],
    F: [state, state],
    G: [given, state],
    H: [state, read],
    R: [read, read],
    S: [read, read],
    ν: [[""], read],
    K: [read, state],
  }[symbol];
  const value = belief[symbol];
  const cells =
    symbol === "P" ? symmetric(value) : symbol === "ν" ? value.map(one => [one]) : value;
  const made = document.createElement("table");
  const last =
    inputs > 1 && "FG".includes(symbol) ? `, of the last of ${inputs} motion inputs` : "";
  made.createCaption().textContent = MEANT[symbol] + last;
  const head = made.createTHead().insertRow();
  for (const name of ["", ...across]) head.appendChild(heading(name, "col"));
  const body = made.createTBody();
  cells.forEach((row, i) => {
    const line = body.insertRow();
    line.appendChild(heading(down[i], "row"));
    for (const number of row)
      line.insertCell().textContent = number === null ? "–" : String(number).replace("-", "−");
  });
  return made;
}

function heading(name, scope) {
  const made = document.createElement(name ? "th" : "td");
  if (name) made.scope = scope;
  made.textContent = name;
  return made;
}

// The tables of one symbol, or of the covariance where this view has no such matrix.
function tables(symbol, belief, inputs) {
  const of = belief[symbol] ? symbol : "P";
  return TOGETHER[of].filter(one => belief[one]).map(one => table(one, belief, inputs));
}

function symbols(belief) {
  return ["P", "F", "H", "K", "R"].filter(one => belief[one]);
}
