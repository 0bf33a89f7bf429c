"use strict";
// Shapes in metres, as lists of numbers x, y, x, y, …: the same as those of the program's pictures.

const NOSE = 1.7,
  CONE = 5,
  TRUE_HEADING = 2.6; // in body radii, from the position ahead

// A symmetric matrix from its lower half, row by row.
function symmetric(half) {
  const n = Math.round((Math.sqrt(8 * half.length + 1) - 1) / 2);
  const at = (i, j) => half[i < j ? (j * (j + 1)) / 2 + i : (i * (i + 1)) / 2 + j];
  return Array.from({ length: n }, (_, i) => Array.from({ length: n }, (_, j) => at(i, j)));
}

// The block of a covariance that is the pose's. places : where x, y, θ stand in the state
function poseBlock(P, places) {
  return places.map(i => places.map(j => P[i][j]));
}

// Radii and orientation of the confidence ellipse of a position: λ₁ = m + r, λ₂ = det P / λ₁.
function ellipse(P, k) {
  const a = P[0][0],
    b = P[0][1],
    c = P[1][1],
    m = (a + c) / 2,
    d = (a - c) / 2;
  const major = Math.max(m + Math.hypot(d, b), 0),
    det = a * c - b * b;
  // what is told has six digits: below that it is rounding, and the ellipse a line
  const minor = major === 0 || det <= 1e-6 * major * Math.min(a, c) ? 0 : det / major;
  return { major: k * Math.sqrt(major), minor: k * Math.sqrt(minor), turn: Math.atan2(b, d) / 2 };
}

// Points on it, never a mark with an angle: right under any aspect.
function outline(pose, P, k, n = 72) {
  const { major, minor, turn } = ellipse(P, k),
    c = Math.cos(turn),
    s = Math.sin(turn);
  return around(n, t => {
    const east = major * Math.cos(t),
      north = minor * Math.sin(t);
    return [pose[0] + c * east - s * north, pose[1] + s * east + c * north];
  });
}

// The position, were the heading known to lie `offset` rad from its mean: p + P_pθ/σ_θ² · offset.
function conditioned(pose, P, offset) {
  const by = P[2][2] > 0 ? [P[0][2] / P[2][2], P[1][2] / P[2][2]] : [0, 0];
  const less = [0, 1].map(i => [0, 1].map(j => P[i][j] - by[i] * P[2][j]));
  return [[pose[0] + by[0] * offset, pose[1] + by[1] * offset], less];
}

function around(n, place) {
  return Array.from({ length: n }, (_, i) => place((2 * Math.PI * i) / n)).flat();
}

// The headings within `half` rad of the estimate's, from its position.
function sector(pose, half, radius) {
  const open = Math.min(half, Math.PI),
    n = 3 + Math.floor((open * 180) / Math.PI);
  const arc = Array.from({ length: n }, (_, i) =>
    ahead(pose, radius, -open + (2 * open * i) / (n - 1)),
  );
  return [pose[0], pose[1], ...arc.flat()];
}

function ahead(pose, length, turn = 0) {
  return [pose[0] + length * Math.cos(pose[2] + turn), pose[1] + length * Math.sin(pose[2] + turn)];
}

// Whether a point lies in a ring.
function inside(ring, [x, y]) {
  let odd = false;
  for (let i = 0, j = ring.length - 2; i < ring.length; j = i, i += 2) {
    const [ax, ay, bx, by] = [ring[i], ring[i + 1], ring[j], ring[j + 1]];
    if (ay > y !== by > y && x < ax + ((bx - ax) * (y - ay)) / (by - ay)) odd = !odd;
  }
  return odd;
}

// A round body with a pointed nose.
function robot(pose, size) {
  const points = Array.from({ length: 27 }, (_, i) =>
    ahead(pose, size, ((50 + 10 * i) * Math.PI) / 180),
  );
  return [...points.flat(), ...ahead(pose, NOSE * size)];
}

// The smallest 1, 2 or 5 times a power of ten that is not less.
function oneTwoFive(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map(digit => digit * power).find(value => value >= least * (1 - 1e-9));
}

// A length with the unit that suits it.
function metres(m) {
  const [size, unit] = m >= 1 ? [1, "m"] : m >= 0.01 ? [0.01, "cm"] : [0.001, "mm"];
  return `${Number((m / size).toPrecision(3))} ${unit}`;
}

// The marks, in pixels about a point.
const MARKS = {
  o: "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z",
  dot: "M-2.5 0a2.5 2.5 0 1 0 5 0a2.5 2.5 0 1 0-5 0z",
  air: "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z",
  wall: "M-5-3L-3-5L0-2L3-5L5-3L2 0L5 3L3 5L0 2L-3 5L-5 3L-2 0z",
  ring: "M-7 0a7 7 0 1 0 14 0a7 7 0 1 0-14 0z",
  diamond: "M-5 0L0-5L5 0L0 5z",
  triangle: "M-4 3.5L0-4.5L4 3.5z",
  s: "M-4-4H4V4H-4z",
  v: "M-5-4H5L0 5z",
  P: "M-2-5H2V-2H5V2H2V5H-2V2H-5V-2H-2z",
  h: "M0-5L4.3-2.5V2.5L0 5L-4.3 2.5V-2.5z",
};
MARKS.fix = MARKS.wall;
MARKS.plus = "M-4 0H4M0-4V4";
