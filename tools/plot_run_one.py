# SPDX-License-Identifier: GPL-3.0-or-later
"""One picture as it is asked for, or a film of it, for tools/plot_run: field, bodies, view, section, time, size, format."""

import os
import shutil
import subprocess
import textwrap

import matplotlib.pyplot as plt
import numpy as np

import plot_run_solid as solid
from plot_run_levels import draw_blocks
from plot_run_shapes import BodyColours, Colouring, draw_section, limits, set_box
from run_reader import Unknown
from units import said, scale_of

FORMATS, FILMS = ("png", "pdf", "svg"), ("mp4", "gif")
VIEWS = ("section", "iso", "+x", "-x", "+y", "-y", "+z", "-z")
LEAST_INCHES = (6.0, 4.5)  # of a picture: small ones have small letters
MOST_SCALED = 40  # frames that are looked at for the scale of colours


def colouring_of(run, field, span):
    """One scale for all times of the run."""
    numbers = run.shown()
    if span is not None and len(span) != 2:
        raise Unknown("--range: write least and largest value as 0:20GPa")
    if field == "body":
        return BodyColours(run.names)
    if field:
        run.require_field(field)
    picks = np.unique(np.linspace(0, len(numbers) - 1, min(MOST_SCALED, len(numbers))).round().astype(int))
    try:
        return Colouring(run, [numbers[k] for k in picks], field, span)
    except ValueError as error:
        raise Unknown(f"--range: {error}") from None


class Picture:
    """The same frame around every time: box, colours, title."""

    def __init__(self, run, options, numbers):
        self.run, self.options = run, options
        self.colouring = colouring_of(run, options.field, options.range)
        self.dpi = min(150, *(n / least for n, least in zip(options.size, LEAST_INCHES)))
        self.width, self.height = (n / self.dpi for n in options.size)
        if options.view == "section":
            raw = limits(run, numbers, 1.0)
            self.mm, self.unit = scale_of(max(raw[1] - raw[0], raw[3] - raw[2]), "m")
            self.box = raw / self.mm
        else:
            self.mm, self.unit = 1e-3, "mm"
            self.reach = solid.reach_of(run, numbers, solid.view_axes(options.view))

    def subtitle(self, number):
        run, parts = self.run, [said(self.run.time(number), "s")]
        if self.options.view != "section":
            parts.append("isometric" if self.options.view == "iso" else f"from {self.options.view}")
        elif run.frame == "3d":
            parts.append(f"section {run.normal} = {said(run.section_y, 'm')}")
        if run.only is not None:
            parts.append("only " + ", ".join(sorted(run.only)))
        return ", ".join([*parts, run.frame.replace("_", " "), f"cell {said(run.summary.get('cell'), 'm')}"])

    def draw(self, number):
        """A figure of one time."""
        figure = plt.figure(figsize=(self.width, self.height), dpi=self.dpi)
        bar = 1.15 / self.width if self.colouring.field not in (None, "body") else 0.02
        title = textwrap.wrap(self.run.title(), int(9.2 * self.width))
        top, low = (0.5 + 0.22 * len(title)) / self.height, (0.62 if self.options.view == "section" else 0.15) / self.height
        left = 0.85 / self.width if self.options.view == "section" else 0.01
        low += 0.3 / self.height * (self.colouring.field == "body")
        axes = figure.add_axes([left, low, 1 - left - bar - 0.02, 1 - top - low])
        bodies = self.run.bodies(number)
        (self.section if self.options.view == "section" else self.surface)(axes, bodies)
        if self.colouring.field == "body":
            shown = {body.name for body in bodies}
            figure.legend(handles=[h for h in self.colouring.handles() if h.get_label() in shown or h.get_label()[:4] == "and "],
                          loc="lower center", ncol=4, frameon=False, fontsize=10)
        elif self.colouring.field:
            self.colouring.bar(figure, cax=figure.add_axes([1 - bar, low, 0.16 / self.width, 1 - top - low]))
        figure.text(0.14 / self.width, 1 - 0.1 / self.height, "\n".join(title), fontsize=13, va="top", linespacing=1.15)
        figure.text(0.14 / self.width, 1 - (0.15 + 0.22 * len(title)) / self.height, self.subtitle(number), fontsize=11, va="top", color="0.35")
        return figure

    def section(self, axes, bodies):
        draw_section(axes, self.run, bodies, self.colouring, self.mm, self.box, pixels=max(self.options.size))
        if self.run.normal == "y":
            draw_blocks(axes, self.run, bodies, self.mm)
        set_box(axes, self.box, 0.03)
        across, up = self.run.axis_names()
        axes.set_xlabel(f"{across} [{self.unit}]")
        axes.set_ylabel(f"{up} [{self.unit}]")
        if self.run.frame == "axisymmetric":
            axes.axvline(0, color="0.25", lw=0.7, dashes=(8, 3, 2, 3))

    def surface(self, axes, bodies):
        box = axes.get_position()
        size = [int(n * self.dpi) for n in (box.width * self.width, box.height * self.height)]
        image, metres = solid.render(self.run, bodies, self.colouring, self.options.view, self.reach, size)
        axes.imshow(image, interpolation="none")
        axes.set_axis_off()
        wanted = 0.2 * size[0] * metres
        power = 10 ** np.floor(np.log10(wanted))
        length = next(m * power for m in (5, 2, 1) if m * power <= wanted * 1.001)
        y = 0.965 * size[1]
        axes.plot([0.02 * size[0], 0.02 * size[0] + length / metres], [y, y], color="0.1", lw=2.5)
        axes.text(0.02 * size[0], y - 0.012 * size[1], said(length, "m"), fontsize=10, va="bottom")
        axes.set_xlim(0, size[0])
        axes.set_ylim(size[1], 0)


def save(figure, path, kind):
    """All or nothing, like the program's own files."""
    figure.savefig(path + ".part", format=kind, dpi=figure.dpi)
    os.replace(path + ".part", path)
    plt.close(figure)


def frames_of(picture, numbers):
    for number in numbers:
        figure = picture.draw(number)
        figure.canvas.draw()
        rgb = np.asarray(figure.canvas.buffer_rgba())[:, :, :3].copy()
        plt.close(figure)
        yield rgb[:rgb.shape[0] // 2 * 2, :rgb.shape[1] // 2 * 2]  # of even size, as H.264 wants


def film(picture, numbers, path, kind, rate):
    if kind == "gif":
        from PIL import Image
        images = [Image.fromarray(rgb).quantize(128, dither=Image.Dither.NONE) for rgb in frames_of(picture, numbers)]
        images[0].save(path + ".part", format="GIF", save_all=True, append_images=images[1:], duration=round(1000 / rate), loop=0)
    else:
        if not shutil.which("ffmpeg"):
            raise Unknown("--film mp4 needs ffmpeg: tools/setup --pictures installs it; --film gif needs nothing")
        write_mp4(picture, numbers, path, rate)
    os.replace(path + ".part", path)


def write_mp4(picture, numbers, path, rate):
    coder = None
    for rgb in frames_of(picture, numbers):
        if coder is None:
            command = ["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{rgb.shape[1]}x{rgb.shape[0]}",
                       "-r", str(rate), "-i", "-", "-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags", "+faststart",
                       "-f", "mp4", path + ".part"]
            coder = subprocess.Popen(command, stdin=subprocess.PIPE)
        coder.stdin.write(rgb.tobytes())
    coder.stdin.close()
    if coder.wait() != 0:
        raise Unknown("--film: ffmpeg failed (see above)")


def default_path(run, options, kind):
    words = [options.field or "picture"] + ([options.view] if options.view != "section" else []) + \
        ([f"{run.normal}"] if run.normal != "y" else []) + ([] if options.film else [options.time.replace(" ", "")])
    return os.path.join(run.folder, "pictures", "_".join(words) + "." + kind)


def one(run, options):
    """Draws what was asked for; the path of the file."""
    if options.body:
        run.choose_bodies(options.body)
    if options.section:
        if options.view != "section":
            raise Unknown("--section and --view exclude one another: a view shows surfaces")
        run.cut_at(options.section)
    if options.view != "section":
        if run.frame == "plane_strain" or (run.frame == "axisymmetric" and options.view in ("+z", "-z")):
            raise Unknown(f"--view {options.view}: a run in {run.frame.replace('_', ' ')} has no such view (--view section)")
        solid.ready()
    shown = run.shown()
    if not shown:
        raise Unknown(f"{run.folder}: no frame holds a point of the bodies asked for")
    numbers = shown if options.film else [run.at(options.time)]
    kind = options.film or options.format
    path = options.output or default_path(run, options, kind)
    os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
    picture = Picture(run, options, numbers)
    if options.film:
        film(picture, numbers, path, kind, options.rate)
    else:
        save(picture.draw(numbers[0]), path, kind)
    return path
