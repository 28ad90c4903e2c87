// SPDX-License-Identifier: GPL-3.0-or-later
// Histories as SVG: curves of all runs, references as dashed lines, values under the pointer, the film's time.
"use strict";
const SVG = "http://www.w3.org/2000/svg";
const LINES = ["#1f5f99", "#b5402a", "#2c8a4b", "#c98a1b", "#7d5ba6", "#8c564b", "#1795a8", "#6b7680"];
const DASHES = ["", "7 3", "2 3", "9 3 2 3"];
const digits = (v, n = 4) => {
  if (!Number.isFinite(v)) return "-";
  const s = v.toPrecision(n);
  return s.includes("e") ? Number(s).toExponential() : s.includes(".") ? s.replace(/\.?0+$/, "") : s;
};

function nice(low, high, count) {
  const raw = (high - low) / count || 1, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].map((m) => m * power).find((s) => s >= raw * 0.999), out = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) out.push(k * step);
  return out;
}

function element(parent, name, attributes, text) {
  const made = document.createElementNS(SVG, name);
  for (const [k, v] of Object.entries(attributes)) made.setAttribute(k, v);
  if (text !== undefined) made.textContent = text;
  return parent.appendChild(made);
}

class Chart {
  constructor(place, data) {
    Object.assign(this, { data, W: 600, H: 270, L: 62, R: 12, T: 10, B: 36, hidden: new Set() });
    const box = document.createElement("div");
    box.className = "chart";
    box.innerHTML = "<h3></h3>";
    box.firstChild.textContent = data.title;
    this.svg = element(box, "svg", { viewBox: `0 0 ${this.W} ${this.H}`, role: "img", "aria-label": data.title });
    this.legend = box.appendChild(document.createElement("div"));
    this.legend.className = "legend";
    this.tip = box.appendChild(document.createElement("div"));
    this.tip.className = "tip";
    this.box = place.appendChild(box);
    data.series.forEach((s, k) => this.entry(s, k));
    this.svg.addEventListener("mousemove", (e) => this.point(e));
    this.svg.addEventListener("mouseleave", () => { this.tip.style.display = "none"; this.cross?.remove(); });
    this.svg.addEventListener("click", (e) => this.onTime && this.onTime(this.timeAt(e)));
    this.draw();
  }
  entry(s, k) {
    const span = this.legend.appendChild(document.createElement("span"));
    span.innerHTML = `<i style="border-color:${s.colour};border-top-style:${s.dash ? "dashed" : "solid"}"></i>`;
    span.append(s.name);
    span.title = "show or hide";
    span.addEventListener("click", () => {
      this.hidden.has(k) ? this.hidden.delete(k) : this.hidden.add(k);
      span.classList.toggle("off");
      this.draw();
    });
  }
  shown() { return this.data.series.filter((_, k) => !this.hidden.has(k)); }
  span() {
    let t = [Infinity, -Infinity], v = [Infinity, -Infinity];
    for (const s of this.shown()) {
      for (const x of s.t) { t[0] = Math.min(t[0], x); t[1] = Math.max(t[1], x); }
      for (const y of s.v) { v[0] = Math.min(v[0], y); v[1] = Math.max(v[1], y); }
      if (s.reference != null) { v[0] = Math.min(v[0], s.reference - (s.error || 0)); v[1] = Math.max(v[1], s.reference + (s.error || 0)); }
    }
    if (!(t[1] > t[0])) t = [0, 1];
    if (!(v[1] >= v[0])) v = [0, 1];
    if (v[0] > 0 && v[0] < 0.4 * v[1]) v[0] = 0;
    const pad = (v[1] - v[0]) * 0.05 || Math.abs(v[1]) * 0.05 || 1;
    return [t, [v[0] === 0 ? 0 : v[0] - pad, v[1] + pad]];
  }
  X(t) { return this.L + ((t - this.t[0]) / (this.t[1] - this.t[0])) * (this.W - this.L - this.R); }
  Y(v) { return this.H - this.B - ((v - this.v[0]) / (this.v[1] - this.v[0])) * (this.H - this.T - this.B); }
  timeAt(e) {
    const r = this.svg.getBoundingClientRect(), x = ((e.clientX - r.left) / r.width) * this.W;
    return this.t[0] + ((x - this.L) / (this.W - this.L - this.R)) * (this.t[1] - this.t[0]);
  }
  draw() {
    this.svg.textContent = "";
    [this.t, this.v] = this.span();
    const { W, H, L, R, T, B } = this;
    for (const v of nice(this.v[0], this.v[1], 5)) {
      element(this.svg, "line", { class: "grid", x1: L, x2: W - R, y1: this.Y(v), y2: this.Y(v) });
      element(this.svg, "text", { class: "tick", x: L - 6, y: this.Y(v) + 4, "text-anchor": "end" }, digits(v, 6));
    }
    for (const t of nice(this.t[0], this.t[1], 7))
      element(this.svg, "text", { class: "tick", x: this.X(t), y: H - B + 16, "text-anchor": "middle" }, digits(t, 6));
    element(this.svg, "path", { class: "axis", fill: "none", d: `M${L} ${T}V${H - B}H${W - R}` });
    element(this.svg, "text", { class: "tick", x: (W + L) / 2, y: H - 4, "text-anchor": "middle" }, `time [${this.data.timeUnit}]`);
    element(this.svg, "text", { class: "tick", x: 12, y: (H - B) / 2, "text-anchor": "middle", transform: `rotate(-90 12 ${(H - B) / 2})` },
      `[${this.data.unit || "1"}]`);
    if (this.shown().some((s) => s.reference != null))
      element(this.svg, "text", { class: "tick", x: W - R, y: T + 2, "text-anchor": "end" }, "dotted: reference");
    for (const s of this.shown()) {
      let d = "";
      for (let k = 0; k < s.t.length; ++k) d += `${k ? "L" : "M"}${this.X(s.t[k]).toFixed(1)} ${this.Y(s.v[k]).toFixed(1)}`;
      element(this.svg, "path", { d, fill: "none", stroke: s.colour, "stroke-width": 1.8, "stroke-dasharray": s.dash || "none", "stroke-linejoin": "round" });
      if (s.reference != null) {
        const y = this.Y(s.reference);
        if (s.error)
          element(this.svg, "rect", { class: "bar", x: L, width: W - R - L, y: this.Y(s.reference + s.error), fill: s.colour, opacity: 0.12,
            height: this.Y(s.reference - s.error) - this.Y(s.reference + s.error) });
        element(this.svg, "line", { x1: L, x2: W - R, y1: y, y2: y, stroke: s.colour, "stroke-width": 1.2, "stroke-dasharray": "2 4" });
      }
    }
    this.now(this.at);
  }
  now(t) {
    this.at = t;
    this.mark?.remove();
    if (t != null && t >= this.t[0] && t <= this.t[1])
      this.mark = element(this.svg, "line", { class: "now", x1: this.X(t), x2: this.X(t), y1: this.T, y2: this.H - this.B });
  }
  point(e) {
    const t = this.timeAt(e), lines = [`t = ${digits(t)} ${this.data.timeUnit}`];
    for (const s of this.shown()) {
      let k = s.t.findIndex((x) => x >= t);
      if (k < 0) k = s.t.length - 1;
      if (k > 0 && t - s.t[k - 1] < s.t[k] - t) k -= 1;
      if (s.t.length) lines.push(`${s.name}: ${digits(s.v[k], 5)} ${this.data.unit}`);
    }
    this.tip.textContent = lines.join("\n");
    this.tip.style.display = "block";
    const r = this.box.getBoundingClientRect(), x = e.clientX - r.left;
    this.tip.style.left = `${x > r.width / 2 ? x - this.tip.offsetWidth - 14 : x + 14}px`;
    this.tip.style.top = `${e.clientY - r.top + 12}px`;
    this.cross?.remove();
    this.cross = element(this.svg, "line", { class: "axis", x1: this.X(t), x2: this.X(t), y1: this.T, y2: this.H - this.B, opacity: 0.4 });
  }
}
