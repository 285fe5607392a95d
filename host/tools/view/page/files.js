// ------------------------------------------------------------------------------------------------ EXR files

// What is shown: a and b are {file, layer}; the middle of a pane shows the point (x, y) of the files, in pixels, and each of
// their pixels takes `scale` pixels of the screen; 0: as fits.
const shown = {mode: "one", a: {file: 0, layer: ""}, b: {file: 0, layer: ""}, exposure: 0, split: 0.5, scale: 0, x: 0, y: 0, pixel: null};
const pictures = {a: null, b: null};  // the last answers
let groups = [], isAsking = false, isStale = false, isPicking = false, nextPick = null;

const isBoth = () => shown.mode === "side" || shown.mode === "slider";
const sizeOfA = () => pictures.a?.size ?? state.files[shown.a.file].size;
const paneWidth = () => canvas.width / (shown.mode === "side" ? 2 : 1);
const fittingScale = () => Math.min(paneWidth() / sizeOfA()[0], canvas.height / sizeOfA()[1]);
const scaleNow = () => shown.scale || fittingScale();
const density = () => canvas.width / frame.clientWidth;

/** Draws one picture from `left` to `right`, with its point (x, y) at `middle`. */
function paintOne(picture, middle, left, right) {
  if (!picture) return;
  const scale = scaleNow(), {bitmap, size: [w, h], scale: enlarged} = picture;
  context.save();
  context.beginPath();
  context.rect(left, 0, right - left, canvas.height);
  context.clip();
  context.imageSmoothingEnabled = scale < 1;
  context.translate(Math.round(middle - shown.x * scale), Math.round(canvas.height / 2 - shown.y * scale));
  context.scale(scale, scale);
  context.drawImage(bitmap, 0, 0, enlarged * w, enlarged * h, 0, 0, w, h);
  context.strokeStyle = "#ffc83d";
  context.lineWidth = 2 / scale;
  if (shown.pixel && scale > 4) context.strokeRect(...shown.pixel, 1, 1);
  context.restore();
}

function paint() {
  const all = canvas.width, half = all / 2, cut = shown.mode === "side" ? half : shown.mode === "slider" ? Math.round(shown.split * all) : all;
  context.clearRect(0, 0, all, canvas.height);
  paintOne(pictures.a, shown.mode === "side" ? half / 2 : half, 0, cut);
  readOut([[sizeOfA().join(" × "), "pixels"], [(100 * scaleNow()).toFixed(0), "%"]]);
  if (!isBoth()) return;
  paintOne(pictures.b, shown.mode === "side" ? 1.5 * half : half, cut, all);
  context.fillStyle = "#ffc83d";
  context.fillRect(cut - 1, 0, 2, canvas.height);
}

/** Asks for what is shown, once at a time, and anew where it has changed meanwhile. */
async function askFiles() {
  isStale = true;
  if (isAsking) return;
  isAsking = true;
  while (isStale) {
    isStale = false;
    await attempt(async () => {
      const changed = groups.filter(group => !isAsRendered(group)), isDifference = shown.mode === "difference";
      const mix = changed.length ? Object.fromEntries(changed.map(group => [group.name, [group.on ? group.factor : 0, group.color]])) : null;
      const body = {other: isDifference ? shown.b : null, mode: isDifference ? "difference" : "one", exposure: shown.exposure, size: null};
      const answers = [await askPicture({...shown.a, ...body, mix}), ...(isBoth() ? [await askPicture({...shown.b, ...body, mix: null})] : [])];
      for (const answer of answers) answer.bitmap = await answer.decoded;
      [pictures.a, pictures.b] = answers;
      showLegend(pictures.a.bitmap, Math.min(pictures.a.scale * pictures.a.size[1], pictures.a.bitmap.height));
      byId("notes").textContent = [...new Set(answers.flatMap(({notes}) => notes))].join(" · ");
      say("warnings", answers.flatMap(({warnings}) => warnings).join("; "));
      if (shown.pixel) showValues(shown.pixel); else paint();
    });
  }
  isAsking = false;
}

/** Shows the numbers of a pixel of A, and of B where both are shown. */
async function showValues(pixel) {
  shown.pixel = pixel.map((at, i) => within(at, 0, sizeOfA()[i] - 1));
  nextPick = shown.pixel;
  paint();
  if (isPicking) return;
  isPicking = true;
  while (nextPick) {
    const at = nextPick.map((place, i) => (place + 0.5) / sizeOfA()[i]), sides = shown.mode === "one" ? ["a"] : ["a", "b"];
    nextPick = null;
    await attempt(async () => {
      const answers = await Promise.all(sides.map(side => askJson("pick", {...shown[side], at})));
      const names = [...new Set(answers.flatMap(({values}) => values.map(([name]) => name)))];
      const valueOf = ({values}, name) => values.find(([of]) => of === name)?.[1] ?? "–";
      const row = (...texts) => element("tr", {}, ...texts.map(textContent => element("td", {textContent})));
      byId("values").replaceChildren(row(answers[0].pixel.join(", "), ...sides.map(side => side.toUpperCase())), ...names.map(name =>
        row(name, ...answers.map(answer => { const value = valueOf(answer, name); return value.toPrecision ? Number(value.toPrecision(6)) : value; }))));
    });
  }
  isPicking = false;
}

/** A place of the screen in pixels from its pane's middle. */
function fromMiddle({clientX, clientY}) {
  const box = frame.getBoundingClientRect();
  return [(clientX - box.x) * density() % paneWidth() - paneWidth() / 2, (clientY - box.y) * density() - canvas.height / 2];
}

function pixelAt(event) {
  const [x, y] = fromMiddle(event);
  return [Math.floor(shown.x + x / scaleNow()), Math.floor(shown.y + y / scaleNow())];
}

function move(dx, dy) {
  shown.x -= dx * density() / scaleNow();
  shown.y -= dy * density() / scaleNow();
  paint();
}

/** Zooms by a factor, about a place in pixels from the pane's middle. */
function zoom(factor, dx = 0, dy = 0) {
  const old = scaleNow();
  shown.scale = within(old * factor, Math.min(fittingScale(), 0.05), 64);
  shown.x += dx / old - dx / shown.scale;
  shown.y += dy / old - dy / shown.scale;
  paint();
}

function fit(scale) {
  [shown.x, shown.y] = sizeOfA().map(side => side / 2);
  shown.scale = scale;
  paint();
}

function layOutFiles() {
  [frame.style.width, frame.style.height] = ["100%", "100%"];
  [canvas.width, canvas.height] = [stage.clientWidth, stage.clientHeight].map(side => Math.round(side * devicePixelRatio));
  paint();
}

/** Shows what is chosen, and asks for it. */
function changeFiles() {
  for (const side of ["a", "b"]) {
    const of = shown[side], names = state.files[of.file].layers.map(({name}) => name);
    if (!names.includes(of.layer)) of.layer = names[0];
    fillSelect(byId("file_" + side), state.files.map(({name}, i) => [i, name]), of.file);
    fillSelect(byId("layer_" + side), names.map(name => [name, name || "picture"]), of.layer);
    byId("file_" + side).hidden = state.files.length < 2;
  }
  byId("pair_b").hidden = shown.mode === "one";
  byId("split_label").hidden = shown.mode !== "slider";
  byId("file_exposure").value = shown.exposure;
  byId("file_stops").value = shown.exposure.toFixed(1);
  byId("groups_panel").hidden = !groups.length;
  byId("mix_command").textContent = mixCommand(state.files[shown.a.file].name, groups, shown.exposure);
  askFiles();
}

function showGroups() {
  groups = state.files[shown.a.file].groups.map(name => ({name, on: true, factor: 1, color: "#ffffff", largest: 4}));
  lightTable(byId("groups"), groups, () => {
    shown.a = {...shown.a, layer: "color"};
    changeFiles();
  });
}

function showFiles(isFirst) {
  byId("reset").hidden = true;
  byId("name").textContent = state.files.map(({name}) => name).join(" | ");
  document.title = "Luciole: " + byId("name").textContent;
  shown.b.file = Math.min(isFirst ? 1 : shown.b.file, state.files.length - 1);
  showGroups();
  changeFiles();
  if (!isFirst) return;
  frame.ariaLabel = "The picture: drag to move it, wheel to zoom; a question mark tells the keys";
  layOutFiles();
  fit(0);
  listenFiles();
}

function pressFilesKey({key, code, shiftKey, ctrlKey, metaKey, altKey, target}) {
  if (ctrlKey || metaKey || altKey) return false;
  const arrow = arrows[key], walk = walks[code], step = shiftKey ? 10 : 1;
  if (arrow) showValues((shown.pixel || [Math.floor(shown.x), Math.floor(shown.y)]).map((at, i) => at + step * arrow[i]));
  else if (walk?.[1] === 0) move(-40 * walk[0], 40 * walk[2]);
  else if ("+=-".includes(key)) zoom(key === "-" ? 1 / 1.25 : 1.25);
  else if (key === "0" || key === "1") fit(Number(key));
  else if (key === "[" || key === "]") setExposure(shown.exposure + (key === "[" ? -0.5 : 0.5));
  else if (key === " " && target === frame) {
    [shown.a, shown.b] = [shown.b, shown.a];
    showGroups();
    changeFiles();
  } else return false;
  return true;
}

function setExposure(stops) {
  shown.exposure = within(stops, -8, 8);
  changeFiles();
}

function setSplit(share) {
  byId("split").value = shown.split = within(share, 0, 1);
  paint();
}

function listenFiles() {
  const shareAt = event => (event.clientX - frame.getBoundingClientRect().x) / frame.clientWidth;
  let isDividing = false;
  followPointers({
    moved: (dx, dy, event) => isDividing ? setSplit(shareAt(event)) : move(dx, dy),
    pinched(ratio, dx, dy, event) {
      move(dx, dy);
      zoom(ratio, ...fromMiddle(event));
    },
    clicked() {},
  });
  frame.addEventListener("pointerdown", event => {
    isDividing = shown.mode === "slider" && Math.abs(shareAt(event) - shown.split) * frame.clientWidth < 12;
    showValues(pixelAt(event));
  });
  frame.addEventListener("pointermove", event => { if (!event.buttons) showValues(pixelAt(event)); });
  followWheel((notches, event) => zoom(1.25 ** notches, ...fromMiddle(event)));
  followKeys(pressFilesKey);
  new ResizeObserver(layOutFiles).observe(stage);
  on("modes", "change", ({value}) => {
    shown.mode = value;
    changeFiles();
  });
  on("split", "input", ({valueAsNumber}) => setSplit(valueAsNumber));
  on("fit", "click", () => fit(0));
  on("one_to_one", "click", () => fit(1));
  on("file_exposure", "input", ({valueAsNumber}) => setExposure(valueAsNumber));
  for (const side of ["a", "b"]) {
    on("file_" + side, "change", ({value}) => {
      shown[side] = {...shown[side], file: Number(value)};
      showGroups();
      changeFiles();
    });
    on("layer_" + side, "change", ({value}) => {
      shown[side] = {...shown[side], layer: value};
      changeFiles();
    });
  }
}
