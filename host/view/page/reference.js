// The picture that a page compares with: beside the other one, in its place, or as their difference.

const isSameSize = () => page.frame.width === page.reference?.text.width && page.frame.height === page.reference?.text.height;
const isDifference = () => page.compared === "difference" && isRadiance() && isSameSize();

// It lies over the picture, up to the divider, and is developed anew when the exposure or the view is another.
let developed = "";
function drawReference() {
  const { reference, compared, divider } = page, other = at("other");
  const isThere = reference && isRadiance() && (compared === "split" || compared === "all");
  other.hidden = !isThere;
  at("divider").hidden = !isThere || compared === "all";
  at("divider").setAttribute("aria-valuenow", String(Math.round(100 * divider)));
  if (!isThere) return;
  other.style.clipPath = `inset(0 ${compared === "all" ? 0 : 100 * (1 - divider)}% 0 0)`;
  const how = `${page.view} ${exposureNow()}`;
  if (how === developed) return;
  developed = how;
  const { width, height, exponent } = reference.text;
  other.width = width, other.height = height;
  const to = other.getContext("2d"), image = to.createImageData(width, height);
  developRadiance(reference.halves, exponent, page.view, exposureNow(), image.data);
  to.putImageData(image, 0, 0);
}

async function fetchReference() {
  const response = await ask("/reference", {});
  if (!response.ok) return say(await response.text());
  page.reference = decode(await response.arrayBuffer());
  at("reference-tools").hidden = false;
  draw();
}

function divideAt(share) {
  page.divider = Math.min(Math.max(share, 0), 1);
  drawReference(), fit();
}
at("divider").addEventListener("pointerdown", (event) => at("divider").setPointerCapture(event.pointerId));
at("divider").addEventListener("pointermove", (event) => {
  const box = canvas.getBoundingClientRect();
  if (at("divider").hasPointerCapture(event.pointerId)) divideAt((event.clientX - box.left) / box.width);
});
at("divider").addEventListener("keydown", (event) => {
  const by = { ArrowLeft: -0.02, ArrowRight: 0.02 }[event.key];
  if (by) divideAt(page.divider + by), event.stopPropagation();
});
at("compared").addEventListener("change", () => { page.compared = at("compared").value, draw(); });

const short = (v) => (v === null ? "none" : String(Number(v.toPrecision(4))));
function describeDifference() {
  const d = page.frame.difference;
  if (!d) return at("difference").textContent = isRadiance() ? "the coarse picture is not compared" : "";
  at("difference").textContent = [`relMSE ${short(d.relMse)}`, `MSE ${short(d.mse)}`,
    `bias ${d.bias === null ? "unknown" : percent(d.bias)}`, `PSNR ${d.psnr === null ? "without end" : `${short(d.psnr)} dB`}`,
    `SSIM ${short(d.ssim)}`].join("\n");
}
