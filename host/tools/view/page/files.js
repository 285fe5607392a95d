// ------------------------------------------------------------------------------------------------ EXR files

// What is shown: a and b are {file, layer}; the middle of a pane shows the point (x, y) of the files, in pixels, and each of
// their pixels takes `scale` pixels of the screen; 0: as fits.
const shown = {mode: "one", a: {file: 0, layer: ""}, b: {file: 0, layer: ""}, exposure: 0, split: 0.5, scale: 0, x: 0, y: 0, pixel: null};
const bitmaps = {a: null, b: null};
let mix = [], isAsking = false, isStale = false, isPicking = false, nextPick = null;

const isBoth = () => shown.mode === "side" || shown.mode === "slider";
const sizeOf = of => state.files[of.file].size;
const paneWidth = () => canvas.width / (shown.mode === "side" ? 2 : 1);
const fittingScale = () => Math.min(paneWidth() / sizeOf(shown.a)[0], canvas.height / sizeOf(shown.a)[1]);
const scaleNow = () => shown.scale || fittingScale();

function paint() {
  const scale = scaleNow(), width = paneWidth(), height = canvas.height;
  const paintOne = (bitmap, middle, left, right) => {
    if (!bitmap) return;
    context.save();
    context.beginPath();
    context.rect(left, 0, right - left, height);
    context.clip();
    context.imageSmoothingEnabled = scale < 1;
    context.translate(Math.round(middle - shown.x * scale), Math.round(height / 2 - shown.y * scale));
    context.scale(scale, scale);
    context.drawImage(bitmap, 0, 0);
    if (shown.pixel && scale > 4) {
      context.strokeStyle = "#ffc83d";
      context.lineWidth = 2 / scale;
      context.strokeRect(...shown.pixel, 1, 1);
    }
    context.restore();
  };
  const cut = Math.round(shown.split * canvas.width);
  context.clearRect(0, 0, canvas.width, height);
  paintOne(bitmaps.a, width / 2, 0, shown.mode === "side" ? width : shown.mode === "slider" ? cut : canvas.width);
  if (shown.mode === "side") paintOne(bitmaps.b, 1.5 * width, width, canvas.width);
  if (shown.mode === "slider") paintOne(bitmaps.b, width / 2, cut, canvas.width);
  if (!isBoth()) return;
  context.fillStyle = "#ffc83d";
  context.fillRect((shown.mode === "side" ? width : cut) - 1, 0, 2, height);
}

/** Asks for what is shown, once at a time, and anew where it has changed meanwhile. */
async function askFiles() {
  isStale = true;
  if (isAsking) return;
  isAsking = true;
  while (isStale) {
    isStale = false;
    await attempt(async () => {
      const changed = mix.filter(group => !isAsRendered(group));
      const weights = changed.length ? Object.fromEntries(changed.map(({name, on, factor, color}) => [name, [on ? factor : 0, color]])) : null;
      const body = of => ({...of, other: shown.mode === "difference" ? shown.b : null, mode: shown.mode === "difference" ? "difference" : "one",
        exposure: shown.exposure, mix: of === shown.a ? weights : null, size: null});
      const a = await askPicture(body(shown.a)), b = isBoth() ? await askPicture(body(shown.b)) : null;
      [bitmaps.a, bitmaps.b] = [a.bitmap, b?.bitmap];
      readout([[sizeOf(shown.a).join(" × "), "pixels"], [(100 * scaleNow()).toFixed(0) + " %", ""]]);
      byId("notes").textContent = [...a.notes || [], ...b?.notes || []].join(" · ");
      say("warnings", [...a.warnings || [], ...b?.warnings || []].join("; "));
      paint();
    });
  }
  isAsking = false;
}

/** Shows the numbers of a pixel of A, and of B where both are shown. */
async function showValues(pixel) {
  const [w, h] = sizeOf(shown.a);
  shown.pixel = [Math.min(Math.max(pixel[0], 0), w - 1), Math.min(Math.max(pixel[1], 0), h - 1)];
  paint();
  nextPick = shown.pixel;
  if (isPicking) return;
  isPicking = true;
  while (nextPick) {
    const [x, y] = nextPick, sides = shown.mode === "one" ? [shown.a] : [shown.a, shown.b];
    nextPick = null;
    await attempt(async () => {
      const answers = await Promise.all(sides.map(of => askJson("pick", {...of, at: [(x + 0.5) / w, (y + 0.5) / h]})));
      const names = [...new Set(answers.flatMap(({values}) => values.map(([name]) => name)))];
      const cells = texts => texts.map(text => element("td", {textContent: text}));
      byId("values").tBodies[0].replaceChildren(
        element("tr", {className: "muted"}, ...cells([answers[0].pixel.join(", "), ...(sides.length > 1 ? ["A", "B"] : [""])])),
        ...names.map(name => element("tr", {}, ...cells([name, ...answers.map(({values}) => {
          const value = values.find(([of]) => of === name)?.[1];
          return typeof value === "number" ? String(Number(value.toPrecision(6))) : value ?? "–";
        })]))));
    });
  }
  isPicking = false;
}

/** The pixel of A, or of B in its own pane, at a place of the screen. */
function pixelAt(clientX, clientY) {
  const box = frame.getBoundingClientRect(), dense = canvas.width / box.width, scale = scaleNow();
  const x = (clientX - box.x) * dense % paneWidth(), y = (clientY - box.y) * dense;
  return [Math.floor(shown.x + (x - paneWidth() / 2) / scale), Math.floor(shown.y + (y - canvas.height / 2) / scale)];
}

/** Zooms by a factor, about a place of the screen in pixels from the pane's middle. */
function zoom(factor, dx = 0, dy = 0) {
  const old = scaleNow();
  shown.scale = Math.min(Math.max(old * factor, Math.min(fittingScale(), 0.05)), 64);
  shown.x += dx / old - dx / shown.scale;
  shown.y += dy / old - dy / shown.scale;
  showZoom();
}

function fit(scale) {
  [shown.x, shown.y] = sizeOf(shown.a).map(side => side / 2);
  shown.scale = scale;
  showZoom();
}

function showZoom() {
  readout([[sizeOf(shown.a).join(" × "), "pixels"], [(100 * scaleNow()).toFixed(0) + " %", ""]]);
  paint();
}

function layOutFiles() {
  [frame.style.width, frame.style.height] = ["100%", "100%"];
  canvas.width = stage.clientWidth * devicePixelRatio;
  canvas.height = stage.clientHeight * devicePixelRatio;
  paint();
}

function showChoices() {
  const isTwo = state.files.length > 1;
  for (const side of ["a", "b"]) {
    const of = shown[side], names = state.files[of.file].layers.map(({name}) => name);
    if (!names.includes(of.layer)) of.layer = names[0];
    fillSelect(byId("file_" + side), state.files.map(({name}, i) => [i, name]), of.file);
    fillSelect(byId("layer_" + side), names.map(name => [name, name || "picture"]), of.layer);
    byId("file_" + side).hidden = !isTwo;
  }
  document.querySelector(`[name="mode"][value="${shown.mode}"]`).checked = true;
  byId("layer_b").closest(".pair").hidden = shown.mode === "one";
  byId("split_label").hidden = shown.mode !== "slider";
  byId("file_stops").value = shown.exposure.toFixed(1);
  byId("file_exposure").value = shown.exposure;
  const {name, groups} = state.files[shown.a.file];
  byId("groups_panel").hidden = !groups.length;
  byId("mix_command").textContent = mixCommand(name, mix, shown.exposure);
}

function showGroups() {
  mix = state.files[shown.a.file].groups.map(name => ({name, on: true, factor: 1, color: "#ffffff", largest: 4}));
  lightTable(byId("groups"), mix, changeFiles);
}

function changeFiles() {
  showChoices();
  askFiles();
}

function showFiles(isFirst) {
  if (isFirst) {
    shown.b.file = state.files.length - 1;
    listenFiles();
  }
  byId("reset").hidden = true;
  byId("name").textContent = state.files.map(({name}) => name).join(" | ");
  document.title = "Luciole: " + byId("name").textContent;
  showGroups();
  changeFiles();
  layOutFiles();
  if (isFirst) fit(0);
}

function pressFilesKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return false;
  const arrow = arrows[event.key], walk = walks[event.code], step = event.shiftKey ? 10 : 1;
  if (arrow) showValues((shown.pixel || [Math.floor(shown.x), Math.floor(shown.y)]).map((at, i) => at + step * arrow[i]));
  else if (walk?.[1] === 0) {
    shown.x += 40 * walk[0] / scaleNow();
    shown.y -= 40 * walk[2] / scaleNow();
    paint();
  } else if ("+=-".includes(event.key)) zoom(event.key === "-" ? 1 / 1.25 : 1.25);
  else if (event.key === "0") fit(0);
  else if (event.key === "1") fit(1);
  else if (event.key === "[" || event.key === "]") setExposure(shown.exposure + (event.key === "[" ? -0.5 : 0.5));
  else if (event.key === " " && event.target === frame) {
    [shown.a, shown.b] = [shown.b, shown.a];
    showGroups();
    changeFiles();
  } else return false;
  return true;
}

function setExposure(stops) {
  shown.exposure = stops;
  changeFiles();
}

function listenFiles() {
  const on = (id, type, action) => byId(id).addEventListener(type, event => action(event.target, event));
  const dense = () => canvas.width / frame.clientWidth;
  const move = (dx, dy) => {
    shown.x -= dx * dense() / scaleNow();
    shown.y -= dy * dense() / scaleNow();
  };
  const fromMiddle = (x, y) => {
    const box = frame.getBoundingClientRect();
    return [(x - box.x) * dense() % paneWidth() - paneWidth() / 2, (y - box.y) * dense() - canvas.height / 2];
  };
  followPointers({
    moved(dx, dy, event, press) {
      const box = frame.getBoundingClientRect();
      if (shown.mode === "slider" && Math.abs(press.clientX - box.x - shown.split * box.width) < 12 + Math.abs(event.clientX - press.clientX))
        byId("split").value = shown.split = Math.min(Math.max((event.clientX - box.x) / box.width, 0), 1);
      else move(dx, dy);
      paint();
    },
    pinched(ratio, dx, dy, x, y) {
      move(dx, dy);
      zoom(ratio, ...fromMiddle(x, y));
    },
    clicked: () => frame.focus(),
  });
  frame.addEventListener("pointermove", event => { if (!event.buttons) showValues(pixelAt(event.clientX, event.clientY)); });
  frame.addEventListener("pointerdown", event => showValues(pixelAt(event.clientX, event.clientY)));
  frame.addEventListener("wheel", event => {
    event.preventDefault();
    zoom(1.25 ** notchesOf(event), ...fromMiddle(event.clientX, event.clientY));
  }, {passive: false});
  followKeys(pressFilesKey);
  new ResizeObserver(layOutFiles).observe(stage);
  for (const radio of document.querySelectorAll("[name='mode']"))
    radio.addEventListener("change", () => { shown.mode = radio.value; changeFiles(); showZoom(); });
  on("split", "input", ({valueAsNumber}) => { shown.split = valueAsNumber; paint(); });
  on("fit", "click", () => fit(0));
  on("one_to_one", "click", () => fit(1));
  on("file_exposure", "input", ({valueAsNumber}) => setExposure(valueAsNumber));
  for (const side of ["a", "b"]) {
    on("file_" + side, "change", ({value}) => { shown[side].file = Number(value); if (side === "a") showGroups(); changeFiles(); });
    on("layer_" + side, "change", ({value}) => { shown[side].layer = value; changeFiles(); });
  }
  addCopy(byId("copy_mix"), byId("mix_command"));
}
