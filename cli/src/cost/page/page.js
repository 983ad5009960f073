(() => {
"use strict";

const root = document.documentElement;

// Tests of the page read these.
window.addEventListener("error", event => { root.dataset.error = event.message; });
window.addEventListener("unhandledrejection", event => { root.dataset.error = String(event.reason); });

const data = JSON.parse(document.getElementById("data").textContent);
const $ = id => document.getElementById(id);
const state = { metric: data.metrics[0], point: null };

// ---------------------------------------------------------------------------------------------------------- elements

// Children that are strings become text nodes, so that nothing in the data is ever read as markup.
const maker = space => (name, attributes = {}, ...children) => {
  const node = document.createElementNS(space, name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value !== null && value !== undefined && value !== false) node.setAttribute(key, value === true ? "" : value);
  }
  node.append(...children.flat(Infinity).filter(child => child !== null));
  return node;
};
const el = maker("http://www.w3.org/1999/xhtml");
const svg = maker("http://www.w3.org/2000/svg");

function button(label, action, attributes = {}) {
  const node = el("button", { type: "button", ...attributes }, label);
  node.addEventListener("click", action);
  return node;
}

// Only inlined pictures: an address would be asked of the network.
function picture(source, attributes) {
  return el("img", { ...attributes, src: source.startsWith("data:image/") ? source : null });
}

const list = pairs => el("dl", { class: "facts-list" }, pairs.map(([term, value]) => [el("dt", {}, term), el("dd", {}, value)]));

function table(headings, rows) {
  const head = headings.map(heading => el("th", { scope: "col", class: heading.number ? "number" : null }, heading.label));
  return el("table", {}, el("thead", {}, el("tr", {}, head)), el("tbody", {}, rows));
}

// ----------------------------------------------------------------------------------------------------------- numbers

const SPACE = "\u00a0"; // keeps a number and its unit on one line
const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";
const isNumber = value => typeof value === "number" && Number.isFinite(value);
const superscript = value => (value < 0 ? "⁻" : "") + [...String(Math.abs(value))].map(digit => SUPERSCRIPTS[digit]).join("");
const grouped = value => String(value).replace(/\B(?=(\d{3})+$)/g, "\u202f");
const plural = (count, word) => `${grouped(count)} ${word}${count === 1 ? "" : "s"}`;
const clamp = (value, least, most) => Math.max(least, Math.min(most, value));

function decimal(value, digits = 3) {
  if (!isNumber(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e-3 && size < 1e5) return String(Number(value.toPrecision(digits))).replace("-", "−");
  const [mantissa, exponent] = size.toExponential(digits - 1).split("e");
  const power = "10" + superscript(Number(exponent));
  return (value < 0 ? "−" : "") + (Number(mantissa) === 1 ? power : `${Number(mantissa)}${SPACE}×${SPACE}${power}`);
}

// Close to one, three digits would hide all there is to see.
const nearOne = value => (isNumber(value) ? value.toFixed(4) : "–");

function time(seconds) {
  if (!isNumber(seconds)) return "–";
  if (seconds >= 120) return `${decimal(seconds / 60)}${SPACE}min`;
  if (seconds >= 1 || seconds === 0) return `${decimal(seconds)}${SPACE}s`;
  return seconds >= 1e-3 ? `${decimal(seconds * 1e3)}${SPACE}ms` : `${decimal(seconds * 1e6)}${SPACE}µs`;
}

function memory(bytes) {
  if (!isNumber(bytes)) return "–";
  const power = clamp(Math.floor(Math.log2(Math.max(bytes, 1)) / 10), 0, 4);
  return `${decimal(bytes / 1024 ** power)}${SPACE}${["B", "KiB", "MiB", "GiB", "TiB"][power]}`;
}

const spread = seconds =>
  `${time(seconds.median)} (${time(seconds.least)} to ${time(seconds.most)}, ${plural(seconds.runs, "run")})`;

// The values 1, 2 and 5 times a power of ten from the first at or above `least` to the first at or above `most`.
function roundSteps(least, most) {
  const steps = [];
  for (let power = Math.floor(Math.log10(least)); steps.length < 60; power += 1) {
    for (const digit of [1, 2, 5]) {
      const value = Number(`${digit}e${power}`);
      if (value >= least) steps.push(value);
      if (value >= most) return steps;
    }
  }
  return steps;
}

// ----------------------------------------------------------------------------------------------- methods and metrics

const methodIndex = key => data.methods.findIndex(method => method.key === key);
const methodTitle = key => data.methods[methodIndex(key)]?.title ?? key;
const methodColour = key => `--method: var(--method-${Math.max(methodIndex(key), 0) % 6})`;

// One outline per method around the origin: colour alone does not tell methods apart for everybody.
const SHAPES = [
  size => `M${-size} 0a${size} ${size} 0 1 0 ${2 * size} 0a${size} ${size} 0 1 0 ${-2 * size} 0z`,
  size => `M${-0.9 * size} ${-0.9 * size}h${1.8 * size}v${1.8 * size}h${-1.8 * size}z`,
  size => `M0 ${-1.2 * size}L${1.15 * size} ${0.85 * size}H${-1.15 * size}z`,
  size => `M0 ${-1.3 * size}L${1.3 * size} 0L0 ${1.3 * size}L${-1.3 * size} 0z`,
  size => `M0 ${1.2 * size}L${1.15 * size} ${-0.85 * size}H${-1.15 * size}z`,
  size => `M${-0.4 * size} ${-1.2 * size}h${0.8 * size}v${0.8 * size}h${0.8 * size}v${0.8 * size}h${-0.8 * size}v${0.8 * size}`
    + `h${-0.8 * size}v${-0.8 * size}h${-0.8 * size}v${-0.8 * size}h${0.8 * size}z`,
];
const outline = (key, size) => SHAPES[Math.max(methodIndex(key), 0) % SHAPES.length](size);

function marker(method, filled = true) {
  const path = svg("path", { class: filled ? "mark filled" : "mark", d: outline(method, 5) });
  return svg("svg", { class: "marker", viewBox: "-7 -7 14 14", style: methodColour(method), "aria-hidden": "true" }, path);
}

// What is plotted is a distance from a perfect picture, for every metric.
function distance(value, metric) {
  if (!isNumber(value)) return null;
  if (metric.better === "higher") return Math.max(0, 1 - value);
  return metric.better === "one" ? Math.abs(value - 1) : Math.max(0, value);
}

function distanceName(metric) {
  if (metric.better === "higher") return `1 − ${metric.name}`;
  return metric.better === "one" ? `|${metric.name} − 1|` : metric.name;
}

const errorOf = point => distance(point.errors[state.metric.key], state.metric);
const secondsOf = point => point.seconds.median;
const floorOf = metric => distance(data.reference.noise[metric.key], metric);
const value = (point, metric) => (metric.better === "lower" ? decimal : nearOne)(point.errors[metric.key]);
const hasPlace = point => errorOf(point) !== null && isNumber(secondsOf(point)) && secondsOf(point) > 0;
const onFront = point => point.front.includes(state.metric.key);
const byTime = (a, b) => secondsOf(a) - secondsOf(b);
const placedPoints = () => data.points.filter(hasPlace).sort(byTime);
const frontPoints = () => placedPoints().filter(onFront);
const pointById = id => data.points.find(point => point.id === id) ?? null;

// The settings that differ among a method's points: the rest would only hide them.
function tellingSettings(point) {
  const siblings = data.points.filter(other => other.method === point.method);
  const differs = ([flag, setting]) =>
    siblings.some(other => other.settings.some(([name, chosen]) => name === flag && chosen !== setting));
  const telling = point.settings.filter(differs);
  return telling.length > 0 ? telling : point.settings;
}

// A line may break between the parts, not at a hyphen within one, unless it is too long for a line.
const LONG_PART = 32;
const parts = texts => texts.flatMap(text => [el("span", { class: text.length > LONG_PART ? null : "whole" }, text), " "]);
const settingsCode = settings => el("code", {}, parts(settings.map(setting => setting.join(" "))));
const commandText = command => el("span", { class: "command" }, parts(command.split(" ")));

const named = point => `${methodTitle(point.method)}, ${tellingSettings(point).flat().join(" ")}`;
const pointLink = point =>
  button([methodTitle(point.method), " ", settingsCode(tellingSettings(point))], () => select(point, true), { class: "link" });
const markedLink = point => el("div", { class: "marked" }, marker(point.method), pointLink(point));

function pointFactList(point) {
  const errors = data.metrics.map(metric =>
    [metric.name, value(point, metric) + (point.front.includes(metric.key) ? " · on the front" : "")]);
  return [["time", spread(point.seconds)], ["memory", memory(point.bytes)], ...errors];
}

function belowFloor(point) {
  const floor = floorOf(state.metric);
  return floor !== null && errorOf(point) !== null && errorOf(point) < floor;
}

const FLOOR_WORDS = "Below the noise of the reference: not told apart from a perfect picture.";

// ------------------------------------------------------------------------------------------------------------ header

function drawHeader() {
  $("scene").textContent = data.scene.source;
  const bounces = data.bounces === null ? "bounces unlimited" : `at most ${plural(data.bounces, "bounce")}`;
  const { kind, device, driver, mode } = data.backend;
  $("facts").textContent = [plural(data.scene.triangles, "triangle"), `${data.size[0]} × ${data.size[1]} pixels`, bounces,
    `seed ${data.seed}`, `${kind.toUpperCase()}, ${mode}: ${device} (${driver})`].join(" · ");
  $("against").textContent = `${plural(data.points.length, "setting")} of ${plural(data.methods.length, "method")}, each `
    + `measured against a path-traced reference of ${grouped(data.reference.spp)} samples per pixel, `
    + `which took ${time(data.reference.seconds)}.`;
  $("reference").append(
    picture(data.reference.image, { alt: `The reference: ${data.scene.source}` }), el("figcaption", {}, "the reference"));
  $("reference").hidden = false;
  $("notice").textContent = "Stopped early: what is shown was measured, but some settings are missing.";
  $("notice").hidden = data.finished;
}

function drawMetrics() {
  for (const metric of data.metrics) {
    const input = el("input", { type: "radio", name: "metric", value: metric.key, checked: metric === state.metric });
    input.addEventListener("change", () => chooseMetric(metric));
    $("metrics").append(el("label", {}, input, metric.name));
  }
}

// ------------------------------------------------------------------------------------------------------- conclusions

// The front from fast to slow as runs of one method each.
function frontRuns(front) {
  const runs = [];
  for (const point of front) {
    const last = runs.at(-1);
    if (last?.method === point.method) last.until = point;
    else runs.push({ method: point.method, from: point, until: point });
  }
  return runs;
}

const MOST_RUNS_TOLD = 4;

function leadSentence(front) {
  const runs = frontRuns(front);
  const name = distanceName(state.metric);
  if (data.points.every(point => point.method === front[0].method)) return "";
  if (runs.length === 1) {
    return `In ${name}, no other method beats the ${methodTitle(runs[0].method)} at any time measured. `;
  }
  if (runs.length <= MOST_RUNS_TOLD) {
    const parts = runs.map((run, index) =>
      `the ${methodTitle(run.method)} ${index + 1 < runs.length ? `up to ${time(secondsOf(run.until))}` : `from ${time(secondsOf(run.from))} on`}`);
    return `In ${name}, the least error in a given time is that of ${parts.slice(0, -1).join(", ")} and ${parts.at(-1)}. `;
  }
  const counts = data.methods.map(method => [front.filter(point => point.method === method.key).length, method.title]);
  const shares = counts.filter(([count]) => count > 0).sort((a, b) => b[0] - a[0]).map(([count, title]) => `${count} of the ${title}`);
  return `In ${name}, the methods take turns: of ${front.length} settings on the Pareto front, `
    + `${shares.slice(0, -1).join(", ")} and ${shares.at(-1)}. `;
}

function bestSentence(front) {
  const best = front.at(-1);
  return `The least error measured is ${decimal(errorOf(best))}, in ${time(secondsOf(best))}.`
    + (belowFloor(best) ? ` It is below the noise of the reference (${decimal(floorOf(state.metric))}).` : "");
}

const within = limit => frontPoints().filter(point => secondsOf(point) <= limit).at(-1);
const below = limit => frontPoints().find(point => errorOf(point) <= limit);

// A question with a choice of round limits, and the point of the front that answers it.
function answerCard({ before, limits, chosen, write, find, result, unit }) {
  const choice = el("select", { "aria-label": `${before} (limit)` },
    limits.map(limit => el("option", { value: limit, selected: limit === chosen }, write(limit))));
  const answer = el("div", { "aria-live": "polite" });
  const show = () => {
    const point = find(Number(choice.value));
    answer.replaceChildren(
      el("p", { class: "value" }, result(point), " ", el("small", {}, unit(point))),
      markedLink(point));
  };
  choice.addEventListener("change", show);
  show();
  return el("div", { class: "answer" }, el("p", {}, before, " ", choice), answer);
}

function timeCard(front) {
  const limits = roundSteps(secondsOf(front[0]), secondsOf(front.at(-1)));
  return answerCard({
    before: "Least error within", limits, chosen: limits.includes(1) ? 1 : limits[limits.length >> 1],
    write: time, find: within,
    result: point => decimal(errorOf(point)), unit: point => `${distanceName(state.metric)} in ${time(secondsOf(point))}`,
  });
}

function errorCard(front) {
  const errors = front.map(errorOf).filter(error => error > 0);
  if (errors.length === 0) return null;
  const limits = roundSteps(Math.min(...errors), Math.max(...errors));
  return answerCard({
    before: `Fastest with ${distanceName(state.metric)} up to`, limits, chosen: limits[(limits.length - 1) >> 1],
    write: decimal, find: below,
    result: point => time(secondsOf(point)), unit: point => `with ${decimal(errorOf(point))}`,
  });
}

function drawAnswers() {
  const front = frontPoints();
  $("answers").replaceChildren();
  if (front.length === 0) {
    $("verdict").textContent = data.points.length === 0 ? "Nothing was measured." : `No setting has a value of ${state.metric.name}.`;
    return;
  }
  $("verdict").textContent = leadSentence(front) + bestSentence(front);
  $("answers").append(...[timeCard(front), errorCard(front)].filter(card => card !== null));
}

// ------------------------------------------------------------------------------------------------------------- scales

const PAD = 1.3;

// Maps values between `least` and `most` to pixels, logarithmically; never less than one decade.
function logScale(least, most, start, end) {
  let low = Math.log10(least / PAD);
  let high = Math.log10(most * PAD);
  const missing = Math.max(0, 1 - (high - low)) / 2;
  low -= missing;
  high += missing;
  const place = input => start + ((Math.log10(input) - low) / (high - low)) * (end - start);
  return Object.assign(place, { low, high, decades: high - low });
}

// Ticks at every digit of every decade; the labelled ones are few enough for the room there is.
function logTicks(scale, pixelsPerLabel, pixels) {
  const perDecade = pixels / scale.decades;
  const digits = perDecade > 5 * pixelsPerLabel ? [1, 2, 5] : [1];
  const stride = Math.max(1, Math.ceil(pixelsPerLabel / perDecade));
  const ticks = [];
  for (let power = Math.floor(scale.low); power <= scale.high; power += 1) {
    for (let digit = 1; digit < 10; digit += 1) {
      const at = Number(`${digit}e${power}`);
      if (Math.log10(at) < scale.low || Math.log10(at) > scale.high) continue;
      ticks.push({ at, major: digit === 1, label: digits.includes(digit) && power % stride === 0 });
    }
  }
  return ticks;
}

// --------------------------------------------------------------------------------------------------------------- plot

const ZERO_BAND = 34;
const FLOOR_REACH = 30; // A floor further below the points than this would flatten them: it is told in words.
let plot = null;

// The widest label of the error axis, by its letters: superscripts are narrow, so this is rather too much.
function labelRoom(scale, box) {
  const labels = errorTicks(scale, box).filter(tick => tick.label).map(tick => decimal(tick.at).length);
  return 20 + 7 * Math.max(3, ...labels);
}

const errorTicks = (scale, box) => logTicks(scale, 22, box.bottom - box.top);

function plotLayout(points) {
  const width = Math.max(300, $("plot").clientWidth || 960);
  const height = clamp(width * 0.55, 360, 540);
  const box = { right: width - 14, top: 30, bottom: height - 44 };
  const positive = points.map(errorOf).filter(error => error > 0);
  const zeros = positive.length < points.length;
  const least = Math.min(...positive);
  const floor = floorOf(state.metric);
  const floorShown = floor > 0 && (positive.length === 0 || floor * FLOOR_REACH > least);
  const errors = [...positive, ...(floorShown ? [floor] : [])];
  const times = points.flatMap(point => [point.seconds.least, secondsOf(point), point.seconds.most]).filter(seconds => seconds > 0);
  const [low, high] = errors.length === 0 ? [0.1, 1] : [Math.min(...errors), Math.max(...errors)];
  const y = logScale(low, high, box.bottom - (zeros ? ZERO_BAND : 0), box.top);
  box.left = labelRoom(y, box);
  const x = logScale(Math.min(...times), Math.max(...times), box.left, box.right);
  return { width, height, box, x, y, zeros, floor: floorShown ? floor : null };
}

function place(point) {
  const error = errorOf(point);
  return [plot.x(secondsOf(point)), error > 0 ? plot.y(error) : plot.box.bottom - 12];
}

function drawGrid() {
  const { box, x, y, zeros, height } = plot;
  const group = svg("g", { "aria-hidden": "true" });
  const line = (tick, ends) => group.append(svg("line", { class: tick.major ? "grid major" : "grid", ...ends }));
  const text = (label, attributes) => group.append(svg("text", attributes, label));
  for (const tick of logTicks(x, 64, box.right - box.left)) {
    const at = x(tick.at);
    line(tick, { x1: at, x2: at, y1: box.top, y2: box.bottom });
    // A label at the very edge would be cut off.
    if (tick.label && at < box.right - 12) text(time(tick.at), { x: at, y: box.bottom + 18, "text-anchor": "middle" });
  }
  for (const tick of errorTicks(y, box)) {
    const at = y(tick.at);
    line(tick, { x1: box.left, x2: box.right, y1: at, y2: at });
    if (tick.label) text(decimal(tick.at), { x: box.left - 7, y: at + 4, "text-anchor": "end" });
  }
  if (zeros) {
    line({ major: true }, { x1: box.left, x2: box.right, y1: box.bottom - ZERO_BAND + 4, y2: box.bottom - ZERO_BAND + 4 });
    text("0", { x: box.left - 7, y: box.bottom - 8, "text-anchor": "end" });
  }
  group.append(
    svg("text", { class: "axis-title", x: 0, y: 14 }, `${distanceName(state.metric)}, less is better`),
    svg("text", { class: "axis-title", x: box.right, y: height - 4, "text-anchor": "end" }, "time of a render, median of its runs"));
  return group;
}

function drawFloor() {
  if (plot.floor === null) return [];
  const { box } = plot;
  const at = plot.y(plot.floor);
  return [
    svg("rect", { class: "floor-area", x: box.left, y: at, width: box.right - box.left, height: Math.max(0, box.bottom - at) }),
    svg("line", { class: "floor", x1: box.left, x2: box.right, y1: at, y2: at }),
  ];
}

function drawFloorLabel() {
  if (plot.floor === null) return [];
  const at = { x: plot.box.left + 8, y: plot.y(plot.floor) - 6 };
  return [svg("text", { class: "halo", ...at }, `noise of the reference, ${decimal(plot.floor)}`)];
}

// The least error there is at each time: it holds until the next point of the front lowers it.
function stepLine(front, attributes) {
  const steps = front.map((point, index) => {
    const [x, y] = place(point);
    return index === 0 ? `M${x} ${y}` : `H${x}V${y}`;
  });
  return svg("path", { ...attributes, d: `${steps.join("")}H${plot.box.right}` });
}

function drawFronts(points) {
  const lines = [];
  for (const method of data.methods) {
    const front = points.filter(point => point.method === method.key && point.method_front.includes(state.metric.key));
    if (front.length > 0) lines.push(stepLine(front, { class: "front method", style: methodColour(method.key) }));
  }
  const front = points.filter(onFront);
  if (front.length > 0) lines.push(stepLine(front, { class: "front overall" }));
  return lines;
}

function drawPoint(point) {
  const [x, y] = place(point);
  const label = `${named(point)}: ${time(secondsOf(point))}, ${distanceName(state.metric)} ${decimal(errorOf(point))}`
    + (onFront(point) ? ", on the Pareto front" : "");
  const least = plot.x(Math.max(point.seconds.least, secondsOf(point) / 100)) - x;
  const node = svg("g", {
    class: onFront(point) ? "point on-front" : "point", transform: `translate(${x} ${y})`, style: methodColour(point.method),
    role: "button", tabindex: -1, "aria-label": label, "aria-pressed": String(point === state.point),
  },
  svg("line", { class: "spread", x1: least, x2: plot.x(point.seconds.most) - x }),
  svg("path", { class: "mark", d: outline(point.method, onFront(point) ? 6 : 4.5) }),
  svg("circle", { class: "ring", r: 11 }));
  if (errorOf(point) === 0) node.append(svg("path", { class: "zero-arrow", d: "M0 -20V-10M-3 -13L0 -10L3 -13" }));
  node.addEventListener("focus", () => showPointTooltip(point));
  node.addEventListener("blur", hideTooltip);
  return node;
}

function drawPlot() {
  const points = placedPoints();
  root.dataset.points = points.length;
  hideTooltip();
  if (points.length === 0) {
    plot = null;
    $("plot").replaceChildren();
    return;
  }
  plot = plotLayout(points);
  // Points of the front are drawn last, over the others; in the plot's own order, arrow keys go from fast to slow.
  plot.nodes = new Map(points.map(point => [point, drawPoint(point)]));
  const nodes = [...points].sort((a, b) => onFront(a) - onFront(b)).map(point => plot.nodes.get(point));
  const drawing = svg("svg", {
    viewBox: `0 0 ${plot.width} ${plot.height}`, role: "group",
    "aria-label": `${distanceName(state.metric)} against time for ${plural(points.length, "setting")}, both logarithmic. `
      + "Arrow keys go from point to point, Enter selects. The table of all settings has the same values.",
  }, drawGrid(), drawFloor(), drawFronts(points), drawFloorLabel(), nodes);
  drawing.addEventListener("pointermove", hoverNearest);
  drawing.addEventListener("pointerleave", () => markNear(null));
  drawing.addEventListener("click", event => { const point = nearest(event); if (point) select(point); });
  drawing.addEventListener("keydown", moveByKey);
  $("plot").replaceChildren(drawing);
  markSelected();
}

function drawPlotNotes() {
  const notes = [];
  const placed = placedPoints();
  const missing = data.points.filter(point => !hasPlace(point));
  const zeros = placed.filter(point => errorOf(point) === 0);
  if (placed.length > 0) notes.push("A point's horizontal bar reaches from its fastest to its slowest run.");
  if (zeros.length > 0) notes.push(`${plural(zeros.length, "point")} with an error of exactly 0, which no logarithmic axis has, at the lower edge (arrow).`);
  if (plot && plot.floor === null && floorOf(state.metric) !== null) {
    notes.push(`The noise of the reference, ${decimal(floorOf(state.metric))}, is too far down to be drawn.`);
  }
  const lines = notes.map(note => el("p", {}, note));
  if (missing.length > 0) {
    const links = missing.slice(0, 8).flatMap((point, index) => [index > 0 ? ", " : "", pointLink(point)]);
    const more = missing.length > 8 ? ` and ${missing.length - 8} more.` : ".";
    lines.push(el("p", {}, `${plural(missing.length, "point")} without a value of ${state.metric.name}, so not drawn: `, links, more));
  }
  $("plot-notes").replaceChildren(...lines);
}

// A point of no method, on the line of the front or off it.
function legendPoint(front) {
  const line = front ? [svg("path", { class: "front overall", d: "M-14 0H14" })] : [];
  return svg("svg", { class: "marker wide", viewBox: "-14 -7 28 14", style: "--method: var(--muted)", "aria-hidden": "true" },
    line, svg("path", { class: front ? "mark filled" : "mark", d: SHAPES[0](5) }));
}

function drawLegend() {
  const used = data.methods.filter(method => data.points.some(point => point.method === method.key));
  const methods = used.map(method => el("li", {}, marker(method.key), method.title));
  const extra = used.length === 0 ? [] : [el("li", {}, legendPoint(true), "on the Pareto front"), el("li", {}, legendPoint(false), "not on it")];
  $("legend").replaceChildren(...methods, ...extra);
}

// ------------------------------------------------------------------------------------------------- pointer and keys

const REACH = 32;

function nearest(event) {
  const frame = $("plot").getBoundingClientRect();
  const scale = plot.width / frame.width;
  const at = [(event.clientX - frame.left) * scale, (event.clientY - frame.top) * scale];
  const far = point => Math.hypot(place(point)[0] - at[0], place(point)[1] - at[1]);
  const best = [...plot.nodes.keys()].reduce((a, b) => (far(b) < far(a) ? b : a));
  return far(best) <= REACH ? best : null;
}

function hoverNearest(event) {
  const point = nearest(event);
  event.currentTarget.style.cursor = point ? "pointer" : "";
  markNear(point);
}

function markNear(point) {
  for (const [other, node] of plot.nodes) node.classList.toggle("near", other === point);
  if (point) showPointTooltip(point);
  else hideTooltip();
}

// The plot is one stop of the tab key: the selected point, or the first.
function markSelected() {
  if (!plot) return;
  const stop = plot.nodes.has(state.point) ? state.point : plot.nodes.keys().next().value;
  for (const [point, node] of plot.nodes) {
    node.setAttribute("aria-pressed", String(point === state.point));
    node.setAttribute("tabindex", point === stop ? 0 : -1);
  }
}

function moveByKey(event) {
  const points = [...plot.nodes.keys()];
  const index = points.findIndex(point => plot.nodes.get(point) === document.activeElement);
  const last = points.length - 1;
  const target = { ArrowRight: index + 1, ArrowUp: index + 1, ArrowLeft: index - 1, ArrowDown: index - 1, Home: 0, End: last }[event.key];
  if (target !== undefined) {
    event.preventDefault();
    plot.nodes.get(points[clamp(target, 0, last)]).focus();
  } else if ((event.key === "Enter" || event.key === " ") && index >= 0) {
    event.preventDefault();
    select(points[index]);
  }
}

// ------------------------------------------------------------------------------------------------------------ tooltip

// Beside the anchor where there is room, else under or over it; never outside the window.
function showTooltip(content, anchor) {
  const tip = $("tooltip");
  tip.replaceChildren(...content);
  tip.hidden = false;
  const gap = 14;
  const { offsetWidth: width, offsetHeight: height } = tip;
  const [right, bottom] = [root.clientWidth - 8, window.innerHeight - 8];
  const fitsRight = anchor.right + gap + width <= right;
  const fitsLeft = anchor.left - gap - width >= 8;
  let left = fitsRight ? anchor.right + gap : anchor.left - gap - width;
  let top = anchor.top + anchor.height / 2 - height / 2;
  if (!fitsRight && !fitsLeft) {
    left = anchor.left;
    top = anchor.bottom + gap + height <= bottom ? anchor.bottom + gap : anchor.top - gap - height;
  }
  tip.style.transform = `translate(${clamp(left, 8, Math.max(8, right - width))}px, ${clamp(top, 8, Math.max(8, bottom - height))}px)`;
}

function hideTooltip() {
  $("tooltip").hidden = true;
}

function showPointTooltip(point) {
  const content = [
    el("div", {}, marker(point.method), " ", el("strong", {}, methodTitle(point.method))),
    el("div", {}, settingsCode(point.settings)),
    list(pointFactList(point)),
    belowFloor(point) ? el("div", {}, FLOOR_WORDS) : null,
    commandText(point.command),
  ];
  showTooltip(content.filter(part => part !== null), plot.nodes.get(point).querySelector(".ring").getBoundingClientRect());
}

// ----------------------------------------------------------------------------------------------------- selected point

function nearestWithImage(point) {
  const withImage = data.points.filter(other => other.image !== null && secondsOf(other) > 0);
  const decades = (a, b) => (a > 0 && b > 0 ? Math.log10(a / b) : 0);
  const far = other => Math.hypot(decades(secondsOf(other), secondsOf(point)), decades(errorOf(other), errorOf(point)));
  return withImage.length === 0 ? null : withImage.reduce((a, b) => (far(b) < far(a) ? b : a));
}

function slider(label, attributes, write, change) {
  const input = el("input", { type: "range", ...attributes });
  const output = el("output", {}, write(Number(attributes.value)));
  input.addEventListener("input", () => { output.textContent = write(Number(input.value)); change(Number(input.value)); });
  return { input, node: el("label", { class: "slider" }, label, input, output) };
}

function wipeFigure(point) {
  const frame = el("div", { class: "picture wipe" },
    picture(data.reference.image, { alt: "the reference", draggable: "false" }),
    picture(point.image, { alt: named(point), class: "over", draggable: "false" }),
    el("span", { class: "tag left", "aria-hidden": "true" }, "this setting"),
    el("span", { class: "tag right", "aria-hidden": "true" }, "reference"));
  const cut = percent => frame.style.setProperty("--cut", `${percent}%`);
  const control = slider("wipe", { min: 0, max: 100, value: 50 }, percent => `${percent} %`, cut);
  const drag = event => {
    const box = frame.getBoundingClientRect();
    control.input.value = Math.round(clamp((event.clientX - box.left) / box.width, 0, 1) * 100);
    control.input.dispatchEvent(new Event("input"));
  };
  frame.addEventListener("pointerdown", event => { frame.setPointerCapture(event.pointerId); drag(event); });
  frame.addEventListener("pointermove", event => { if (frame.hasPointerCapture(event.pointerId)) drag(event); });
  cut(50);
  return el("figure", {}, frame, control.node,
    el("figcaption", {}, "Left of the line this setting, right of it the reference. Drag to move it."));
}

async function pixels(source) {
  const image = picture(source, {});
  await image.decode();
  const canvas = el("canvas", { width: image.naturalWidth, height: image.naturalHeight });
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, canvas.width, canvas.height);
}

function paintDifference(canvas, a, b, gain) {
  const out = new ImageData(a.width, a.height);
  for (let i = 0; i < out.data.length; i += 1) {
    out.data[i] = i % 4 === 3 ? 255 : gain * Math.abs(a.data[i] - b.data[i]);
  }
  canvas.getContext("2d").putImageData(out, 0, 0);
}

function differenceFigure(point) {
  const canvas = el("canvas", { width: data.size[0], height: data.size[1], role: "img", "aria-label": "difference from the reference" });
  const both = Promise.all([pixels(point.image), pixels(data.reference.image)]);
  const paint = async power => {
    const [a, b] = await both;
    if (a.width !== b.width || a.height !== b.height) return;
    Object.assign(canvas, { width: a.width, height: a.height });
    paintDifference(canvas, a, b, 2 ** power);
  };
  const control = slider("gain", { min: 0, max: 6, value: 2 }, power => `× ${2 ** power}`, paint);
  paint(2);
  return el("figure", {}, el("div", { class: "picture" }, canvas), control.node,
    el("figcaption", {}, `Absolute difference of display values (${data.display}), not of radiance.`));
}

// Pixels are drawn as they are where the picture is shown larger than it is.
function markEnlarged() {
  for (const node of document.querySelectorAll(".picture img, .picture canvas")) {
    node.classList.toggle("enlarged", node.clientWidth > data.size[0]);
  }
}

function noPicture(point) {
  const other = nearestWithImage(point);
  return el("div", { class: "no-picture" },
    el("p", {}, "No picture: only points on a front keep theirs."),
    other ? el("p", {}, "The nearest with one: ", pointLink(other), `, ${time(secondsOf(other))}.`) : null);
}

function copyRow(command) {
  const copy = button("Copy", async () => {
    try {
      await navigator.clipboard.writeText(command);
      copy.textContent = "Copied";
    } catch {
      // Without leave to write the clipboard: select the text, so that a key copies it.
      window.getSelection().selectAllChildren(text);
      copy.textContent = "Selected";
    }
  });
  const text = commandText(command);
  return el("div", { class: "copy-row" }, text, copy);
}

function pointFacts(point) {
  return el("div", {},
    list([...point.settings.map(([flag, setting]) => [el("code", {}, flag), setting]), ...pointFactList(point)]),
    belowFloor(point) ? el("p", { class: "note" }, FLOOR_WORDS) : null);
}

function drawDetail() {
  const point = state.point;
  $("detail-section").hidden = point === null;
  if (point === null) return;
  const pictures = point.image === null ? [noPicture(point)] : [wipeFigure(point), differenceFigure(point)];
  $("detail").replaceChildren(
    el("p", { class: "chosen" }, marker(point.method, onFront(point)), " ", el("strong", {}, methodTitle(point.method)), " ",
      settingsCode(tellingSettings(point))),
    el("div", { class: "detail-grid" }, pictures, pointFacts(point)),
    copyRow(point.command));
  markEnlarged();
}

// -------------------------------------------------------------------------------------------------------------- steps

const STEP_COLOURS = 12;
const HOST = "host";

// Every step's share of its render, summed over all renders: the largest get colours of their own, on every bar the same.
const stepOrder = (() => {
  const shares = new Map();
  for (const point of data.points) {
    for (const step of point.steps) shares.set(step.name, (shares.get(step.name) ?? 0) + step.seconds / secondsOf(point));
  }
  return [...shares.keys()].sort((a, b) => shares.get(b) - shares.get(a));
})();

function stepColour(name) {
  const index = stepOrder.indexOf(name);
  return `--step: var(--step-${index < STEP_COLOURS ? index : "other"})`;
}

function stepParts(point) {
  const told = point.steps.reduce((sum, step) => sum + step.seconds, 0);
  const total = Math.max(told, secondsOf(point));
  const parts = point.steps.map(step => ({ name: step.name, seconds: step.seconds, words: `${time(step.seconds)} in ${plural(step.calls, "call")}` }));
  parts.push({ name: HOST, seconds: total - told, host: true, words: time(total - told) });
  return parts.filter(part => part.seconds > 0).map(part => ({ ...part, share: part.seconds / total }));
}

function stepPart(part) {
  const words = `${part.words}, ${decimal(100 * part.share)} %`;
  const node = el("span", { class: part.host ? "part host" : "part", style: `flex: ${part.share} 1 0;${part.host ? "" : stepColour(part.name)}` },
    el("span", {}, part.name));
  node.addEventListener("pointerenter", () => showTooltip([el("strong", {}, part.name), el("div", {}, words)], node.getBoundingClientRect()));
  node.addEventListener("pointerleave", hideTooltip);
  return node;
}

function stepRow(point, first) {
  const parts = stepParts(point);
  const words = parts.map(part => `${part.name} ${part.words}`).join(", ");
  return el("div", { class: first ? "bar-row first" : "bar-row" },
    markedLink(point),
    el("span", { class: "stack", role: "img", "aria-label": words }, parts.map(stepPart)),
    el("span", { class: "total" }, time(secondsOf(point))));
}

function stepLegend(points) {
  const used = new Set(points.flatMap(point => point.steps.map(step => step.name)));
  const items = stepOrder.filter(name => used.has(name)).map(name =>
    el("li", {}, el("span", { class: "swatch", style: `background: var(--step);${stepColour(name)}` }), name));
  return el("ul", { class: "legend" }, items, el("li", {}, el("span", { class: "swatch host" }), HOST));
}

function drawSteps() {
  const rows = [...(state.point ? [state.point] : []), ...frontPoints().filter(point => point !== state.point)];
  $("steps-section").hidden = rows.length === 0;
  $("steps").replaceChildren(...rows.map(point => stepRow(point, point === state.point)), stepLegend(rows));
  hideCutLabels();
}

function hideCutLabels() {
  for (const label of document.querySelectorAll(".part > span")) {
    label.style.visibility = label.offsetWidth > label.parentNode.clientWidth ? "hidden" : "";
  }
}

// ------------------------------------------------------------------------------------------------------------- tables

// Below this share of the error, the smaller part is not what to work on.
const SMALL_SHARE = 0.1;

function splitWords(biasShare) {
  if (biasShare < SMALL_SHARE) return "Nearly all noise: more samples go on lowering the error.";
  if (biasShare > 1 - SMALL_SHARE) return "Nearly all bias: more samples do not help.";
  return biasShare > 0.5 ? "More bias than noise: more samples lower less than half of it." : "More noise than bias: more samples lower more than half of it.";
}

function splitRow(split) {
  const point = pointById(split.point);
  // An estimate of a part near nothing may come out below it.
  const [bias, noise] = [Math.max(0, split.bias), Math.max(0, split.noise)];
  const share = bias + noise > 0 ? bias / (bias + noise) : 0;
  const bar = el("span", { class: "share", style: methodColour(split.method), role: "img", "aria-label": `${Math.round(100 * share)} % bias` },
    el("span", { class: "bias", style: `flex: ${share}` }), el("span", { class: "noise", style: `flex: ${1 - share}` }));
  const metric = data.metrics.find(candidate => candidate.key === split.metric);
  return el("tr", {},
    el("td", {}, point ? markedLink(point) : [marker(split.method), " ", methodTitle(split.method)]),
    el("td", {}, metric?.name ?? split.metric),
    ...[split.total, split.bias, split.noise].map(part => el("td", { class: "number" }, decimal(part))),
    el("td", {}, bar), el("td", {}, splitWords(share), " ", el("small", {}, `(${split.how})`)));
}

function drawSplit() {
  $("split-section").hidden = data.split.length === 0;
  $("split").replaceChildren(table([{ label: "method" }, { label: "metric" }, { label: "error", number: true }, { label: "bias", number: true },
    { label: "noise", number: true }, { label: "bias, then noise (hatched)" }, { label: "in words" }], data.split.map(splitRow)));
}

function amount(text, input, most) {
  const width = isNumber(input) && most > 0 ? Math.max(1, (100 * input) / most) : 0;
  return el("td", {}, text, el("span", { class: "amount", style: `width: ${width}%` }));
}

function kernelCard(kernel) {
  const metric = data.metrics.find(candidate => candidate.key === kernel.metric) ?? { name: kernel.metric, better: "lower" };
  const most = read => Math.max(...kernel.variants.map(read).filter(isNumber), 0);
  const [slowest, worst] = [most(variant => variant.seconds.median), most(variant => distance(variant.error, metric))];
  const rows = kernel.variants.map(variant => el("tr", {},
    el("td", {}, variant.name),
    amount(`${time(variant.seconds.median)} (${time(variant.seconds.least)} to ${time(variant.seconds.most)})`, variant.seconds.median, slowest),
    amount(decimal(distance(variant.error, metric)), distance(variant.error, metric), worst),
    el("td", { class: "number" }, memory(variant.bytes))));
  const headings = [{ label: "option" }, { label: "time" }, { label: distanceName(metric) }, { label: "memory", number: true }];
  return el("article", {}, el("h3", {}, el("code", {}, kernel.kernel)), el("p", {}, kernel.what),
    el("div", { class: "scroll" }, table(headings, rows)));
}

function drawKernels() {
  $("kernels-section").hidden = data.kernels.length === 0;
  $("kernels").replaceChildren(...data.kernels.map(kernelCard));
}

function drawKnobs() {
  $("knobs-section").hidden = data.knobs.length === 0;
  const rows = data.knobs.map(knob => el("tr", {},
    el("td", { class: "whole" }, el("code", {}, knob.flag)),
    el("td", { class: "whole" }, ...(methodIndex(knob.method) < 0 ? ["every method"] : [marker(knob.method), " ", methodTitle(knob.method)])),
    el("td", {}, knob.unit ? `${knob.range} ${knob.unit}` : knob.range), el("td", {}, knob.default), el("td", {}, knob.trades)));
  $("knobs").replaceChildren(table([{ label: "option" }, { label: "method" }, { label: "range" }, { label: "default" }, { label: "trades" }], rows));
}

// ---------------------------------------------------------------------------------------------------------- all points

const columns = [
  { label: "method", key: point => methodTitle(point.method), cell: markedLink },
  { label: "time", key: secondsOf, cell: point => time(secondsOf(point)), number: true },
  { label: "spread", key: point => point.seconds.most / point.seconds.least, number: true,
    cell: point => `${time(point.seconds.least)} to ${time(point.seconds.most)}` },
  { label: "memory", key: point => point.bytes, cell: point => memory(point.bytes), number: true },
  ...data.metrics.map(metric => ({ label: metric.name, key: point => distance(point.errors[metric.key], metric), number: true, metric,
    cell: point => value(point, metric) })),
];
const sorting = { column: columns[1], descending: false };

// What has no value comes last in both directions.
function bySorting(a, b) {
  const [left, right] = [sorting.column.key(a), sorting.column.key(b)];
  if (left === null || right === null) return (left === null) - (right === null);
  return (left < right ? -1 : left > right ? 1 : 0) * (sorting.descending ? -1 : 1);
}

function sortBy(column) {
  sorting.descending = sorting.column === column && !sorting.descending;
  sorting.column = column;
  drawAll();
  $("all").querySelector("th[aria-sort] button").focus();
}

function allHeading(column) {
  const sorted = sorting.column === column;
  const arrow = sorted ? (sorting.descending ? " ↓" : " ↑") : "";
  return el("th", { scope: "col", class: column.number ? "number" : null, "aria-sort": sorted ? (sorting.descending ? "descending" : "ascending") : null },
    button(column.label + arrow, () => sortBy(column)));
}

function allRow(point) {
  return el("tr", { class: point === state.point ? "selected" : null }, columns.map(column => {
    const best = column.metric !== undefined && point.front.includes(column.metric.key);
    const classes = [column.number ? "number" : "", best ? "best" : ""].join(" ").trim();
    return el("td", { class: classes || null }, column.cell(point), best ? el("span", { class: "unseen" }, " on the front") : null);
  }));
}

function drawAll() {
  $("all-section").hidden = data.points.length === 0;
  $("all-summary").textContent = `The table of ${plural(data.points.length, "setting")}`;
  $("all").replaceChildren(el("table", {}, el("thead", {}, el("tr", {}, columns.map(allHeading))),
    el("tbody", {}, [...data.points].sort(bySorting).map(allRow))));
}

function drawFooter() {
  const better = { lower: "less is better", higher: "more is better, 1 is a perfect picture", one: "1 is best: it shows bias" };
  const metrics = data.metrics.map(metric => [metric.name, [el("code", {}, metric.formula), `; ${better[metric.better] ?? ""}`]]);
  $("method-notes").replaceChildren(...list([
    ["times", "The median of the runs; the spread is the fastest and the slowest of them. Steps are those of the median run."],
    ["Pareto front", "The settings that no other setting beats in both time and error."],
    ["errors", "Against the reference, in radiance x with the reference's r unless the formula says otherwise."],
    ...metrics,
    ["display", `${data.display}: how radiance became the pictures of this page.`],
    ["command", commandText(data.command)],
    ["version", `twinlight ${data.twinlight}`],
  ]).childNodes);
}

// ------------------------------------------------------------------------------------------------------------- state

function keepInAddress() {
  const parts = new URLSearchParams({ metric: state.metric.key });
  if (state.point) parts.set("point", state.point.id);
  // Replaced, not pushed: the back button leaves the page. A sandboxed frame may refuse, and nothing depends on it.
  try { history.replaceState(null, "", `#${parts}`); } catch { /* the address stays as it was */ }
}

function select(point, show = false) {
  state.point = point;
  keepInAddress();
  markSelected();
  drawDetail();
  drawSteps();
  drawAll();
  if (show) $("detail-section").scrollIntoView({ block: "start" });
}

function drawMetric() {
  drawAnswers();
  drawPlot();
  drawPlotNotes();
  drawDetail();
  drawSteps();
}

function chooseMetric(metric) {
  state.metric = metric;
  keepInAddress();
  drawMetric();
}

function readAddress() {
  const parts = new URLSearchParams(location.hash.slice(1));
  state.metric = data.metrics.find(metric => metric.key === parts.get("metric")) ?? state.metric;
  const front = frontPoints();
  state.point = (parts.has("point") ? pointById(Number(parts.get("point"))) : null) ?? state.point
    ?? front[front.length >> 1] ?? data.points[0] ?? null;
}

function followAddress() {
  readAddress();
  document.querySelector(`#metrics input[value="${CSS.escape(state.metric.key)}"]`).checked = true;
  drawMetric();
  drawAll();
}

// Between these the drawing scales with its frame; drawn anew, its letters keep their size.
function followWidth() {
  drawPlot();
  hideCutLabels();
  markEnlarged();
}

readAddress();
drawHeader();
drawMetrics();
drawLegend();
drawMetric();
drawSplit();
drawKernels();
drawKnobs();
drawAll();
drawFooter();
window.addEventListener("resize", followWidth);
window.addEventListener("hashchange", followAddress);
window.addEventListener("scroll", hideTooltip, { passive: true });
window.addEventListener("keydown", event => { if (event.key === "Escape") hideTooltip(); });
window.addEventListener("beforeprint", () => { for (const node of document.querySelectorAll("details")) node.open = true; });
root.dataset.ready = "true";
})();
