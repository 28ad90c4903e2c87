// SPDX-License-Identifier: GPL-3.0-or-later
// Puts the page together: the films with their controls, the histories, and one time for all of them.
"use strict";
const DATA = JSON.parse(document.getElementById("data").textContent);
const $ = (id) => document.getElementById(id);
const charts = DATA.charts.map((c) => new Chart($("charts"), c));

class Player {
  constructor(runs) {
    this.runs = runs;
    this.films = runs.map((run) => this.figure(run));
    this.longest = this.films.reduce((a, b) => (b.frames.length > a.frames.length ? b : a));
    this.frame = this.longest.frames.length - 1;
    this.timer = null;
    this.overlaid = false;
    this.look = {};
    const names = [...new Set(this.films.flatMap((f) => Object.keys(f.fields)))];
    for (const n of names) $("field").add(new Option(n.replaceAll("_", " "), n));
    $("field").add(new Option("body", "body"));
    for (const p of Object.keys(PALETTES)) $("palette").add(new Option(p, p));
    $("slider").max = this.longest.frames.length - 1;
    this.listen();
    this.field();
  }
  figure(run) {
    const figure = $("films").appendChild(document.createElement("figure"));
    const title = figure.appendChild(document.createElement("div"));
    if (this.runs.length > 1) title.innerHTML = `<span class=dot style="background:${run.colour}"></span>`;
    const cut = run.film.section;
    title.append([this.runs.length > 1 ? run.title : "", cut ? `section ${cut[0]} = ${digits(cut[1] * 1e3)} mm` : ""].filter(Boolean).join(", "));
    const canvas = figure.appendChild(document.createElement("canvas"));
    return new Film(run, canvas, figure.appendChild(document.createElement("figcaption")));
  }
  listen() {
    $("play").onclick = () => this.toggle();
    $("slider").oninput = () => { this.stop(); this.go(Number($("slider").value)); };
    $("back").onclick = () => { this.stop(); this.go(this.frame - 1); };
    $("next").onclick = () => { this.stop(); this.go(this.frame + 1); };
    $("field").onchange = () => this.field();
    $("palette").onchange = $("low").onchange = $("high").onchange = () => this.colours();
    $("reset").onclick = () => this.field();
    $("speed").onchange = () => { if (this.timer) { this.stop(); this.toggle(); } };
    if ($("over")) $("over").onclick = () => { this.overlaid = !this.overlaid; $("over").classList.toggle("on", this.overlaid); this.layout(); };
    document.addEventListener("keydown", (e) => {
      if (/INPUT|SELECT|BUTTON|SUMMARY/.test(e.target.tagName) && e.target.type !== "range") return;
      if (e.key === " ") { e.preventDefault(); this.toggle(); }
      if (e.key === "ArrowRight" && e.target.type !== "range") this.go(this.frame + 1);
      if (e.key === "ArrowLeft" && e.target.type !== "range") this.go(this.frame - 1);
    });
    for (const film of this.films) {
      film.canvas.onmousemove = (e) => this.read(film, e);
      film.canvas.onmouseleave = () => { film.caption.textContent = ""; };
    }
    for (const c of charts) c.onTime = (t) => { this.stop(); this.go(this.longest.nearest(t * DATA.time.divisor)); };
    let wait;
    window.addEventListener("resize", () => { clearTimeout(wait); wait = setTimeout(() => this.layout(), 120); });
  }
  field() {
    const name = $("field").value, spans = this.films.map((f) => f.fields[name]).filter(Boolean);
    this.bodies = name === "body";
    for (const id of ["palette", "low", "high", "reset"]) $(id).disabled = this.bodies;
    if (!this.bodies) {
      const low = Math.min(...spans.map((s) => s.low)), high = Math.max(...spans.map((s) => s.high));
      this.unit = spans.reduce((a, b) => (b.divisor > a.divisor ? b : a));
      this.signed = spans.some((s) => s.signed);
      const most = Math.max(-low, high);
      $("low").value = digits((this.signed ? -most : low) / this.unit.divisor, 4);
      $("high").value = digits((this.signed ? most : high) / this.unit.divisor, 4);
      $("palette").value = this.signed ? "blue to red" : "viridis";
      $("unit").textContent = this.unit.unit || "";
    }
    this.colours();
  }
  colours() {
    const d = this.unit ? this.unit.divisor : 1;
    this.look = this.bodies ? { bodies: [null, ...BODY_COLOURS.concat(BODY_COLOURS, BODY_COLOURS).map(rgb)] } :
      { table: table256($("palette").value), low: Number($("low").value) * d, high: Number($("high").value) * d };
    this.layout();
  }
  layout() {
    const width = Math.min(...this.films.map((f) => f.left)), right = Math.max(...this.films.map((f) => f.right));
    const low = Math.min(...this.films.map((f) => f.low[1])), top = Math.max(...this.films.map((f) => f.top));
    const sharp = Math.min(window.devicePixelRatio || 1, 2);
    this.films.forEach((film, k) => {
      film.canvas.parentNode.style.display = this.overlaid && k > 0 ? "none" : "";
    });
    const shown = this.films[0].canvas.clientWidth || 600;
    const room = Math.min(660, Math.max(300, window.innerHeight - 280));  // with its controls it fits into the window
    const tall = Math.min(room, Math.max(260, shown * (top - low) / (right - width)));
    for (const film of this.films) {
      film.canvas.style.height = `${Math.round(tall)}px`;
      film.canvas.width = Math.round(shown * sharp);
      film.canvas.height = Math.round(tall * sharp);
    }
    this.view = { x: (width + right) / 2, z: (low + top) / 2,
      size: 1.04 * Math.max((right - width) / this.films[0].canvas.width, (top - low) / this.films[0].canvas.height) };
    this.scale();
    this.go(this.frame);
  }
  async go(frame) {
    this.frame = Math.max(0, Math.min(this.longest.frames.length - 1, frame));
    const time = this.longest.frames[this.frame].time, name = $("field").value, ticket = (this.ticket = {});
    $("slider").value = this.frame;
    $("clock").textContent = `${digits(time / DATA.time.divisor, 4)} ${DATA.time.unit}`;
    document.body.dataset.frame = this.frame;
    for (const c of charts) c.now(time / DATA.time.divisor);
    const loaded = await Promise.all(this.films.map(async (film) => {
      const k = film.nearest(time), at = Object.keys(film.fields).indexOf(name), covered = await film.layer(k, "cover");
      const body = await film.layer(k, "body");
      const value = at < 0 ? new Uint8Array(covered.length) : await film.layer(k, name);
      return { cover: covered, body, value, range: at < 0 ? [0, 1] : film.frames[k].values[at], time: film.frames[k].time };
    }));
    if (ticket !== this.ticket) return;
    this.films.forEach((film, k) => { film.now = loaded[k]; });
    (this.overlaid ? this.films.slice(0, 1) : this.films).forEach((film) => { draw(film, film.now, this.look, this.view); this.frill(film); });
    if (this.overlaid) this.outlines();
    document.body.dataset.drawn = this.frame;
  }
  // Of all runs in one picture, and whose they are.
  outlines() {
    const g = this.films[0].canvas.getContext("2d"), sharp = Math.min(window.devicePixelRatio || 1, 2);
    g.font = `${13 * sharp}px system-ui, "DejaVu Sans", sans-serif`;
    this.films.forEach((film, k) => {
      outline(film, film.now.cover, g, this.view, film.run.colour);
      g.fillStyle = film.run.colour;
      g.fillRect(14 * sharp, (17 + 20 * k) * sharp, 22 * sharp, 3 * sharp);
      g.fillStyle = "#1b2733";
      g.fillText(film.run.title + (k ? "" : ", coloured"), 44 * sharp, (23 + 20 * k) * sharp);
    });
  }
  // Axis of symmetry, a bar of length.
  frill(film) {
    const g = film.canvas.getContext("2d"), { width, height } = film.canvas, sharp = Math.min(window.devicePixelRatio || 1, 2);
    if (film.mirrored) {
      g.strokeStyle = "#9aa5b0"; g.lineWidth = sharp; g.setLineDash([9 * sharp, 3 * sharp, 2 * sharp, 3 * sharp]);
      g.beginPath(); g.moveTo(width / 2 - this.view.x / this.view.size, 0); g.lineTo(width / 2 - this.view.x / this.view.size, height); g.stroke();
      g.setLineDash([]);
    }
    const wanted = 0.22 * width * this.view.size, power = 10 ** Math.floor(Math.log10(wanted));
    const length = [5, 2, 1].map((m) => m * power).find((m) => m <= wanted * 1.001), bar = length / this.view.size;
    g.fillStyle = "#1b2733"; g.fillRect(14 * sharp, height - 16 * sharp, bar, 3 * sharp);
    g.font = `${12 * sharp}px system-ui, "DejaVu Sans", sans-serif`;
    g.fillText(length >= 1 ? `${digits(length)} m` : length >= 1e-4 ? `${digits(length * 1e3)} mm` : `${digits(length * 1e6)} µm`, 14 * sharp, height - 22 * sharp);
  }
  scale() {
    const c = $("scale"), sharp = Math.min(window.devicePixelRatio || 1, 2), g = c.getContext("2d");
    c.width = c.clientWidth * sharp; c.height = 44 * sharp;
    g.scale(sharp, sharp);
    g.font = '12px system-ui, "DejaVu Sans", sans-serif';
    const w = c.clientWidth - 60;
    if (this.bodies) {
      let x = 4;
      this.films[0].bodies.slice(0, 8).forEach((name, k) => {
        g.fillStyle = BODY_COLOURS[k % BODY_COLOURS.length]; g.fillRect(x, 8, 13, 13);
        g.fillStyle = "#1b2733"; g.fillText(name, x + 18, 19); x += 34 + g.measureText(name).width;
      });
      return;
    }
    for (let i = 0; i < w; ++i) {
      const t = 3 * Math.round((255 * i) / (w - 1)), m = this.look.table;
      g.fillStyle = `rgb(${m[t]},${m[t + 1]},${m[t + 2]})`; g.fillRect(30 + i, 6, 1.5, 15);
    }
    const low = this.look.low / this.unit.divisor, high = this.look.high / this.unit.divisor;
    g.fillStyle = "#5b6875"; g.textAlign = "center";
    if (high > low) for (const v of nice(low, high, 6)) {
      const x = 30 + (w * (v - low)) / (high - low);
      g.fillRect(x - 0.5, 21, 1, 4); g.fillText(digits(v, 6), x, 38);
    }
  }
  read(film, e) {
    if (!film.now) return;
    const r = film.canvas.getBoundingClientRect(), scale = film.canvas.width / r.width;
    const x = this.view.x + ((e.clientX - r.left) * scale - film.canvas.width / 2) * this.view.size;
    const z = this.view.z - ((e.clientY - r.top) * scale - film.canvas.height / 2) * this.view.size;
    const at = film.index(x, z), mm = (v) => `${digits(v * 1e3)} mm`;
    let text = `${film.axes[0]} ${mm(film.mirrored ? Math.abs(x) : x)}, ${film.axes[1]} ${mm(z)}`;
    if (at) {
      const k = Math.round(at[1]) * film.columns + Math.max(0, Math.round(at[0])), name = $("field").value;
      if (film.now.cover[k] >= 128) {
        text = `${film.bodies[film.now.body[k] - 1]}, ${text}`;
        if (!this.bodies && film.now.value[k]) {
          const [low, high] = film.now.range, value = low + ((film.now.value[k] - 1) / 254) * (high - low);
          text = `${name.replaceAll("_", " ")} ${digits(value / this.unit.divisor, 3)} ${this.unit.unit} · ${text}`;
        }
      }
    }
    film.caption.textContent = text;
  }
  toggle() {
    if (this.timer) return this.stop();
    if (this.frame === this.longest.frames.length - 1) this.frame = -1;
    $("play").textContent = "❚❚";
    const step = async () => {
      await this.go(this.frame + 1);
      if (this.timer === null) return;
      if (this.frame === this.longest.frames.length - 1) return $("loop").checked ? ((this.frame = -1), (this.timer = setTimeout(step, 700))) : this.stop();
      this.timer = setTimeout(step, 1000 / Number($("speed").value));
    };
    this.timer = setTimeout(step, 0);
  }
  stop() {
    clearTimeout(this.timer);
    this.timer = null;
    $("play").textContent = "▶";
  }
}

if (DATA.runs.some((run) => run.film)) window.player = new Player(DATA.runs.filter((run) => run.film));
document.body.dataset.ready = "yes";
