// From linear radiance to bytes of a screen: what host/film/tone_mapping.cpp and view_transform.cpp do, which have the
// sources of the numbers. Tests hold the two to each other.
"use strict";

// The values of all half floats, times 2^exponent.
function halfValues(exponent) {
  const values = new Float64Array(65536);
  const scale = 2 ** exponent;
  for (let h = 0; h < 65536; ++h) {
    const sign = h & 0x8000 ? -scale : scale, e = (h >> 10) & 31, m = h & 1023;
    values[h] = e === 31 ? (m ? 0 : sign * Infinity)
      : e === 0 ? sign * m * 2 ** -24 : sign * (1 + m / 1024) * 2 ** (e - 15);
  }
  return values;
}

function srgbByte(linear) {
  const l = linear > 0 ? Math.min(linear, 1) : 0;
  const signal = l <= 0.0031308 ? 12.92 * l : 1.055 * l ** (1 / 2.4) - 0.055;
  return Math.floor(255 * signal + 0.5);
}

// srgbByte() by a table of its 255 steps: the byte is the number of the steps that are not above the light.
const srgbSteps = (() => {
  const steps = new Float64Array(256);
  for (let byte = 1; byte < 256; ++byte) {
    const signal = (byte - 0.5) / 255;
    steps[byte] = signal <= 0.04045 ? signal / 12.92 : ((signal + 0.055) / 1.055) ** 2.4;
  }
  return steps;
})();
const srgbGuess = (() => {
  const guess = new Uint8Array(4097);
  for (let i = 0; i <= 4096; ++i) guess[i] = srgbByte(i / 4096);
  return guess;
})();
function toByte(light) {
  if (!(light > 0)) return 0;
  if (light >= 1) return 255;
  let byte = srgbGuess[Math.floor(light * 4096)];
  while (byte < 255 && srgbSteps[byte + 1] <= light) ++byte;
  return byte;
}

const lightOf = (radiance) => (radiance > 0 ? Math.min(radiance, 3.4028234663852886e38) : 0);

function filmicCurve(x) {
  return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3;
}
const filmicWhite = filmicCurve(11.2);
const filmic = (radiance) => filmicCurve(2 * radiance) / filmicWhite;

// Matrices by rows.
function product(a, b) {
  return a.map((row) => b[0].map((_, c) => row.reduce((sum, v, k) => sum + v * b[k][c], 0)));
}
const agxInset = [[0.856627153315983, 0.0951212405381588, 0.0482516061458583],
  [0.137318972929847, 0.761241990602591, 0.101439036467562], [0.11189821299995, 0.0767994186031903, 0.811302368396859]];
const agxOutset = [[1.1271005818144368, -0.11060664309660323, -0.016493938717834573],
  [-0.1413297634984383, 1.157823702216272, -0.016493938717834257],
  [-0.14132976349843826, -0.11060664309660294, 1.2519364065950405]];
const to2020 = [[0.627403895934699, 0.329283038377884, 0.043313065687417],
  [0.069097289358232, 0.919540395075459, 0.011362315566309], [0.016391438875150, 0.088013307877226, 0.895595253247624]];
const from2020 = [[1.660491002108434, -0.587641138788550, -0.072849863319885],
  [-0.124550474521591, 1.132899897125960, -0.008349422604369],
  [-0.018150763354905, -0.100578898008007, 1.118729661362913]];
const agxIn = product(agxInset, to2020);

function agx(r, g, b, out) {
  const x = [0, 0, 0];
  for (let c = 0; c < 3; ++c) {
    const [p, q, s] = agxIn[c];
    const stops = Math.log2(Math.max(p * r + q * g + s * b, 1e-10));
    const t = Math.min(Math.max((stops + 12.47393) / 16.499999, 0), 1), t2 = t * t, t4 = t2 * t2;
    x[c] = 15.5 * t4 * t2 - 40.14 * t4 * t + 31.96 * t4 - 6.868 * t2 * t + 0.4298 * t2 + 0.1191 * t - 0.00232;
  }
  const y = agxOutset.map(([p, q, s]) => Math.max(p * x[0] + q * x[1] + s * x[2], 0) ** 2.2);
  for (let c = 0; c < 3; ++c) {
    const [p, q, s] = from2020[c];
    out[c] = p * y[0] + q * y[1] + s * y[2];
  }
}

function pbrNeutral(r, g, b, out) {
  const least = Math.min(r, g, b);
  const offset = least < 0.08 ? least - least * least / 0.16 : 0.04;
  out[0] = r - offset, out[1] = g - offset, out[2] = b - offset;
  const from = 0.76, peak = Math.max(out[0], out[1], out[2]);
  if (peak < from) return;
  const room = 1 - from, newPeak = 1 - room * room / (peak + room - from);
  const faded = 1 - 1 / (0.15 * (peak - newPeak) + 1);
  for (let c = 0; c < 3; ++c) out[c] = out[c] * (newPeak / peak) * (1 - faded) + newPeak * faded;
}

// Radiance, three half floats a pixel, into the bytes of an ImageData.
function developRadiance(halves, exponent, view, exposure, data) {
  const values = halfValues(exponent), scale = 2 ** exposure, count = halves.length / 3;
  if (view === "standard" || view === "filmic") { // each channel by itself
    const bytes = new Uint8Array(65536);
    for (let h = 0; h < 65536; ++h) {
      const light = lightOf(scale * values[h]);
      bytes[h] = toByte(view === "filmic" ? filmic(light) : light);
    }
    for (let i = 0, from = 0, to = 0; i < count; ++i, to += 4) {
      data[to] = bytes[halves[from++]], data[to + 1] = bytes[halves[from++]], data[to + 2] = bytes[halves[from++]];
      data[to + 3] = 255;
    }
    return;
  }
  const out = [0, 0, 0], map = view === "agx" ? agx : pbrNeutral;
  for (let i = 0, from = 0, to = 0; i < count; ++i, to += 4) {
    map(lightOf(scale * values[halves[from++]]), lightOf(scale * values[halves[from++]]),
      lightOf(scale * values[halves[from++]]), out);
    data[to] = toByte(out[0]), data[to + 1] = toByte(out[1]), data[to + 2] = toByte(out[2]);
    data[to + 3] = 255;
  }
}

// How far radiance is from that of another picture, likewise: the light of the difference of each channel.
function developDifference(halves, exponent, others, otherExponent, exposure, data) {
  const values = halfValues(exponent), otherValues = halfValues(otherExponent), scale = 2 ** exposure;
  for (let i = 0, to = 0; i < halves.length; to += 4) {
    for (let c = 0; c < 3; ++c, ++i) data[to + c] = toByte(scale * Math.abs(values[halves[i]] - otherValues[others[i]]));
    data[to + 3] = 255;
  }
}

// Dark blue, red, yellow, white.
function falseColor(t, data, to) {
  const s = Math.min(Math.max(t, 0), 1);
  data[to] = 255 * Math.min(Math.max(2.4 * s, 0), 1);
  data[to + 1] = 255 * Math.min(Math.max(2.4 * s - 0.9, 0), 1);
  data[to + 2] = 255 * Math.min(Math.max(s < 0.3 ? 0.25 + s : 0.55 - 2 * (s - 0.3), 4 * s - 3, 0), 1);
  data[to + 3] = 255;
}

// Layers into the bytes of an ImageData. Returns what the ends of the scale are, in words; empty: there is no scale.
function developLayer(shown, halves, exponent, data) {
  const values = halfValues(exponent);
  if (shown === "albedo" || shown === "normal") {
    for (let i = 0, to = 0; i < halves.length; i += 3, to += 4) {
      for (let c = 0; c < 3; ++c) {
        const v = values[halves[i + c]];
        data[to + c] = shown === "albedo" ? toByte(v) : 127.5 * (v + 1);
      }
      data[to + 3] = 255;
    }
    return "";
  }
  if (shown === "noise") { // 1 % to 100 %, by the logarithm
    for (let i = 0; i < halves.length; ++i) falseColor(1 + Math.log10(values[halves[i]]) / 2, data, 4 * i);
    return "1 % to 100 %";
  }
  let least = Infinity, most = 0;
  for (const half of halves) {
    const v = values[half];
    if (v < Infinity) least = Math.min(least, v), most = Math.max(most, v);
  }
  if (!(least < Infinity)) least = 0;
  const range = most - least || 1;
  for (let i = 0; i < halves.length; ++i) {
    const t = (values[halves[i]] - least) / range;
    if (shown === "samples") {
      falseColor(t, data, 4 * i);
      continue;
    }
    const byte = t <= 1 ? 255 * (1 - 0.9 * t) : 0; // near: bright; nothing there: black
    data[4 * i] = data[4 * i + 1] = data[4 * i + 2] = byte;
    data[4 * i + 3] = 255;
  }
  const short = (v) => Number(v.toPrecision(3));
  return shown === "depth" ? `${short(least)} to ${short(most)} m` : `${short(least)} to ${short(most)}`;
}
