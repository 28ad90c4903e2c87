// SPDX-License-Identifier: GPL-3.0-or-later
// Sections over time: rasters (tools/report_film.py) are unpacked when they are needed, coloured here, and drawn sharp at
// the volume fraction 1/2 whatever the size of the window.
"use strict";
const PALETTES = {
  viridis: ["#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"],
  rainbow: ["#30123b", "#4662d8", "#36aaf9", "#1ae4b6", "#72fe5e", "#c8ef34", "#faba39", "#f66b19", "#ca2a04", "#7a0403"],
  "blue to red": ["#053061", "#2f79b5", "#8ac0db", "#dbeaf2", "#f7f7f7", "#fcdfcf", "#f2a07e", "#cb4942", "#67001f"],
  grey: ["#f2f2f2", "#222222"],
};
const BODY_COLOURS = ["#4c78a8", "#f58518", "#54a24b", "#b279a2", "#e45756", "#72b7b2", "#eeca3b", "#9d755d", "#79706e"];
const rgb = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));

function table256(name) {
  const stops = PALETTES[name].map(rgb), out = new Uint8Array(768);
  for (let i = 0; i < 256; ++i) {
    const x = (i / 255) * (stops.length - 1), k = Math.min(Math.floor(x), stops.length - 2);
    for (let c = 0; c < 3; ++c) out[3 * i + c] = Math.round(stops[k][c] + (x - k) * (stops[k + 1][c] - stops[k][c]));
  }
  return out;
}

async function unpack(text, rows, columns) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const out = new Uint8Array(await new Response(stream).arrayBuffer());
  for (let r = 0; r < rows; ++r)
    for (let k = r * columns + 1; k < (r + 1) * columns; ++k) out[k] = (out[k] + out[k - 1]) & 255;
  return out;
}

// The raster of one run, and how its pixels map to places.
class Film {
  constructor(run, canvas, caption) {
    Object.assign(this, run.film, { run, canvas, caption, kept: new Map() });
  }
  get left() { return this.mirrored ? -this.low[0] - this.columns * this.pixel : this.low[0]; }
  get right() { return this.low[0] + this.columns * this.pixel; }
  get top() { return this.low[1] + this.rows * this.pixel; }
  nearest(time) {
    let best = 0;
    this.frames.forEach((f, k) => { if (Math.abs(f.time - time) < Math.abs(this.frames[best].time - time)) best = k; });
    return best;
  }
  async layer(frame, name) {
    const key = frame + name;
    if (!this.kept.has(key)) {
      if (this.kept.size > 400) this.kept.clear();
      const f = this.frames[frame], at = Object.keys(this.fields).indexOf(name);
      this.kept.set(key, unpack(at < 0 ? f[name] : f.values[at][2], this.rows, this.columns));
    }
    return this.kept.get(key);
  }
  // Where a pixel (u, v) of the raster is; null beyond it.
  index(x, z) {
    const u = (Math.abs(this.mirrored ? x : x - this.low[0]) - (this.mirrored ? this.low[0] : 0)) / this.pixel - 0.5;
    const v = (z - this.low[1]) / this.pixel - 0.5;
    return u < -0.5 || v < -0.5 || u > this.columns - 0.5 || v > this.rows - 0.5 || (!this.mirrored && x < this.low[0]) ? null : [u, v];
  }
}

const NOTHING = [178, 178, 178]; // of a body without the field

// A pixel of the picture; at the surface (128) half of it is material.
function put(px, at, table, t, filled) {
  const share = Math.min(1, (filled - 98) / 60);
  for (let c = 0; c < 3; ++c) px[at + c] = 255 + share * (table[t + c] - 255);
}

// View shared by all films: metres per pixel and the middle.
function draw(film, frame, look, view) {
  const { width, height } = film.canvas, context = film.canvas.getContext("2d");
  const image = context.createImageData(width, height), px = image.data;
  const { cover, body, value } = frame, { rows, columns, pixel } = film, [low, high] = frame.range;
  const scale = 255 / (look.high - look.low || 1), by = (high - low) / 254;
  const inv = 1 / pixel, right = columns - 1, bottom = rows - 1;
  for (let y = 0, o = 0; y < height; ++y) {
    const z = view.z - (y + 0.5 - height / 2) * view.size, v = (z - film.low[1]) * inv - 0.5;
    const inside = v >= 0 && v <= bottom, j = Math.min(Math.floor(v), bottom - 1), fv = v - j;
    for (let x = 0; x < width; ++x, o += 4) {
      px[o] = px[o + 1] = px[o + 2] = px[o + 3] = 255;
      if (!inside) continue;
      let place = view.x + (x + 0.5 - width / 2) * view.size;
      if (film.mirrored && place < 0) place = -place;
      let u = (place - film.low[0]) * inv - 0.5;
      if (film.mirrored && u < 0) u = 0;
      if (u < 0 || u > right) continue;
      const i = Math.min(Math.floor(u), right - 1), fu = u - i, k = j * columns + i;
      const a = (1 - fu) * (1 - fv), b = fu * (1 - fv), c = (1 - fu) * fv, d = fu * fv;
      const filled = cover[k] * a + cover[k + 1] * b + cover[k + columns] * c + cover[k + columns + 1] * d;
      if (filled < 98) continue;
      const near = k + (fu > 0.5 ? 1 : 0) + (fv > 0.5 ? columns : 0);
      if (look.bodies) {
        const colour = look.bodies[body[near] || body[k] || body[k + 1] || body[k + columns]] || look.bodies[1];
        put(px, o, colour, 0, filled);
        continue;
      }
      const p = value[k], q = value[k + 1], r = value[k + columns], s = value[k + columns + 1];
      const weight = (p && a) + (q && b) + (r && c) + (s && d);
      if (!(weight > 0)) { put(px, o, NOTHING, 0, filled); continue; }
      const mean = low + by * ((p && a * (p - 1)) + (q && b * (q - 1)) + (r && c * (r - 1)) + (s && d * (s - 1))) / weight;
      put(px, o, look.table, 3 * Math.max(0, Math.min(255, Math.round((mean - look.low) * scale))), filled);
    }
  }
  context.putImageData(image, 0, 0);
}

// Lines where the volume fraction is 1/2, of one run over the picture of another.
function outline(film, cover, context, view, colour) {
  const { width, height } = context.canvas, { rows, columns, pixel } = film;
  context.strokeStyle = colour;
  context.lineWidth = 1.8;
  context.beginPath();
  const put = (u, v, u1, v1, sign) => {
    const X = (n) => width / 2 + (sign * (film.low[0] + (n + 0.5) * pixel) - view.x) / view.size;
    const Y = (n) => height / 2 - (film.low[1] + (n + 0.5) * pixel - view.z) / view.size;
    context.moveTo(X(u), Y(v)); context.lineTo(X(u1), Y(v1));
  };
  for (let j = 0; j + 1 < rows; ++j)
    for (let i = 0; i + 1 < columns; ++i) {
      const k = j * columns + i, c = [cover[k], cover[k + 1], cover[k + columns + 1], cover[k + columns]], cut = [];
      for (let e = 0; e < 4; ++e) {
        const p = c[e], q = c[(e + 1) % 4];
        if ((p < 128) === (q < 128)) continue;
        const t = (128 - p) / (q - p);
        cut.push(e === 0 ? [i + t, j] : e === 1 ? [i + 1, j + t] : e === 2 ? [i + 1 - t, j + 1] : [i, j + 1 - t]);
      }
      for (let n = 0; n + 1 < cut.length; n += 2)
        for (const sign of film.mirrored ? [1, -1] : [1]) put(...cut[n], ...cut[n + 1], sign);
    }
  context.stroke();
}
