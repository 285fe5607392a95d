// ------------------------------------------------------------------------------------------------ the server

const pageName = crypto.getRandomValues(new Uint32Array(2)).join("-");
let requests = 0;
let state = null;  // what the server told last, see its `state`

/** What there is to tell, by its kind; the line below the picture holds all that isn't empty. */
const errorKinds = ["gone", "fault", "error", "shader"], messages = Object.fromEntries(errorKinds.map(kind => [kind, ""]));
function say(kind, text) {
  if ((messages[kind] || "") === text) return;
  messages[kind] = text;
  byId("messages").replaceChildren(...Object.entries(messages).filter(([, told]) => told).map(([of, told]) =>
    element("span", {className: errorKinds.includes(of) ? "error" : of, textContent: told, title: told})));
}

const textOf = bytes => new TextDecoder().decode(bytes);

/** A request's answer. Throws {error, status, shader}, {gone: true} or, where it was given up, {superseded: true}. */
async function ask(path, body, signal) {
  const telling = setTimeout(say, 1500, path, `Waiting for the server's ${path} …`);
  let response, bytes, told = {};
  try {
    response = await fetch(path, body && {method: "POST", headers: {"Content-Type": "application/json"}, body: JSON.stringify(body), signal});
    bytes = await response.arrayBuffer();
  } catch (fault) {
    if (fault.name === "AbortError") throw {superseded: true};
    say("gone", "The server is gone; the page goes on asking for it.");
    throw {gone: true};
  } finally {
    clearTimeout(telling);
    say(path, "");
  }
  say("gone", "");
  if (response.ok) return bytes;
  try { told = JSON.parse(textOf(bytes)); } catch { /* Not the server's own words. */ }
  throw {error: "the server answered " + response.status, status: response.status, ...told};
}

const askJson = async (path, body) => JSON.parse(textOf(await ask(path, body)));

/** What the server says about a picture, and more: {…, number: of the request, decoded: a promise of its bitmap, seen: milliseconds it took to come}. */
async function askPicture(body, signal) {
  const start = performance.now(), number = ++requests, bytes = await ask("picture", {page: pageName, number, ...body}, signal);
  const length = new DataView(bytes).getUint32(0, true), about = JSON.parse(textOf(new Uint8Array(bytes, 4, length)));
  const blob = new Blob([new Uint8Array(bytes, 4 + length)], {type: about.type});
  return {...about, number, decoded: createImageBitmap(blob, {colorSpaceConversion: "none"}), seen: performance.now() - start};
}

/** Does what the user asks for while `button`, if any, waits, and tells what goes wrong. */
async function attempt(action, button = {}) {
  button.disabled = true;
  try {
    await action();
    say("error", "");
  } catch (fault) {
    if (fault instanceof Error) throw fault;
    if (fault.error) say("error", fault.error);
  } finally { button.disabled = false; }
}

async function poll() {
  const was = state, wasGone = messages.gone !== "";
  try {
    state = await askJson("state");
    say("fault", state.fault || "");
    const isNew = was && was.generation !== state.generation;
    if (isNew) say("news", "read again at " + new Date().toLocaleTimeString());
    if (isNew) setTimeout(() => say("news", ""), 5000);
    if (!was) for (const part of document.querySelectorAll("." + state.kind)) part.hidden = false;
    if (!was || wasGone || isNew) (state.kind === "scene" ? showScene : showFiles)(!was);
  } catch (fault) {
    if (fault instanceof Error) throw fault;
    if (fault.error) say("gone", fault.error);
  } finally { setTimeout(poll, 1000); }
}

// ------------------------------------------------------------------------------------------------ parts of both pages

const stage = byId("stage"), frame = byId("frame"), canvas = byId("picture"), context = canvas.getContext("2d");
const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
const walks = {KeyW: [0, 0, 1], KeyS: [0, 0, -1], KeyA: [-1, 0, 0], KeyD: [1, 0, 0], KeyQ: [0, -1, 0], KeyE: [0, 1, 0]};

const within = (value, lowest, highest) => Math.min(Math.max(value, lowest), highest);
const short = number => Number(number.toPrecision(3)).toString();
const vectorText = values => values.map(short).join("  ");
const on = (id, type, action) => byId(id).addEventListener(type, event => action(event.target, event));

function fillSelect(select, options, value) {
  select.replaceChildren(...options.map(([of, text]) => element("option", {value: of, textContent: text})));
  select.value = value;
}

const fillList = (list, entries) =>
  list.replaceChildren(...entries.flatMap(([name, text]) => [element("dt", {textContent: name}), element("dd", {textContent: text})]));

const readOut = parts => byId("readout").replaceChildren(
  ...parts.flatMap(([number, unit], i) => [i ? " · " : "", element("b", {textContent: number}), " " + unit]));

/** Shows what a picture has below its first rows: its legend. */
function showLegend(bitmap, rows) {
  const legend = byId("legend");
  legend.hidden = bitmap.height === rows;
  if (legend.hidden) return;
  Object.assign(legend, {width: bitmap.width, height: bitmap.height - rows});
  legend.style.width = bitmap.width / devicePixelRatio + "px";
  legend.getContext("2d").drawImage(bitmap, 0, -rows);
}

/**
 * Tells what pointers do on the frame: moved(dx, dy, event, press) in CSS pixels, pinched(ratio, dx, dy, event) of two
 * fingers, and clicked(x, y) in shares of the frame.
 */
function followPointers({moved, pinched, clicked}) {
  const pointers = new Map();
  let isClick = false, press = null;
  const distance = (a, b) => Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
  frame.addEventListener("contextmenu", event => event.preventDefault());
  frame.addEventListener("pointerdown", event => {
    if (event.target.closest(".marker")) return;
    frame.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, event);
    isClick = pointers.size === 1 && event.button === 0;
    press = event;
  });
  frame.addEventListener("pointermove", event => {
    const last = pointers.get(event.pointerId);
    if (!last || (isClick && distance(event, press) < 6)) return;
    isClick = false;
    pointers.set(event.pointerId, event);
    const other = [...pointers.values()].find(one => one !== event);
    const dx = event.clientX - last.clientX, dy = event.clientY - last.clientY;
    if (other) pinched(Math.max(1, distance(event, other)) / Math.max(1, distance(last, other)), dx / 2, dy / 2, event);
    else moved(dx, dy, event, press);
  });
  for (const end of ["pointerup", "pointercancel"])
    frame.addEventListener(end, event => {
      if (!pointers.delete(event.pointerId) || !isClick || end !== "pointerup") return;
      const box = frame.getBoundingClientRect();
      clicked(within((event.clientX - box.x) / box.width, 0, 1), within((event.clientY - box.y) / box.height, 0, 1));
    });
}

/** Calls wheeled(notches, event), positive away from the user. */
function followWheel(wheeled) {
  frame.addEventListener("wheel", event => {
    event.preventDefault();
    wheeled(-event.deltaY / [100, 3, 1][event.deltaMode], event);
  }, {passive: false});
}

/** Calls pressed(event), which says whether it took the key, for keys that no field needs. */
function followKeys(pressed) {
  addEventListener("keydown", event => {
    const {target, key} = event;
    if (target.closest("select, textarea, dialog, input:is([type='text'], [type='number'], [type='search'])")) return;
    if (target.closest(".marker, input:not([type='checkbox'])") && /^(Arrow|Home)/.test(key)) return;
    if (key === "?") byId("help").showModal(); else if (!pressed(event)) return;
    event.preventDefault();
  });
}

// ------------------------------------------------------------------------------------------------ a scene's pictures

const layers = [["color", "Picture"], ["normal", "Normals"], ["depth", "Depth"], ["position", "Positions"], ["diffuse", "Diffuse"],
  ["light_count", "Lights a pixel"], ["shadow", "Shadows"], ["light_error", "Bound"], ["error", "Error"], ["shadow_map", "Shadow map"]];
const kQuiet = 120;  // milliseconds without input, after which the full picture is asked for
const kTold = 200;   // milliseconds between two tellings of a motion's figures, which nobody reads faster
const storageKey = "luciole " + location.pathname;

let view = null;  // all that a picture depends on, see the server's `view`
let layer = "color", light = null, material = 0;  // light: the index of the selected one
let wanted = [16, 9];  // pixels of a full picture
let goodShaders = {};  // those of the last picture

// What the last picture is of this view: 0 nothing, 1 a frame of motion, 2 all pixels, 3 all samples.
let level = 3, serial = 0, lastInput = 0, timer = 0;
let flying = null;           // the request on its way, {isMoving, controller}
let lastFrame = null;        // of a motion, {milliseconds, size}
let shownNumber = 0;         // of the request whose picture is shown
let frameTimes = [];         // of the last second of a motion
let toldAt = 0;
const gestures = new Map();  // what no request has carried yet, summed by kind
const held = new Map();      // keys, and the gesture of a second
let heldSince = 0;

let isOfScene = true;        // whether the last picture's pixels are those of the view, and not of a map

const samplesWanted = () => layer === "color" ? Number(view.options.samples || 1) : 1;

/** The view has changed: a small picture at once and the full one after a while, or, `atRest`, the full one at once. */
function touch(atRest = false) {
  ++serial;
  level = atRest ? 1 : 0;
  lastInput = atRest ? -Infinity : performance.now();
  if (flying && !flying.isMoving) {
    flying.controller.abort();
    flying = null;
  }
  pump();
}

function addGesture(kind, amounts) {
  const sum = gestures.get(kind);
  gestures.set(kind, sum ? sum.map((amount, i) => amount + amounts[i]) : amounts);
}

function gesture(kind, ...amounts) {
  addGesture(kind, amounts);
  byId("spot").hidden = true;
  touch();
}

/** The gesture that has waited longest, as a request has it, or null. */
function takeGesture() {
  const [first] = gestures;
  if (!first) return null;
  gestures.delete(first[0]);
  const [kind, index] = first[0].split(" ");
  return {[kind]: kind === "dolly" ? first[1][0] : index ? [Number(index), ...first[1]] : first[1]};
}

/** Sends the next request, where one is due and none on its way. */
function pump() {
  clearTimeout(timer);
  if (flying || messages.gone || !view) return;
  // What is shown, for whoever drives the page from outside.
  Object.assign(frame.dataset, {level: gestures.size ? 0 : level, camera: JSON.stringify(view.camera), size: wanted});
  if (held.size) {
    const now = performance.now(), seconds = Math.min((now - heldSince) / 1000, 0.25);
    for (const [kind, amounts] of held.values()) addGesture(kind, amounts.map(amount => amount * seconds));
    heldSince = lastInput = now;
  }
  const wait = lastInput + kQuiet - performance.now();
  if (gestures.size || level === 0) draw(true, 1);
  else if (level < 3 && wait > 0) timer = setTimeout(pump, wait);
  else if (level < 3) draw(false, level === 1 ? 1 : samplesWanted());
}

async function draw(isMoving, samples) {
  const me = flying = {isMoving, controller: new AbortController()}, asked = {serial, ...view};
  const moved = isMoving ? takeGesture() : null, moving = isMoving ? lastFrame ?? true : null;
  let pause = 0;
  try {
    const about = await askPicture({view, gesture: moved, size: wanted, moving, samples, layer, light: light ?? 0}, me.controller.signal);
    if (flying !== me) return;
    if (moved?.drag_light && view.changes === asked.changes) view.changes = about.changes;
    if (moved && !moved.drag_light && view.camera === asked.camera) view.camera = about.camera;
    goodShaders = asked.shaders;
    if (asked.serial === serial) level = isMoving ? 1 : samples < samplesWanted() ? 2 : 3;
    if (isMoving || !lastFrame) lastFrame = {milliseconds: about.seen, size: about.shows};
    if (isMoving) {
      flying = null;  // The next frame is made while this one is decoded.
      pump();
    }
    const bitmap = await about.decoded;
    if (about.number < shownNumber) return bitmap.close();
    shownNumber = about.number;
    showPicture({...about, bitmap}, isMoving);
  } catch (fault) {
    if (flying !== me || fault.gone) return;
    if (asked.serial === serial) level = 3;
    if (fault instanceof Error) throw fault;
    pause = 300;
    if (fault.superseded || fault.status === 503) level = Math.min(level, 1); else showFault(fault, asked);
  } finally {
    if (flying === me) {
      flying = null;
      if (pause) timer = setTimeout(pump, pause); else pump();
    }
  }
}

function showPicture(about, isMoving) {
  const {bitmap, size, shows, samples, milliseconds} = about, now = performance.now();
  const height = bitmap.width === shows[0] ? Math.min(bitmap.height, shows[1]) : bitmap.height;
  isOfScene = layer !== "shadow_map" && bitmap.width === shows[0];
  if (canvas.width !== bitmap.width || canvas.height !== height) Object.assign(canvas, {width: bitmap.width, height});
  context.drawImage(bitmap, 0, 0);
  if (!isMoving || height === bitmap.height) showLegend(bitmap, height);
  bitmap.close();
  frameTimes = isMoving ? [...frameTimes.filter(time => now - time < 1000), now] : [];
  say("error", "");
  showMarkers(about.markers);
  showCamera();
  for (const kind of shaderKinds) if (goodShaders[kind] === textInUse(kind)) editors[kind].fault = null;
  showShaderFaults();
  if (isMoving && now - toldAt < kTold) return;
  toldAt = now;
  const speed = frameTimes.length > 2 ? [[((frameTimes.length - 1) * 1000 / (now - frameTimes[0])).toFixed(0), "fps"]] : [];
  readOut([...speed, [(isOfScene ? [canvas.width, canvas.height] : size).join(" × "), "pixels"], ...(samples > 1 ? [[samples, "samples"]] : []),
    [milliseconds.toFixed(milliseconds < 10 ? 1 : 0), "ms"]]);
  say("warnings", about.warnings.join("; "));
  byId("notes").textContent = about.notes.join(" · ");
  showStages(about.stages);
  if (!isMoving && samples === 1 && layer === "color") showBound(about);
}

/** Tells what failed. A shader that doesn't compile stays in its editor, and the pictures go on with the last ones that did. */
function showFault({error, shader}, asked) {
  if (!shader) return say("error", error);
  editors[shader.kind].fault = {...shader, error};
  showShaderFaults();
  if (view.shaders !== asked.shaders || JSON.stringify(asked.shaders) === JSON.stringify(goodShaders)) return;
  view.shaders = goodShaders;
  level = Math.min(level, 1);
}

/** Fits the frame, of the scene's shape, into the stage. */
function layOut() {
  const [w, h] = state.size, scale = Math.min(stage.clientWidth / w, stage.clientHeight / h), dense = Math.min(devicePixelRatio, 2);
  const size = [w, h].map(side => Math.max(16, Math.round(side * scale * dense)));
  [frame.style.width, frame.style.height] = size.map(side => side / dense + "px");
  if (size.join() === wanted.join()) return;
  wanted = size;
  clearTimeout(timer);
  timer = setTimeout(touch, kQuiet, true);
}

const markers = new Map();
let markerPlaces = [];

function addMarker(given) {
  const marker = element("button", {type: "button", className: "marker", title: given.name, ariaLabel: `Light ${given.name}: arrows move it`});
  let last = null;
  marker.addEventListener("focus", () => selectLight(given.index));
  marker.addEventListener("pointerdown", event => {
    marker.setPointerCapture(event.pointerId);
    marker.focus();
    last = event;
  });
  marker.addEventListener("pointermove", event => {
    if (!last) return;
    gesture("drag_light " + given.index, ...[event.clientX - last.clientX, event.clientY - last.clientY].map(step => step / frame.clientHeight));
    last = event;
  });
  for (const end of ["pointerup", "pointercancel"]) marker.addEventListener(end, () => { last = null; });
  marker.addEventListener("keydown", event => {
    if (!arrows[event.key]) return;
    event.preventDefault();
    gesture("drag_light " + given.index, ...arrows[event.key].map(step => step * (event.shiftKey ? 0.05 : 0.01)));
  });
  markers.set(given.index, marker);
  frame.append(marker);
  return marker;
}

/** Puts a marker on each light that is to have one: [index, x, y] in shares of the picture. */
function showMarkers(places) {
  markerPlaces = places;
  const shownPlaces = !isOfScene ? [] : places.filter(([index]) => index === light || byId("all_markers").checked);
  for (const [index, marker] of markers)
    if (!shownPlaces.some(([of]) => of === index)) {
      marker.remove();
      markers.delete(index);
    }
  for (const [index, x, y] of shownPlaces) {
    const given = state.lights.find(one => one.index === index), marker = markers.get(index) || addMarker(given);
    [marker.style.left, marker.style.top] = [100 * x + "%", 100 * y + "%"];
    marker.style.setProperty("--light", colorOf(given));
    marker.classList.toggle("selected", index === light);
  }
}

function showStages(stages) {
  const seen = stages.filter(([, milliseconds]) => milliseconds >= 0.05), longest = Math.max(...seen.map(([, milliseconds]) => milliseconds));
  byId("stages").replaceChildren(...seen.map(([name, milliseconds]) => {
    const row = element("tr", {}, element("td", {textContent: name}), element("td", {textContent: milliseconds.toFixed(1) + " ms"}));
    row.style.setProperty("--share", 100 * milliseconds / longest + "%");
    return row;
  }));
}

// ------------------------------------------------------------------------------------------------ speed against error

const lightErrorNow = () => (view.options["light-error"] || "0").split("/").reduce((over, under) => over / under);
const fraction = share => share > 0 ? "1/" + Math.round(1 / share) : "0";
let tried = {of: "", points: []};  // what light errors gave, {share, largest, milliseconds}, of the view that they differ in alone

function showBound({bound, milliseconds}) {
  const share = Number(lightErrorNow()), largest = bound?.largest ?? 0;
  const of = JSON.stringify([view, wanted], (key, value) => key === "light-error" ? undefined : value);
  if (tried.of !== of) tried = {of, points: []};
  tried.points = [...tried.points.filter(point => point.share !== share), {share, largest, milliseconds}].sort((a, b) => a.share - b.share);
  fillList(byId("bound"), [["Bound", largest ? `${short(largest)} at most, ${short(bound.mean)} in the mean` : share ? "0: no light can be stood for by others" : "0: every light by itself"],
    ["Time", milliseconds.toFixed(1) + " ms"]]);
  plotTried(share);
}

/** Draws the largest bound, by powers of two, against milliseconds; what is exact lies at the bottom. */
function plotTried(now) {
  const {points} = tried, powers = points.map(point => Math.log2(point.largest)).filter(isFinite);
  const lowest = Math.floor(Math.min(...powers, -8)) - 1, highest = Math.ceil(Math.max(...powers, -4));
  const slowest = 1.15 * Math.max(...points.map(point => point.milliseconds));
  const place = ({largest, milliseconds}) =>
    [44 + 260 * milliseconds / slowest, largest > 0 ? 16 + 92 * (highest - Math.log2(largest)) / (highest - lowest) : 122].map(at => at.toFixed(1));
  const text = (x, y, anchor, what) => `<text x="${x}" y="${y}" text-anchor="${anchor}">${what}</text>`;
  const taken = [];
  const marks = [...points].sort((a, b) => (b.share === now) - (a.share === now)).map(point => {
    const [x, y] = place(point), isNow = point.share === now, isFree = !taken.some(other => Math.abs(other[0] - x) < 38 && Math.abs(other[1] - y) < 12);
    if (isFree) taken.push([x, y]);
    return `<circle class="${isNow ? "now" : ""}" cx="${x}" cy="${y}" r="${isNow ? 5 : 3.5}"/>` +
      (isFree ? text(x, y - 8, "middle", point.share ? fraction(point.share) : "exact") : "");
  });
  byId("plot").innerHTML = `<svg viewBox="0 0 320 152" role="img"><path d="M44 4V130H316"/><polyline points="${points.map(point => place(point).join())}"/>` +
    marks.join("") + text(40, 20, "end", fraction(2 ** highest)) + text(40, 112, "end", fraction(2 ** lowest)) + text(40, 126, "end", 0) +
    text(44, 146, "middle", 0) + text(316, 146, "end", slowest.toFixed(0) + " ms") + text(40, 66, "end", "bound") + "</svg>";
  byId("plot").firstChild.ariaLabel = "Largest bound against milliseconds: " + points.map(point =>
    `light error ${fraction(point.share)}: ${short(point.largest)}, ${point.milliseconds.toFixed(0)} ms`).join("; ");
}

// ------------------------------------------------------------------------------------------------ what can be set

const defaults = {model: "phong", shading: "phong", shadows: "auto", samples: "1", exposure: "0"};
const movedCamera = "moved";

/** The value that the view gives a place of the scene's file, as text; undefined where it leaves it alone. */
const changeOf = path => view.changes.find(change => change.startsWith(path + "="))?.slice(path.length + 1);

function setChange(path, value) {
  const change = path + "=" + value, at = view.changes.findIndex(one => one.startsWith(path + "="));
  view.changes = at < 0 ? [...view.changes, change] : view.changes.with(at, change);
  touch();
}

function setOption(name, value) {
  view.options = {...view.options, [name]: value};
  showOptions();
  touch();
}

function showOptions() {
  for (const select of document.querySelectorAll("[data-option]")) {
    const name = select.dataset.option, value = view.options[name] || defaults[name];
    const choices = state.choices[name] || ["1", "2", "4", "8", "16", "32", "64"];
    fillSelect(select, [...new Set([...choices, value])].map(choice => [choice, choice]), value);
  }
  const exposure = view.options.exposure || defaults.exposure, isAuto = exposure === "auto", error = lightErrorNow();
  byId("auto").checked = byId("exposure").disabled = isAuto;
  byId("exposure").value = Number(exposure) || 0;
  byId("stops").value = isAuto ? "" : Number(exposure).toFixed(1);
  byId("light_error").value = error > 0 ? Math.log2(error) + 15 : 0;
  byId("light_error").ariaValueText = byId("light_error_value").value = fraction(error);
}

function showCamera() {
  const isMoved = view.camera !== null && typeof view.camera === "object", select = byId("camera");
  select.lastElementChild.hidden = !isMoved;
  select.value = isMoved ? movedCamera : view.camera === null ? "" : state.cameras.indexOf(view.camera);
}

function setCamera(camera) {
  view.camera = camera;
  byId("spot").hidden = true;
  showCamera();
  touch();
}

function setLayer(name) {
  layer = name;
  byId("layers").querySelector(`[value="${name}"]`).checked = true;
  touch();
}

/** A row with a colour and its strength, which go to a place of the scene's file together. `hex` is of color / strength. */
function addColor(body, label, path, color, hex, changed = setChange) {
  const [given, strength] = (changeOf(path) || hex + "*" + short(Math.max(1, ...color))).split("*");
  const picker = element("input", {type: "color", value: given, title: label + ", colour"});
  const number = element("input", {type: "number", min: 0, step: 0.1, value: strength, title: label + ", strength"});
  picker.oninput = number.oninput = () => { if (number.valueAsNumber >= 0) changed(path, picker.value + "*" + number.valueAsNumber); };
  body.append(element("tr", {}, element("th", {scope: "row", textContent: label}), element("td", {}, picker), element("td", {}, number)));
}

const pathOf = given => `lights[${given.index}]`;
const colorOf = given => changeOf(pathOf(given) + ".color") ?? given.hex;
const isOn = given => (changeOf(pathOf(given) + ".enabled") ?? String(given.enabled)) !== "false";
let lightRows = [];

function showLights() {
  const lights = state.lights.map(given => ({given, name: given.name, on: isOn(given), color: colorOf(given),
    factor: Number(changeOf(pathOf(given) + ".intensity") ?? given.intensity), largest: 4 * given.intensity || 4}));
  lightRows = lightTable(byId("lights"), lights, changeLight);
  for (const {light: {given, name}, row} of lightRows)
    row.cells[0].replaceChildren(element("button", {type: "button", textContent: name, title: name, onclick: () => selectLight(given.index)}));
  byId("light_count").textContent = lights.length < state.light_count ? `${lights.length} of ${state.light_count}` : lights.length;
  byId("search").hidden = lights.length < 12;
  selectLight(lights.some(one => one.given.index === light) ? light : null);
}

/** Tells the server of a light's row; colour and strength together, since the file's colour may hold the strength, too. */
function changeLight({given, on: isLit, factor, color}) {
  if (isLit !== isOn(given)) return setChange(pathOf(given) + ".enabled", isLit);
  setChange(pathOf(given) + ".color", color);
  setChange(pathOf(given) + ".intensity", factor);
}

function selectLight(index) {
  const given = state.lights.find(one => one.index === index), isOther = index !== light;
  light = index;
  for (const {light: {given: of}, row} of lightRows) row.cells[0].firstChild.ariaPressed = of.index === index;
  byId("light").hidden = !given;
  if (given) {
    fillList(byId("light").firstChild, [["Kind", given.kind], ...(given.position ? [["Position", vectorText(given.position)]] : []),
      ...(given.radius ? [["Radius", short(given.radius) + " m"]] : [])]);
    byId("casts").checked = (changeOf(pathOf(given) + ".shadow") ?? String(given.shadow)) === "true";
  }
  showMarkers(markerPlaces);
  if (isOther && layer === "shadow_map") touch();
}

function showMaterial(index) {
  const given = state.materials.find(one => one.index === index) || state.materials[0], body = byId("material_colors");
  byId("surface_panel").hidden = !given;
  body.replaceChildren();
  if (!given) return;
  material = byId("material").value = given.index;
  for (const name of ["diffuse", "specular", "emission"])
    addColor(body, name[0].toUpperCase() + name.slice(1), `materials[${material}].${name}`, given[name], given[name + "_hex"]);
  byId("shininess").value = changeOf(`materials[${material}].shininess`) ?? short(given.shininess);
}

const pick = (x, y) => isOfScene && attempt(async () => {
  const found = await askJson("pick", {view, size: wanted, at: [x, y]}), {pixel, color, object, position, normal, distance} = found;
  Object.assign(byId("spot").style, {left: 100 * x + "%", top: 100 * y + "%"});
  byId("spot").hidden = false;
  fillList(byId("picked"), [["Pixel", pixel.join(", ")], ["Colour", vectorText(color)], ...(found.material === null ? [["Surface", "none"]] : [
    ["Object", object], ["Position", vectorText(position)], ["Normal", vectorText(normal)], ["Distance", short(distance) + " m"]])]);
  byId("surface_panel").open = true;
  if (found.material !== null) showMaterial(found.material);
});

function showAir() {
  const fog = state.fog || {mode: "", color: [0.5, 0.5, 0.5], hex: "#bcbcbc"}, now = {...fog, ...JSON.parse(changeOf("fog") || "{}")};
  byId("air_colors").replaceChildren();
  addColor(byId("air_colors"), "Ambient", "ambient", state.ambient, state.ambient_hex);
  addColor(byId("air_colors"), "Background", "background", state.background, state.background_hex);
  byId("fog_mode").value = now.density === 0 ? "" : now.mode;
  for (const [name, usual] of [["density", 0.05], ["start", 0], ["end", 100]]) byId("fog_" + name).value = JSON.stringify(now[name] || usual);
  byId("fog_colors").replaceChildren();
  addColor(byId("fog_colors"), "Colour", "fog.color", fog.color, fog.hex, setFog);
  showFogParts();
}

function showFogParts() {
  const mode = byId("fog_mode").value;
  byId("fog").hidden = !mode;
  for (const name of ["density", "start", "end"]) byId("fog_" + name).parentElement.hidden = (name === "density") === (mode === "linear");
}

/** Sets all of the fog, since one mode's numbers are none of another's. Waits for numbers where there are none yet. */
function setFog() {
  const mode = byId("fog_mode").value, [picker, strength] = byId("fog_colors").querySelectorAll("input");
  showFogParts();
  try {
    const [density, start, end] = ["density", "start", "end"].map(name => JSON.parse(byId("fog_" + name).value));
    setChange("fog", JSON.stringify(mode === "linear" ? {mode, start, end} : {mode: mode || "exp2", density: mode ? density : 0}));
    setChange("fog.color", picker.value + "*" + strength.value);
  } catch (fault) { if (!(fault instanceof SyntaxError)) throw fault; }
}

// ------------------------------------------------------------------------------------------------ shaders

const shaderKinds = ["model", "surface", "screen"];
const editors = Object.fromEntries(shaderKinds.map(kind => [kind, {text: "", isUsed: false, fault: null}]));
const textInUse = kind => editors[kind].isUsed ? editors[kind].text : "";
const textsInUse = () => Object.fromEntries(shaderKinds.map(kind => [kind, textInUse(kind)]));
let kindShown = "model", typing = 0, doesTabLeave = false;

function showEditor() {
  const {text, isUsed} = editors[kindShown], examples = Object.keys(state.examples[kindShown] || {});
  Object.assign(byId("text"), {value: text, scrollTop: 0});
  byId("in_use").checked = isUsed;
  fillSelect(byId("examples"), [["", "Examples …"], ...examples.map(name => [name, name])], "");
  byId("check").hidden = kindShown !== "model";
  byId("figures").hidden = true;
  numberLines();
  showShaderFaults();
}

function numberLines() {
  byId("numbers").textContent = Array.from(byId("text").value.split("\n"), (line, i) => i + 1).join("\n") + "\n\n";
  byId("numbers").scrollTop = byId("text").scrollTop;
}

function showShaderFaults() {
  const {fault} = editors[kindShown];
  for (const radio of byId("kinds").querySelectorAll("input")) radio.classList.toggle("faulty", editors[radio.value].fault !== null);
  byId("editor").style.setProperty("--bad", fault ? fault.line - 1 : -9);
  byId("shader_fault").textContent = fault ? fault.error : "";
  say("shader", shaderKinds.map(kind => editors[kind].fault?.error).filter(Boolean).join("; "));
}

function useShaders() {
  clearTimeout(typing);
  view.shaders = textsInUse();
  touch(true);
}

function changeText() {
  byId("in_use").checked = true;
  Object.assign(editors[kindShown], {text: byId("text").value, isUsed: true});
  numberLines();
  clearTimeout(typing);
  typing = setTimeout(useShaders, 250);
}

// ------------------------------------------------------------------------------------------------ the page of a scene

/** The view that this tab showed last, or that of the command line. */
function restore() {
  const kept = JSON.parse(sessionStorage.getItem(storageKey) || "{}");
  view = kept.view ?? {camera: null, changes: [], options: {...state.options}, shaders: {}};
  layer = kept.layer ?? "color";
  for (const kind of shaderKinds) {
    const given = state.shaders[kind] || "", [example] = Object.values(state.examples[kind] || {});
    editors[kind] = kept.editors?.[kind] ?? {text: given || example || "", isUsed: given !== "", fault: null};
  }
  view.shaders = textsInUse();
}

/** Shows what the server told: at first, after the scene was read again, and when the server has come back. */
function showScene(isFirst) {
  if (isFirst) {
    restore();
    listen();
  }
  document.title = "Luciole: " + state.name;
  byId("name").textContent = state.name.split("/").pop();
  byId("saved").textContent = "Into " + state.output;
  fillSelect(byId("camera"), [["", "as it was"], ...state.cameras.map((name, i) => [i, name]).filter(([, name]) => name), [movedCamera, "moved"]], "");
  fillSelect(byId("material"), state.materials.map(({index, name}) => [index, name]), material);
  for (const show of [showOptions, showCamera, showLights, showAir, showEditor, layOut]) show();
  showMaterial(material);
  touch(true);
}

/** The gesture of a second of a held key, [kind, amounts], or null. */
function heldGesture({key, code, shiftKey, altKey, ctrlKey, metaKey}) {
  const arrow = arrows[key];
  if (arrow && (shiftKey || altKey || ctrlKey)) return [shiftKey ? "orbit" : altKey ? "turn" : "pan", arrow.map(step => 0.6 * step)];
  if (ctrlKey || metaKey || altKey) return null;
  if (arrow) return ["walk", [arrow[0], 0, -arrow[1]]];
  return walks[code] ? ["walk", walks[code]] : "+=-".includes(key) ? ["dolly", [key === "-" ? -8 : 8]] : null;
}

function pressKey(event) {
  const seconds = heldGesture(event);
  if (seconds) {
    if (!held.size) heldSince = performance.now() - 40;
    held.set(event.code, seconds);
    if (!event.repeat) touch();
    byId("spot").hidden = true;
  } else if (event.ctrlKey || event.metaKey || event.altKey) return false;
  else if (/^[0-9]$/.test(event.key)) setLayer(layers[(Number(event.key) + 9) % 10][0]);
  else if (event.key === "Home") setCamera(null);
  else if (event.key.toLowerCase() === "m") byId("all_markers").click();
  else if (event.key === "Enter" && event.target === frame) pick(0.5, 0.5);
  else return false;
  return true;
}

/** Connects the scene's controls, once. */
function listen() {
  const shares = (dx, dy) => [dx / frame.clientHeight, dy / frame.clientHeight];
  followPointers({
    moved: (dx, dy, event, press) => gesture(press.button > 0 || press.shiftKey ? "pan" : press.altKey ? "turn" : "orbit", ...shares(dx, dy)),
    pinched(ratio, dx, dy) {
      addGesture("pan", shares(dx, dy));
      gesture("dolly", 5 * Math.log2(ratio));
    },
    clicked: pick,
  });
  followWheel(notches => gesture("dolly", notches));
  followKeys(pressKey);
  addEventListener("keyup", event => held.delete(event.code));
  addEventListener("blur", () => held.clear());
  addEventListener("pagehide", () => sessionStorage.setItem(storageKey, JSON.stringify({view, layer, editors})));
  new ResizeObserver(layOut).observe(stage);

  byId("layers").append(...layers.map(([value, text]) => element("label", {}, element("input", {type: "radio", name: "layer", value,
    checked: value === layer, onchange: () => setLayer(value)}), element("span", {textContent: text}))));
  on("reset", "click", () => {
    sessionStorage.removeItem(storageKey);
    restore();
    setLayer(layer);
    showScene(false);
  });
  on("camera", "change", ({value}) => setCamera(value === "" ? null : state.cameras[value]));
  for (const select of document.querySelectorAll("[data-option]"))
    select.addEventListener("change", () => setOption(select.dataset.option, select.value));
  on("exposure", "input", ({value}) => setOption("exposure", value));
  on("auto", "change", ({checked}) => setOption("exposure", checked ? "auto" : "0"));
  on("light_error", "input", ({value}) => setOption("light-error", value === "0" ? "0" : "1/" + 2 ** (15 - value)));
  on("search", "input", ({value}) => {
    for (const {light: {name}, row} of lightRows) row.hidden = !name.toLowerCase().includes(value.toLowerCase());
  });
  on("all_markers", "change", () => showMarkers(markerPlaces));
  on("casts", "change", ({checked}) => setChange(`lights[${light}].shadow`, checked));
  on("show_map", "click", () => setLayer("shadow_map"));
  on("material", "change", ({value}) => showMaterial(Number(value)));
  on("shininess", "input", ({valueAsNumber}) => { if (valueAsNumber >= 0) setChange(`materials[${material}].shininess`, valueAsNumber); });
  for (const name of ["mode", "density", "start", "end"]) on("fog_" + name, "input", setFog);

  on("kinds", "change", ({value}) => { kindShown = value; showEditor(); });
  on("in_use", "change", ({checked}) => { editors[kindShown].isUsed = checked; useShaders(); });
  on("text", "input", changeText);
  on("text", "scroll", ({scrollTop}) => { byId("numbers").scrollTop = scrollTop; });
  on("text", "keydown", (text, event) => {
    if (event.key === "Tab" && !event.shiftKey && !doesTabLeave) {
      event.preventDefault();
      document.execCommand("insertText", false, "  ");  // As typing does, so that it can be undone.
    }
    if (event.key !== "Shift") doesTabLeave = event.key === "Escape";
  });
  on("examples", "change", ({value}) => {
    if (!value) return;
    Object.assign(byId("text"), {value: state.examples[kindShown][value], scrollTop: 0});
    changeText();
  });
  on("check", "click", button => attempt(async () => {
    const {lines} = await askJson("check", {view: {...view, shaders: {...view.shaders, model: editors.model.text}}});
    Object.assign(byId("figures"), {textContent: lines.join("\n"), hidden: false});
  }, button));
  on("save", "click", button => attempt(async () => {
    const what = [...document.querySelectorAll("[name='what']:checked")].map(({value}) => value);
    const {files, command} = await askJson("save", {view, size: state.size, what});
    byId("saved").textContent = "Written: " + files.join(", ");
    byId("saved_command").firstChild.textContent = command;
    byId("saved_command").hidden = false;
  }, button));
}

for (const button of document.querySelectorAll(".copy"))
  button.addEventListener("click", async () => {
    getSelection().selectAllChildren(button.previousElementSibling);
    // The clipboard's own interface is only there on 127.0.0.1 and behind TLS.
    if (navigator.clipboard) await navigator.clipboard.writeText(getSelection().toString()); else document.execCommand("copy");
    button.textContent = "Copied";
    setTimeout(() => { button.textContent = "Copy"; }, 1500);
  });
if (matchMedia("(max-width: 52rem)").matches) for (const panel of document.querySelectorAll("details")) panel.open = false;
on("show_help", "click", () => byId("help").showModal());
setTimeout(poll);  // When files.js has been read, too.
