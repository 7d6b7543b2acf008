// The page of `stromboli view` and `render --watch`. It holds one request open for the next frame, and draws what comes;
// what it is to show of radiance (exposure, view) it works out here, from half floats.
const settings = JSON.parse(document.getElementById("settings").textContent);
const at = (id) => document.getElementById(id);
const canvas = at("canvas"), context = canvas.getContext("2d", { willReadFrequently: true });

const page = {
  shown: settings.denoised ? "denoised" : "picture",
  view: settings.view,
  exposure: Number(settings.exposure) || 0,
  metered: settings.exposure === "auto",
  frame: null, // what the last frame says of itself
  halves: null,
  reference: null, // a frame to compare with
  compared: "split",
  divider: 0.5, // its place, of the picture's width
  sun: null, // azimuth and elevation, likewise
  pose: null, // what this page has steered to, or what the frame says
  drawn: 0, // frames
  reconnects: 0,
};

// --- Requests --------------------------------------------------------------------------------------------------------

function ask(path, parameters, options = {}) {
  const query = new URLSearchParams(parameters).toString();
  return fetch(`${path}?${query}`, { ...options, headers: { "X-Stromboli-Token": settings.token } });
}

let following = null; // to give up the request for the next frame
async function follow() {
  let after = 0, shown = page.shown, patience = 250;
  for (;;) {
    if (shown !== page.shown) shown = page.shown, after = 0;
    following = new AbortController();
    try {
      const response = await ask("/frame", { shown, after }, { signal: following.signal });
      if (response.status === 403) return location.reload(); // another server has taken the place of ours
      if (response.status === 410) throw new Error("the render has ended");
      if (response.status === 503) throw new Error("too many pages are looking");
      if (response.status === 200) {
        const frame = decode(await response.arrayBuffer());
        after = frame.text.number;
        if (frame.text.shown === page.shown) take(frame);
      }
      patience = 250;
    } catch (error) {
      if (shown !== page.shown) continue; // given up for another layer
      say(`no connection: ${error.message}`);
      await new Promise((resolve) => setTimeout(resolve, patience));
      patience = Math.min(2 * patience, 4000);
      after = 0;
      ++page.reconnects;
    }
  }
}

function decode(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const text = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  return { text, halves: new Uint16Array(buffer, 4 + length) };
}

// Sends what is wanted last, one request after the other.
let wanted = null, sending = false;
async function steer(parameters) {
  wanted = { ...wanted, ...parameters };
  if (sending) return;
  sending = true;
  while (wanted) {
    const now = wanted;
    wanted = null;
    try {
      const response = await ask("/steer", now, { method: "POST" });
      if (!response.ok) say(await response.text());
    } catch (error) {
      say(`no connection: ${error.message}`);
    }
  }
  sending = false;
}

// --- Drawing ---------------------------------------------------------------------------------------------------------

const say = (text) => { at("notice").textContent = text; };
const isRadiance = () => page.shown === "picture" || page.shown === "denoised";
const exposureNow = () => (page.metered && page.frame ? page.frame.exposureAuto ?? page.exposure : page.exposure);

function take(frame) {
  page.frame = frame.text;
  page.halves = frame.halves;
  if (!dragging && !wanted && !sending) page.pose = frame.text.pose;
  draw();
  ++page.drawn;
  describe();
}

function draw() {
  const frame = page.frame;
  if (!frame) return;
  if (canvas.width !== frame.width || canvas.height !== frame.height)
    canvas.width = frame.width, canvas.height = frame.height;
  const image = context.createImageData(frame.width, frame.height);
  let scale = "";
  const other = page.reference;
  if (isDifference()) developDifference(page.halves, frame.exponent, other.halves, other.text.exponent, exposureNow(), image.data);
  else if (isRadiance()) developRadiance(page.halves, frame.exponent, page.view, exposureNow(), image.data);
  else scale = developLayer(page.shown, page.halves, frame.exponent, image.data);
  context.putImageData(image, 0, 0);
  drawReference();
  fit();
  say(frame.state === "loading" ? "loading" : frame.problem || scale);
}

// As large as there is room, in the shape of the picture.
function fit() {
  const frame = page.frame, stage = at("stage");
  if (!frame) return;
  const size = Math.min(stage.clientWidth / frame.fullWidth, stage.clientHeight / frame.fullHeight);
  canvas.style.width = `${frame.fullWidth * size}px`;
  canvas.style.height = `${frame.fullHeight * size}px`;
  canvas.classList.toggle("sharp", !frame.coarse && size >= 2);
  at("other").classList.toggle("sharp", size >= 2);
  for (const over of [at("other"), at("divider")]) {
    over.style.top = `${canvas.offsetTop}px`, over.style.height = canvas.style.height;
    over.style.left = `${canvas.offsetLeft + (over.id === "divider" ? page.divider * frame.fullWidth * size : 0)}px`;
  }
  at("other").style.width = canvas.style.width;
}
window.addEventListener("resize", fit);

// --- What is said --------------------------------------------------------------------------------------------------------

const percent = (share) => `${Number((100 * share).toPrecision(2))} %`;
function describe() {
  const f = page.frame, noise = f.denoisedNoise ?? f.noise;
  at("scene").textContent = f.scene;
  document.title = `${f.state === "done" ? "" : `${Math.round(100 * f.share)} % `}${f.scene} – Stromboli`;
  at("bar").style.width = `${100 * f.share}%`;
  at("status").textContent = [
    `${f.state}, ${f.fullWidth} x ${f.fullHeight}${f.coarse ? `, coarse (${f.width} x ${f.height})` : ""}`,
    `${Number(f.samples.toPrecision(3))} samples a pixel, at most ${f.mostSamples}`,
    noise ? `noise about ${percent(noise.estimate)} (${percent(noise.least)} to ${percent(noise.most)})`
      : "noise not known yet",
    `${Number((f.raysPerSecond / 1e6).toPrecision(3))} million rays/s, ${f.seconds.toFixed(1)} s`,
    f.device,
    ...(f.biased ? ["biased: --clamp-indirect removes light"] : []),
  ].join("\n");
  if (at("camera").options.length !== f.cameras.length + 1) {
    at("camera").replaceChildren(new Option("(choose)", ""), ...f.cameras.map((name, i) => new Option(name, i)));
    at("camera").parentElement.hidden = f.cameras.length === 0;
  }
  at("pause").setAttribute("aria-pressed", String(f.paused));
  describeScene();
  if (page.reference) describeDifference();
  showTools();
}

// Light, variants and time, where the scene has them; what is being moved is not moved back.
const degrees = (v) => `${Number(v.toFixed(1))}°`, seconds = (v) => `${Number(v.toFixed(2))} s`;
const around = (v, least) => least + ((((v - least) % 360) + 360) % 360); // the same angle, from `least` on
function describeScene() {
  const f = page.frame, isAnimated = f.animationSeconds > 0;
  const place = (id, value, inWords) => {
    at(id).parentElement.hidden = value === null;
    if (value === null || changing === id) return;
    at(id).value = value, at(`${id}-value`).textContent = inWords(value);
  };
  if (changing === null) page.sun = f.sun;
  place("turn", f.turn === null ? null : around(f.turn, -180), degrees);
  place("azimuth", f.sun === null ? null : around(f.sun[0], 0), degrees);
  place("elevation", f.sun === null ? null : f.sun[1], degrees);
  at("light-tools").hidden = settings.readOnly || (f.turn === null && f.sun === null);
  if (at("variant").options.length !== f.variants.length + 1)
    at("variant").replaceChildren(new Option("of the file", -1), ...f.variants.map((name, i) => new Option(name, i)));
  at("variant").value = f.variants.indexOf(f.variant);
  at("variant").parentElement.hidden = f.variants.length === 0;
  at("seconds").max = f.animationSeconds;
  place("seconds", isAnimated ? f.atSeconds ?? 0 : null, seconds);
  at("at-rest").hidden = !isAnimated;
  at("at-rest").setAttribute("aria-pressed", String(f.atSeconds === null));
  at("scene-tools").hidden = settings.readOnly || (f.variants.length === 0 && !isAnimated);
}

function showTools() {
  at("shown").value = page.shown;
  at("view").value = page.view;
  at("metered").checked = page.metered;
  at("exposure").value = exposureNow();
  at("exposure-value").textContent = `${exposureNow().toFixed(2)} EV`;
  if (page.pose) {
    at("fov").value = page.pose.fov;
    at("fov-value").textContent = `${Number(page.pose.fov.toFixed(1))}°`;
  }
}

// --- The camera ------------------------------------------------------------------------------------------------------

function moveTo(pose, moving) {
  if (settings.readOnly || !pose) return;
  page.pose = pose;
  const named = (name, point) => Object.fromEntries(point.map((v, i) => [name + "xyz"[i], v]));
  steer({
    ...named("from", pose.from), ...named("at", pose.at), fov: pose.fov, aperture: pose.aperture,
    focus: pose.focus, moving: moving ? 1 : 0,
  });
  showTools();
}

let dragging = null;
canvas.addEventListener("pointerdown", (event) => {
  if (at("focus").getAttribute("aria-pressed") === "true") return focusOn(event);
  if (settings.readOnly || !page.pose) return;
  canvas.setPointerCapture(event.pointerId);
  dragging = { x: event.clientX, y: event.clientY, pans: event.shiftKey || event.button !== 0 };
});
canvas.addEventListener("pointermove", (event) => {
  if (!dragging) return probe(event);
  const height = canvas.getBoundingClientRect().height;
  const dx = (event.clientX - dragging.x) / height, dy = (event.clientY - dragging.y) / height;
  dragging.x = event.clientX, dragging.y = event.clientY;
  moveTo(dragging.pans ? shifted(page.pose, -dx, dy) : orbited(page.pose, -Math.PI * dx, -Math.PI * dy), true);
});
for (const ends of ["pointerup", "pointercancel"])
  canvas.addEventListener(ends, () => {
    if (dragging) dragging = null, moveTo(page.pose, false);
  });
canvas.addEventListener("contextmenu", (event) => event.preventDefault());

let resting = 0;
function moveAndRest(pose) {
  moveTo(pose, true);
  clearTimeout(resting);
  resting = setTimeout(() => moveTo(page.pose, false), 250);
}
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  if (page.pose) moveAndRest(dollied(page.pose, Math.exp(Math.min(Math.max(event.deltaY, -200), 200) / 500)));
}, { passive: false });
const flights = { w: [0, 0, 1], s: [0, 0, -1], a: [-1, 0, 0], d: [1, 0, 0], q: [0, -1, 0], e: [0, 1, 0] };
at("stage").addEventListener("keydown", (event) => {
  const by = flights[event.key.toLowerCase()];
  if (by && page.pose && !event.ctrlKey && !event.metaKey) moveAndRest(shifted(page.pose, ...times(by, 0.05)));
});

// --- Pixels ----------------------------------------------------------------------------------------------------------

function pixelOf(event) {
  const box = canvas.getBoundingClientRect();
  const within = (v, n) => Math.min(Math.max(Math.floor(v * n), 0), n - 1);
  return { x: within((event.clientX - box.left) / box.width, canvas.width),
    y: within((event.clientY - box.top) / box.height, canvas.height) };
}

let probing = false, probeNext = null;
async function probe(event) {
  if (!page.frame) return;
  probeNext = pixelOf(event);
  if (probing) return;
  probing = true;
  while (probeNext) {
    const pixel = probeNext;
    probeNext = null;
    try {
      const response = await ask("/probe", pixel);
      if (response.ok) showProbe(await response.json());
    } catch { /* follow() says that there is no connection */ }
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  probing = false;
}

function showProbe(p) {
  const list = (v) => v.map(short).join("  ");
  const rows = { pixel: `${p.x} ${p.y}`, radiance: list(p.radiance), "its error": list(p.standardError),
    noise: p.noise === null ? "unknown" : percent(p.noise), samples: short(p.samples), albedo: list(p.albedo),
    normal: list(p.normal), depth: p.depth === null ? "nothing there" : `${short(p.depth)} m`,
    object: p.object ?? "none", material: p.material ?? "none" };
  at("probe").replaceChildren(...Object.entries(rows).flatMap(([name, value]) => {
    const term = document.createElement("dt"), text = document.createElement("dd");
    term.textContent = name, text.textContent = value;
    return [term, text];
  }));
  page.probe = p;
}

async function focusOn(event) {
  const response = await ask("/probe", pixelOf(event));
  if (!response.ok) return say(await response.text());
  const { depth } = await response.json();
  at("focus").setAttribute("aria-pressed", "false");
  if (!(depth > 0)) return say("there is nothing to focus on");
  moveTo({ ...page.pose, focus: depth, aperture: lens() }, false);
}
const lens = () => Math.max(Number(at("aperture").value) || 0, 0) / 1000;

// --- Tools -----------------------------------------------------------------------------------------------------------

at("shown").addEventListener("change", () => {
  page.shown = at("shown").value;
  following?.abort();
});
at("view").addEventListener("change", () => { page.view = at("view").value, draw(); });
at("exposure").addEventListener("input", () => {
  page.exposure = Number(at("exposure").value), page.metered = false, draw(), showTools();
});
at("metered").addEventListener("change", () => {
  page.exposure = exposureNow(), page.metered = at("metered").checked, draw(), showTools();
});
at("camera").addEventListener("change", () => {
  if (at("camera").value !== "") steer({ camera: at("camera").value, moving: 0 });
  at("camera").value = "";
});
at("fov").addEventListener("input", () => moveAndRest({ ...page.pose, fov: Number(at("fov").value) }));
at("aperture").addEventListener("change", () => {
  if (page.pose) moveTo({ ...page.pose, aperture: lens() }, false);
});
// Sliders of what makes the picture: many steps, and the last one.
let changing = null, changed = 0;
function slides(id, digits, inWords, wanted) {
  at(id).addEventListener("input", () => {
    const value = Number(Number(at(id).value).toFixed(digits));
    changing = id;
    at(`${id}-value`).textContent = inWords(value);
    steer({ ...wanted(value), moving: 1 });
    clearTimeout(changed);
    changed = setTimeout(() => { changing = null, steer({ moving: 0 }); }, 250);
  });
}
function sunAt(azimuth, elevation) {
  page.sun = [azimuth, elevation];
  return { azimuth, elevation };
}
slides("turn", 1, degrees, (turn) => ({ turn }));
slides("azimuth", 1, degrees, (azimuth) => sunAt(azimuth, page.sun[1]));
slides("elevation", 1, degrees, (elevation) => sunAt(page.sun[0], elevation));
slides("seconds", 3, seconds, (at) => ({ seconds: at }));
at("variant").addEventListener("change", () => steer({ variant: at("variant").value }));
at("at-rest").addEventListener("click", () => {
  if (!(page.frame?.animationSeconds > 0)) return;
  steer({ seconds: page.frame.atSeconds === null ? at("seconds").value : -1 });
});
const toggled = (id) => {
  const on = at(id).getAttribute("aria-pressed") !== "true";
  at(id).setAttribute("aria-pressed", String(on));
  return on;
};
at("focus").addEventListener("click", () => toggled("focus"));
at("pause").addEventListener("click", () => steer({ paused: toggled("pause") ? 1 : 0 }));

const asShown = () => ({ view: page.view, exposure: exposureNow(), denoised: page.shown === "denoised" ? 1 : 0 });
async function save(format) {
  say("making the file");
  const response = await ask("/save", { format, ...asShown() });
  if (!response.ok) return say(await response.text());
  const link = document.createElement("a");
  link.href = URL.createObjectURL(await response.blob());
  link.download = `view.${format}`;
  link.click();
  URL.revokeObjectURL(link.href);
  say("");
}
at("save-png").addEventListener("click", () => save("png"));
at("save-exr").addEventListener("click", () => save("exr"));
at("command").addEventListener("click", async () => {
  const response = await ask("/command", asShown());
  const text = await response.text();
  if (!response.ok) return say(text);
  at("command-text").textContent = text;
  at("command-text").hidden = false;
  await navigator.clipboard?.writeText(text).catch(() => {}); // where it may not, it is selected by a click
});

if (settings.readOnly) at("camera-tools").hidden = at("keys").hidden = at("command").hidden = true;
showTools();
if (settings.reference) fetchReference().catch((error) => say(error.message));
window.stromboli = page; // for who looks at it from the console
follow();
