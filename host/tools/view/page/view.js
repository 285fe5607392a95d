// ------------------------------------------------------------------------------------------------ the server

const pageName = crypto.getRandomValues(new Uint32Array(2)).join("-");
let requests = 0;
let state = null;  // what the server told last, see its `state`

/** What there is to tell, by its kind; the line below the picture holds all that isn't empty. */
const messages = {gone: "", fault: "", error: "", news: "", warnings: ""};
function say(kind, text) {
  if (messages[kind] === text) return;
  messages[kind] = text;
  byId("messages").replaceChildren(...Object.entries(messages).filter(([, told]) => told).map(([of, told]) =>
    element("span", {className: of === "news" || of === "warnings" ? of : "error", textContent: told, title: told})));
}

/** A request's answer, {response, bytes}. Throws {error, status, shader}, {gone: true} or, where it was given up, {superseded: true}. */
async function ask(path, body, signal) {
  let response, bytes;
  try {
    response = await fetch(path, body && {method: "POST", headers: {"Content-Type": "application/json"}, body: JSON.stringify(body), signal});
    bytes = await response.arrayBuffer();
  } catch (fault) {
    if (fault.name === "AbortError") throw {superseded: true};
    say("gone", "The server is gone; the page goes on asking for it.");
    throw {gone: true};
  }
  say("gone", "");
  if (response.ok) return bytes;
  let told = {};
  try { told = JSON.parse(new TextDecoder().decode(bytes)); } catch { /* Not the server's own words. */ }
  throw {error: "the server answered " + response.status, status: response.status, ...told};
}

const askJson = async (path, body) => JSON.parse(new TextDecoder().decode(await ask(path, body)));

/** A picture and what the server says about it: {…, bitmap, seen: milliseconds from the request to the decoded picture}. */
async function askPicture(body, signal) {
  const start = performance.now(), bytes = await ask("picture", {page: pageName, number: ++requests, ...body}, signal);
  const length = new DataView(bytes).getUint32(0, true);
  const about = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  const blob = new Blob([new Uint8Array(bytes, 4 + length)], {type: about.type});
  about.bitmap = await createImageBitmap(blob, {colorSpaceConversion: "none"});
  return {...about, seen: performance.now() - start};
}

/** Does what a click asks for, and tells what goes wrong. */
async function attempt(action) {
  try { await action(); say("error", ""); } catch (fault) {
    if (fault instanceof Error) throw fault;
    if (fault.error) say("error", fault.error);
  }
}

async function poll() {
  const was = state, wasGone = messages.gone !== "";
  try {
    state = await askJson("state");
    say("fault", state.fault || "");
    if (was && was.generation !== state.generation) {
      say("news", "read again at " + new Date().toLocaleTimeString());
      setTimeout(() => say("news", ""), 5000);
    }
    if (!was) for (const part of document.querySelectorAll("." + state.kind)) part.hidden = false;
    if (!was || wasGone || was.generation !== state.generation) (state.kind === "scene" ? showScene : showFiles)(!was);
  } catch (fault) {
    if (fault instanceof Error) throw fault;
    if (fault.error) say("error", fault.error);
  } finally {
    setTimeout(poll, 1000);
  }
}

// ------------------------------------------------------------------------------------------------ parts

const stage = byId("stage"), frame = byId("frame"), canvas = byId("picture"), context = canvas.getContext("2d");
const tick = () => new Promise(resolve => setTimeout(resolve));
const short = number => Number(number.toPrecision(3)).toString();
const fillSelect = (select, options, value) => {
  select.replaceChildren(...options.map(([of, text]) => element("option", {value: of, textContent: text})));
  select.value = value;
};
const fillList = (list, entries) =>
  list.replaceChildren(...entries.flatMap(([name, text]) => [element("dt", {textContent: name}), element("dd", {textContent: text})]));

function readout(parts) {
  byId("readout").replaceChildren(...parts.flatMap(([number, unit], i) => [i ? " · " : "", element("b", {textContent: number}), " " + unit]));
}

function addCopy(button, text) {
  button.addEventListener("click", async () => {
    getSelection().selectAllChildren(text);
    // The clipboard's own interface is only there on 127.0.0.1 and behind TLS.
    if (navigator.clipboard) await navigator.clipboard.writeText(text.textContent); else document.execCommand("copy");
    button.textContent = "Copied";
    setTimeout(() => { button.textContent = "Copy"; }, 1500);
  });
}

/**
 * Tells what pointers do on the frame: moved(dx, dy, event) in CSS pixels, pinched(ratio, dx, dy, x, y) of two fingers, and
 * clicked(x, y) in shares of the frame.
 */
function followPointers({moved, pinched, clicked}) {
  const pointers = new Map();
  let isClick = false, press = null;
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
    if (!last) return;
    if (isClick && Math.hypot(event.clientX - press.clientX, event.clientY - press.clientY) < 4) return;
    isClick = false;
    const other = [...pointers.values()].find(one => one.pointerId !== event.pointerId);
    const dx = event.clientX - last.clientX, dy = event.clientY - last.clientY;
    pointers.set(event.pointerId, event);
    if (!other) return moved(dx, dy, event, press);
    const distance = one => Math.max(1, Math.hypot(one.clientX - other.clientX, one.clientY - other.clientY));
    pinched(distance(event) / distance(last), dx / 2, dy / 2, (event.clientX + other.clientX) / 2, (event.clientY + other.clientY) / 2);
  });
  for (const end of ["pointerup", "pointercancel"])
    frame.addEventListener(end, event => {
      if (!pointers.delete(event.pointerId)) return;
      const box = frame.getBoundingClientRect();
      if (isClick && end === "pointerup") clicked((event.clientX - box.x) / box.width, (event.clientY - box.y) / box.height);
      isClick = false;
    });
}

/** Notches of a wheel, positive away from the user. */
const notchesOf = event => -event.deltaY / [100, 3, 1][event.deltaMode];

/** Calls pressed(event), which says whether it took the key, for keys that no field needs. */
function followKeys(pressed) {
  addEventListener("keydown", event => {
    if (event.target.closest("select, textarea, dialog, input:not([type='checkbox']), .marker") && event.key !== "Escape") return;
    if (event.key === "?") byId("help").showModal(); else if (!pressed(event)) return;
    event.preventDefault();
  });
}

// ------------------------------------------------------------------------------------------------ a scene's pictures

const layers = [["color", "Picture"], ["normal", "Normals"], ["depth", "Depth"], ["position", "Positions"], ["diffuse", "Diffuse"],
  ["light_count", "Lights a pixel"], ["shadow", "Shadows"], ["light_error", "Bound"], ["error", "Error"], ["shadow_map", "Shadow map"]];
const kQuiet = 120;  // milliseconds without input, after which the full picture is asked for
const storageKey = "luciole " + location.pathname;

let view = null;  // all that a picture depends on, see the server's `view`
let layer = "color", light = null, material = 0;  // light: the index of the selected one
let wanted = [16, 9];  // pixels of a full picture
let goodShaders = {};  // those of the last picture

// What the last picture is of this view: 0 nothing, 1 a frame of motion, 2 all pixels, 3 all samples.
let level = 3, serial = 0, lastInput = 0, timer = 0;
let flying = null;     // the request on its way, {isMoving, controller}
let lastFrame = null;  // of a motion, {milliseconds, size}
let drawn = [];        // when the last frames of a motion were
const gestures = new Map();  // what no request has carried yet, summed by kind
const held = new Map();      // keys, and the gesture of a second
let heldSince = 0;

const samplesWanted = () => layer === "color" ? Number(view.options.samples || 1) : 1;
const lightShown = () => light ?? state.lights.find(one => one.shadow)?.index ?? 0;

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
  touch();
}

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
  const moved = isMoving ? takeGesture() : null;
  let pause = 0;
  try {
    const about = await askPicture({view, gesture: moved, size: wanted, moving: isMoving ? lastFrame : null, samples, layer, light: lightShown()},
      me.controller.signal);
    if (flying !== me) return;
    if (moved?.drag_light && view.changes === asked.changes) view.changes = about.changes;
    else if (moved && view.camera === asked.camera) view.camera = about.camera;
    goodShaders = asked.shaders;
    if (asked.serial === serial) level = isMoving ? 1 : samples < samplesWanted() ? 2 : 3;
    showPicture(about, isMoving);
  } catch (fault) {
    if (flying !== me) return;
    if (asked.serial === serial) level = 3;
    if (fault instanceof Error) throw fault;
    if (fault.superseded || fault.status === 503) {
      level = Math.min(level, 1);
      pause = 300;
    } else if (!fault.gone) showFault(fault, asked);
  } finally {
    if (flying === me) {
      flying = null;
      if (pause) timer = setTimeout(pump, pause); else pump();
    }
  }
}

function showPicture(about, isMoving) {
  const {bitmap, size} = about, now = performance.now();
  if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) Object.assign(canvas, {width: bitmap.width, height: bitmap.height});
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  if (isMoving || !lastFrame) lastFrame = {milliseconds: about.seen, size};
  drawn = isMoving ? [...drawn.filter(time => now - time < 1000), now] : [];
  const speed = drawn.length > 2 ? [[((drawn.length - 1) * 1000 / (now - drawn[0])).toFixed(0), "fps"]] : [];
  const counted = about.samples > 1 ? [[about.samples, "samples"]] : [];
  readout([...speed, [size.join(" × "), "pixels"], ...counted, [about.milliseconds.toFixed(about.milliseconds < 10 ? 1 : 0), "ms"]]);
  say("error", "");
  say("warnings", (about.warnings || []).join("; "));
  byId("notes").textContent = (about.notes || []).join(" · ");
  showMarkers(about.markers || []);
  showStages(about.stages || []);
  if (!isMoving && about.samples === 1 && layer === "color") showBound(about);
  showCamera();
  for (const kind of shaderKinds) if (goodShaders[kind] === textInUse(kind)) editors[kind].fault = null;
  showShaderFaults();
  if (about.generation !== state.generation) byId("spot").hidden = true;
}

/** Tells what failed. A shader that doesn't compile stays in its editor, and the pictures go on with the last one that did. */
function showFault(fault, asked) {
  say("error", fault.error);
  if (!fault.shader) return;
  editors[fault.shader.kind].fault = {...fault.shader, message: fault.error};
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
  if (size[0] === wanted[0] && size[1] === wanted[1]) return;
  wanted = size;
  clearTimeout(timer);
  timer = setTimeout(() => touch(true), messages.gone || !lastFrame ? 0 : kQuiet);
}

const markers = new Map();
let markerPlaces = [];

function addMarker(index) {
  const given = state.lights.find(one => one.index === index), height = () => frame.clientHeight;
  const marker = element("button", {type: "button", className: "marker", title: given.name, ariaLabel: `Light ${given.name}: arrows move it`});
  let last = null;
  marker.addEventListener("pointerdown", event => {
    marker.setPointerCapture(event.pointerId);
    last = event;
    selectLight(index);
  });
  marker.addEventListener("pointermove", event => {
    if (!last) return;
    gesture("drag_light " + index, (event.clientX - last.clientX) / height(), (event.clientY - last.clientY) / height());
    last = event;
  });
  for (const end of ["pointerup", "pointercancel"]) marker.addEventListener(end, () => { last = null; });
  marker.addEventListener("focus", () => selectLight(index));
  marker.addEventListener("keydown", event => {
    const arrow = arrows[event.key];
    if (!arrow) return;
    event.preventDefault();
    gesture("drag_light " + index, ...arrow.map(step => step * (event.shiftKey ? 0.1 : 0.01)));
  });
  markers.set(index, marker);
  frame.append(marker);
  return marker;
}

/** Puts a marker on each light that is to have one: [index, x, y] in shares of the picture. */
function showMarkers(places) {
  markerPlaces = places;
  const shown = places.filter(([index]) => layer !== "shadow_map" && (index === light || byId("all_markers").checked));
  const indices = new Set(shown.map(([index]) => index));
  for (const [index, marker] of markers)
    if (!indices.has(index)) {
      marker.remove();
      markers.delete(index);
    }
  for (const [index, x, y] of shown) {
    const marker = markers.get(index) || addMarker(index);
    [marker.style.left, marker.style.top] = [x, y].map(share => 100 * share + "%");
    marker.style.setProperty("--light", colorOf(state.lights.find(one => one.index === index)));
    marker.classList.toggle("selected", index === light);
  }
}

function showStages(stages) {
  const longest = Math.max(...stages.map(([, milliseconds]) => milliseconds), 1e-9), body = byId("stages").tBodies[0];
  body.replaceChildren(...stages.map(([name, milliseconds]) => {
    const row = element("tr", {}, element("td", {textContent: name}), element("td", {textContent: milliseconds.toFixed(1) + " ms"}));
    row.style.setProperty("--share", 100 * milliseconds / longest + "%");
    return row;
  }));
}

// ------------------------------------------------------------------------------------------------ speed against error

const lightErrorText = () => view.options["light-error"] || "0";
const shareOf = text => text.split("/").reduce((over, under) => over / under);
let tried = {of: "", points: []};  // what light errors gave, of the view that they differ in alone

function showBound({bound, milliseconds}) {
  const text = lightErrorText(), of = JSON.stringify([{...view, options: {...view.options, "light-error": ""}}, wanted]);
  if (tried.of !== of) tried = {of, points: []};
  const largest = bound?.largest ?? 0;
  tried.points = [...tried.points.filter(point => point.text !== text), {text, largest, milliseconds}].sort((a, b) => shareOf(a.text) - shareOf(b.text));
  fillList(byId("bound"), [["Bound", largest ? `${short(largest)} at most, ${short(bound.mean)} in the mean` : "0: every light by itself"],
    ["Time", milliseconds.toFixed(1) + " ms"]]);
  plotTried(text);
}

/** Draws the largest bound, by powers of two, against milliseconds; what is exact lies at the bottom. */
function plotTried(now) {
  const {points} = tried, powers = points.filter(point => point.largest > 0).map(point => Math.log2(point.largest));
  const lowest = Math.floor(Math.min(...powers, -8)) - 1, highest = Math.ceil(Math.max(...powers, -4));
  const slowest = 1.15 * Math.max(...points.map(point => point.milliseconds));
  const x = milliseconds => 44 + 260 * milliseconds / slowest;
  const y = largest => largest > 0 ? 8 + 100 * (highest - Math.log2(largest)) / (highest - lowest) : 122;
  const marks = points.map(({text, largest, milliseconds}) => {
    const at = [x(milliseconds), y(largest)].map(place => place.toFixed(1));
    return `<circle class="${text === now ? "now" : ""}" cx="${at[0]}" cy="${at[1]}" r="${text === now ? 5 : 3.5}"/>` +
      `<text x="${at[0]}" y="${at[1] - 8}" text-anchor="middle">${largest > 0 ? "1/" + Math.round(1 / shareOf(text)) : "exact"}</text>`;
  });
  const line = points.map(({largest, milliseconds}) => `${x(milliseconds).toFixed(1)},${y(largest).toFixed(1)}`).join(" ");
  byId("plot").innerHTML = `<svg viewBox="0 0 320 152" role="img"><path d="M44 4V130H316"/><polyline class="front" fill="none" points="${line}"/>${marks.join("")}` +
    `<text x="40" y="${y(2 ** highest) + 4}" text-anchor="end">2^${highest}</text><text x="40" y="${y(2 ** lowest) + 4}" text-anchor="end">2^${lowest}</text>` +
    `<text x="40" y="126" text-anchor="end">0</text><text x="4" y="64" transform="rotate(-90 12 64)" text-anchor="middle">bound</text>` +
    `<text x="44" y="146">0</text><text x="316" y="146" text-anchor="end">${slowest.toFixed(0)} ms</text></svg>`;
  byId("plot").firstChild.ariaLabel = "Largest bound against milliseconds: " +
    points.map(({text, largest, milliseconds}) => `light error ${text}: ${short(largest)}, ${milliseconds.toFixed(0)} ms`).join("; ");
}

// ------------------------------------------------------------------------------------------------ what can be set

const defaults = {model: "phong", shading: "phong", shadows: "auto", samples: "1", exposure: "0"};
const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};

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
    const choices = name === "samples" ? ["1", "2", "4", "8", "16", "32", "64"] : state.choices[name];
    fillSelect(select, [...new Set([...choices, value])].map(choice => [choice, choice]), value);
  }
  const exposure = view.options.exposure || defaults.exposure, error = shareOf(lightErrorText());
  byId("auto").checked = exposure === "auto";
  byId("exposure").disabled = exposure === "auto";
  byId("exposure").value = Number(exposure) || 0;
  byId("stops").value = exposure === "auto" ? "" : Number(exposure).toFixed(1);
  byId("light_error").value = error > 0 ? Math.log2(error) + 15 : 0;
  byId("light_error").ariaValueText = byId("light_error_value").value = error > 0 ? "1/" + Math.round(1 / error) : "0";
}

const movedCamera = "moved";
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
  touch(name === "error");
}

/** A row with a colour and its strength, which go to a place of the scene's file together. `hex` is of color / strength. */
function addColor(body, label, path, color, hex, changed = setChange) {
  const [given, strength] = (changeOf(path) || hex + "*" + short(Math.max(1, ...color))).split("*");
  const picker = element("input", {type: "color", value: given, ariaLabel: label + ", colour"});
  const number = element("input", {type: "number", min: 0, step: 0.1, value: strength, ariaLabel: label + ", strength"});
  picker.oninput = number.oninput = () => { if (number.valueAsNumber >= 0) changed(path, picker.value + "*" + number.valueAsNumber); };
  body.append(element("tr", {}, element("th", {scope: "row", textContent: label}), element("td", {}, picker), element("td", {}, number)));
}

const pathOf = given => `lights[${given.index}]`;
const colorOf = given => changeOf(pathOf(given) + ".color") ?? given.hex;
let lightRows = [];

function showLights() {
  const lights = state.lights.map(given => ({given, name: given.name, color: colorOf(given),
    on: (changeOf(pathOf(given) + ".enabled") ?? String(given.enabled !== false)) === "true",
    factor: Number(changeOf(pathOf(given) + ".intensity") ?? given.intensity), largest: 4 * given.intensity || 4}));
  lightRows = lightTable(byId("lights").tBodies[0], lights, changeLight);
  for (const {light: {given, name}, row} of lightRows)
    row.cells[0].replaceChildren(element("button", {type: "button", textContent: name, title: name, onclick: () => selectLight(given.index)}));
  const count = state.light_count, listed = state.lights.length;
  byId("light_count").textContent = listed < count ? `${listed} of ${count}` : count;
  byId("search").hidden = listed < 12;
  if (!state.lights.some(one => one.index === light)) light = null;
  selectLight(light);
}

/** Tells the server of a light's row; colour and strength together, since the file's colour may hold the strength, too. */
function changeLight({given, on, factor, color}) {
  const path = pathOf(given), isOn = (changeOf(path + ".enabled") ?? String(given.enabled !== false)) === "true";
  if (on !== isOn) return setChange(path + ".enabled", on);
  setChange(path + ".color", color);
  setChange(path + ".intensity", factor);
}

function selectLight(index) {
  const given = state.lights.find(one => one.index === index), isOther = index !== light;
  light = index;
  for (const {light: {given: of}, row} of lightRows) row.cells[0].firstChild.ariaPressed = of.index === index;
  byId("light").hidden = !given;
  if (given) {
    fillList(byId("light").firstChild, [["Kind", given.kind], ...(given.position ? [["Position", given.position.map(short).join("  ")]] : []),
      ...(given.radius ? [["Radius", short(given.radius) + " m"]] : [])]);
    byId("casts").checked = (changeOf(pathOf(given) + ".shadow") ?? String(given.shadow)) === "true";
  }
  showMarkers(markerPlaces);
  if (isOther && layer === "shadow_map") touch();
}

function showMaterial(index) {
  material = index;
  byId("material").value = index;
  const given = state.materials.find(one => one.index === index), body = byId("material_colors"), path = `materials[${index}]`;
  body.replaceChildren();
  byId("surface_panel").hidden = !state.materials.length;
  if (!given) return;
  for (const name of ["diffuse", "specular", "emission"])
    addColor(body, name[0].toUpperCase() + name.slice(1), `${path}.${name}`, given[name], given[name + "_hex"]);
  byId("shininess").value = changeOf(path + ".shininess") ?? short(given.shininess);
}

async function pick(x, y) {
  await attempt(async () => {
    const found = await askJson("pick", {view, size: wanted, at: [x, y]}), vector = values => values.map(short).join("  ");
    Object.assign(byId("spot").style, {left: 100 * x + "%", top: 100 * y + "%"});
    byId("spot").hidden = false;
    fillList(byId("picked"), [["Pixel", found.pixel.join(", ")], ["Colour", vector(found.color)], ...(found.material === null ? [["Surface", "none: background"]] : [
      ["Object", found.object], ["Position", vector(found.position)], ["Normal", vector(found.normal)], ["Distance", short(found.distance) + " m"]])]);
    byId("surface_panel").open = true;
    if (found.material !== null) showMaterial(found.material);
  });
}

function showAir() {
  byId("air_colors").replaceChildren();
  addColor(byId("air_colors"), "Ambient", "ambient", state.ambient, state.ambient_hex);
  addColor(byId("air_colors"), "Background", "background", state.background, state.background_hex);
  const given = state.fog || {mode: "", density: 0, color: [0.5, 0.5, 0.5], hex: "#bcbcbc"}, changed = changeOf("fog");
  const fog = changed ? JSON.parse(changed) : given, isOff = fog.mode !== "linear" && !JSON.stringify(fog.density).match(/[1-9]/);
  byId("fog_mode").value = isOff ? "" : fog.mode;
  byId("fog_density").value = isOff ? 0.05 : JSON.stringify(fog.density ?? 0.05);
  byId("fog_start").value = fog.start ?? 0;
  byId("fog_end").value = fog.end ?? 100;
  byId("fog_colors").replaceChildren();
  addColor(byId("fog_colors"), "Colour", "fog.color", given.color, given.hex, (path, value) => setFog(value));
  showFogParts();
}

function showFogParts() {
  const mode = byId("fog_mode").value;
  byId("fog").hidden = !mode;
  for (const [id, isUsed] of [["fog_density", mode !== "linear"], ["fog_start", mode === "linear"], ["fog_end", mode === "linear"]])
    byId(id).parentElement.hidden = !isUsed;
}

/** Sets all of the fog, since a fog that only half changed may be none. Waits for numbers where there are none yet. */
function setFog(color) {
  const mode = byId("fog_mode").value, [picker, strength] = byId("fog_colors").querySelectorAll("input");
  showFogParts();
  try {
    const density = JSON.parse(byId("fog_density").value), start = byId("fog_start").valueAsNumber, end = byId("fog_end").valueAsNumber;
    if (mode === "linear" && !(end > start)) return;
    setChange("fog", JSON.stringify(mode === "linear" ? {mode, start, end} : {mode: mode || "exp2", density: mode ? density : 0}));
    setChange("fog.color", color ?? picker.value + "*" + strength.value);
  } catch (fault) { if (!(fault instanceof SyntaxError)) throw fault; }
}

// ------------------------------------------------------------------------------------------------ shaders

const shaderKinds = ["model", "surface", "screen"];
const editors = Object.fromEntries(shaderKinds.map(kind => [kind, {text: "", isUsed: false, fault: null}]));
let kindShown = "model", typing = 0, tabLeaves = false;

const textInUse = kind => editors[kind].isUsed ? editors[kind].text : "";

function showEditor() {
  const editor = editors[kindShown], examples = Object.keys(state.examples?.[kindShown] || {});
  byId("text").value = editor.text;
  byId("in_use").checked = editor.isUsed;
  fillSelect(byId("examples"), [["", "Examples …"], ...examples.map(name => [name, name])], "");
  byId("check").hidden = kindShown !== "model";
  byId("figures").hidden = true;
  numberLines();
  showShaderFaults();
}

const numberLines = () => {
  byId("numbers").textContent = Array.from({length: byId("text").value.split("\n").length}, (unused, i) => i + 1).join("\n") + "\n\n";
  byId("numbers").scrollTop = byId("text").scrollTop;
};

function showShaderFaults() {
  for (const radio of byId("kinds").querySelectorAll("input")) radio.classList.toggle("faulty", editors[radio.value].fault !== null);
  const {fault} = editors[kindShown];
  byId("editor").style.setProperty("--bad", fault ? fault.line - 1 : -9);
  byId("shader_fault").textContent = fault ? fault.message : "";
}

/** Has the picture made with the editors' texts. */
function useShaders() {
  clearTimeout(typing);
  view.shaders = Object.fromEntries(shaderKinds.map(kind => [kind, textInUse(kind)]));
  touch(true);
}

function changeText() {
  const editor = editors[kindShown];
  Object.assign(editor, {text: byId("text").value, isUsed: true});
  byId("in_use").checked = true;
  numberLines();
  clearTimeout(typing);
  typing = setTimeout(useShaders, 250);
}

// ------------------------------------------------------------------------------------------------ the page of a scene

function restore() {
  const kept = JSON.parse(sessionStorage.getItem(storageKey) || "null");
  view = kept?.view ?? {camera: null, changes: [], options: {...state.options}, shaders: {}};
  layer = kept?.layer ?? "color";
  for (const kind of shaderKinds) {
    const given = state.shaders[kind] || "", example = Object.values(state.examples?.[kind] || {})[0] || "";
    editors[kind] = kept?.editors[kind] ?? {text: given || example, isUsed: given !== "", fault: null};
  }
  view.shaders = Object.fromEntries(shaderKinds.map(kind => [kind, textInUse(kind)]));
}

/** Shows what the server told: at first, after the scene was read again, and when the server has come back. */
function showScene(isFirst) {
  if (isFirst) {
    restore();
    listen();
  }
  document.title = "Luciole: " + state.name;
  byId("name").textContent = state.name;
  fillSelect(byId("camera"), [["", "as it was"], ...state.cameras.map((name, i) => [i, name]), [movedCamera, "moved"]], "");
  fillSelect(byId("material"), state.materials.map(given => [given.index, given.name]), material);
  showOptions();
  showCamera();
  showLights();
  showMaterial(state.materials.some(given => given.index === material) ? material : state.materials[0]?.index);
  showAir();
  showEditor();
  layOut();
  touch(true);
}

const walks = {KeyW: [0, 0, 1], KeyS: [0, 0, -1], KeyA: [-1, 0, 0], KeyD: [1, 0, 0], KeyQ: [0, -1, 0], KeyE: [0, 1, 0]};

/** The gesture that a second of a held key makes, [kind, amounts], or null. */
function heldGesture(event) {
  const arrow = arrows[event.key];
  if (arrow && !event.shiftKey && !event.altKey && !event.ctrlKey) return ["walk", [arrow[0], 0, -arrow[1]]];
  if (arrow) return [event.shiftKey ? "orbit" : event.altKey ? "turn" : "pan", arrow.map(step => 0.6 * step)];
  if (event.ctrlKey || event.metaKey || event.altKey) return null;
  if (walks[event.code]) return ["walk", walks[event.code]];
  return "+=-".includes(event.key) ? ["dolly", [event.key === "-" ? -8 : 8]] : null;
}

function pressKey(event) {
  const seconds = heldGesture(event);
  if (seconds) {
    if (!held.size) heldSince = performance.now() - 40;
    held.set(event.code, seconds);
    if (!event.repeat) touch();
    return true;
  }
  if (event.ctrlKey || event.metaKey || event.altKey) return false;
  if (/^[0-9]$/.test(event.key)) setLayer(layers[(Number(event.key) + 9) % 10][0]);
  else if (event.key === "Home") setCamera(null);
  else if (event.key === "m" || event.key === "M") byId("all_markers").click();
  else if (event.key === "Enter" && event.target === frame) pick(0.5, 0.5);
  else return false;
  return true;
}

/** Connects the scene's controls, once. */
function listen() {
  const on = (id, type, action) => byId(id).addEventListener(type, event => action(event.target, event));
  followPointers({
    moved(dx, dy, event, press) {
      const kind = press.button > 0 || press.shiftKey ? "pan" : press.altKey ? "turn" : "orbit";
      byId("spot").hidden = true;
      gesture(kind, dx / frame.clientHeight, dy / frame.clientHeight);
    },
    pinched(ratio, dx, dy) {
      addGesture("pan", [dx / frame.clientHeight, dy / frame.clientHeight]);
      gesture("dolly", 5 * Math.log2(ratio));
    },
    clicked: pick,
  });
  frame.addEventListener("wheel", event => {
    event.preventDefault();
    byId("spot").hidden = true;
    gesture("dolly", notchesOf(event));
  }, {passive: false});
  followKeys(pressKey);
  addEventListener("keyup", event => held.delete(event.code));
  addEventListener("blur", () => held.clear());
  new ResizeObserver(layOut).observe(stage);
  addEventListener("pagehide", () => sessionStorage.setItem(storageKey, JSON.stringify({view, layer, editors})));

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
  for (const id of ["fog_mode", "fog_density", "fog_start", "fog_end"]) on(id, "input", () => setFog());

  on("kinds", "change", ({value}) => { kindShown = value; showEditor(); });
  on("text", "input", changeText);
  on("text", "scroll", ({scrollTop}) => { byId("numbers").scrollTop = scrollTop; });
  on("text", "keydown", (text, event) => {
    if (event.key === "Tab" && !event.shiftKey && !tabLeaves) {
      event.preventDefault();
      document.execCommand("insertText", false, "  ");  // As typing does, so that it can be undone.
    }
    if (event.key !== "Shift") tabLeaves = event.key === "Escape";
  });
  on("in_use", "change", ({checked}) => { editors[kindShown].isUsed = checked; useShaders(); });
  on("examples", "change", ({value}) => {
    if (!value) return;
    byId("text").value = state.examples[kindShown][value];
    changeText();
    useShaders();
  });
  on("check", "click", button => attempt(async () => {
    button.disabled = true;
    try {
      const shaders = {...view.shaders, model: editors.model.text};
      byId("figures").textContent = (await askJson("check", {view: {...view, shaders}})).lines.join("\n");
      byId("figures").hidden = false;
    } finally { button.disabled = false; }
  }));
  on("save", "click", button => attempt(async () => {
    const what = [...document.querySelectorAll("[name='what']:checked")].map(({value}) => value);
    button.disabled = true;
    byId("saved").textContent = "Saving …";
    try {
      const {files, command} = await askJson("save", {view, size: state.size, what});
      byId("saved").textContent = "Written: " + files.join(", ");
      byId("saved_command").hidden = false;
      byId("saved_command").firstChild.textContent = command;
    } catch (fault) {
      byId("saved").textContent = "";
      throw fault;
    } finally { button.disabled = false; }
  }));
  addCopy(byId("saved_command").lastElementChild, byId("saved_command").firstElementChild);
}

if (matchMedia("(max-width: 52rem)").matches) for (const panel of document.querySelectorAll("details")) panel.open = false;
byId("show_help").addEventListener("click", () => byId("help").showModal());
tick().then(poll);  // When files.js has been read, too.
