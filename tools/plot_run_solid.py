# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of bodies in space, by VTK off screen, for tools/plot_run --view.

Points: the surface where the volume fraction of a body (quadratic B-spline of a cell, as plot_run_raster) is 1/2, coloured by
the mean of its field; points that it does not show as cubes of their own volume, none too small to be seen. Elements: their
faces. An axisymmetric run is turned about its axis by 270 degrees, so that the section shows.

Debian's VTK draws into an X screen only: where there is none an Xvfb is started for it and ended with the process.
"""

import atexit
import os
import shutil
import subprocess

import numpy as np

from plot_run_elements import exposed
from plot_run_raster import BESIDE, CORNER, HALF, Fraction, Raster, mirrored
from run_reader import Unknown

MOST_VOXELS = 2.5e7
TURN, STEPS = 270.0, 90  # of an axisymmetric body about its axis
WEDGE = -105.0  # degrees: where what is left out of it begins, so that it faces the viewer of `iso`
LONE = 0.4  # a sheet one point thick has the volume fraction 0.375: below this a point is drawn by itself
LEAST = 0.004  # of the picture's height: side of a fragment that is drawn


def ready():
    """The module vtk; Unknown, with what to do, where it or a screen is missing."""
    try:
        import vtk
    except ImportError:
        raise Unknown("--view: surfaces need VTK and Xvfb: tools/setup --pictures installs them") from None
    if not os.environ.get("DISPLAY"):
        if not shutil.which("Xvfb"):
            raise Unknown("--view: VTK draws into a screen and there is none: tools/setup --pictures installs Xvfb")
        screen = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", "640x480x24", "-nolisten", "tcp"],
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        number = screen.stdout.readline().strip()
        if not number:
            raise Unknown("--view: Xvfb did not start; try it by hand, or set DISPLAY")
        os.environ["DISPLAY"] = f":{number}"
        atexit.register(screen.terminate)
    return vtk


def view_axes(view):
    """Rows: right, up, towards the viewer. `iso`, or the side that is looked at: +x, -y, ..."""
    if view == "iso":
        azimuth, elevation = np.radians([-60.0, 24.0])
        towards = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    else:
        towards = np.zeros(3)
        towards["xyz".index(view[-1])] = -1.0 if view[0] == "-" else 1.0
    up = np.array([0.0, 1.0, 0.0]) if abs(towards[2]) > 0.9 else np.array([0.0, 0.0, 1.0])
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(towards, right), towards])


# ------------------------------------------------------------------------------------------ geometry

def voxels(x, volume, h, planes):
    """(lowest corner, spacing, weights by fields): deposits onto a lattice and smooths to B-splines of the cell h."""
    low, high = x.min(axis=0) - 2 * h, x.max(axis=0) + 2 * h
    width = 3 if np.prod((high - low) * 3 / h) < MOST_VOXELS else 1
    h = max(h, (np.prod(high - low) / MOST_VOXELS) ** (1 / 3))
    pixel = h / width
    shape = np.ceil((high - low) / pixel).astype(int) + 1
    index, image = mirrored(x, planes, h)
    places = (image - low) / pixel
    corner = np.floor(places).astype(int)
    part = places - corner
    inside = ((corner >= 0) & (corner < shape - 1)).all(axis=1)

    def field(values):
        total = np.zeros(np.prod(shape))
        for offset in np.ndindex(2, 2, 2):
            weight = np.prod(np.abs(1 - np.array(offset) - part), axis=1) * values[index]
            at = np.ravel_multi_index((corner[inside] + offset).T, shape)
            total += np.bincount(at, weight[inside], len(total))
        total = total.reshape(shape)
        for axis in range(3) if width > 1 else ():
            for _ in range(3):
                total = sliding(total, axis, width // 2)
        return total / pixel ** 3
    return low, pixel, shape, field


def at_corner(phi, here, cell):
    """Points that edges and corners of a body leave out, whose surface of 1/2 rounds them off; no debris."""
    near = (phi >= HALF).astype(float)
    for axis in range(3):
        near = sliding(near, axis, int(round(BESIDE * cell)))
    return (phi[tuple(here.T)] >= CORNER) & (near[tuple(here.T)] > 1e-12)


def sliding(values, axis, reach):
    """Mean over 2 reach + 1 along an axis; zero beyond the ends."""
    n = values.shape[axis]
    total = np.cumsum(np.pad(values, [(reach + 1, reach) if k == axis else (0, 0) for k in range(3)]), axis=axis)
    return (np.take(total, range(2 * reach + 1, n + 2 * reach + 1), axis) - np.take(total, range(n), axis)) / (2 * reach + 1)


class Surfaces:
    """Triangles with colours, made by VTK's filters out of the bodies of a frame."""

    def __init__(self, vtk, run, bodies, colouring):
        from vtk.util import numpy_support
        self.vtk, self.np, self.run, self.colouring = vtk, numpy_support, run, colouring
        self.meshes, self.specks = [], []  # (vtkPolyData, colours of its cells?, lines?); (places, sides, colours)
        for body in bodies:
            if run.frame == "3d":
                (self.add_points if body.cells is None else self.add_elements)(body)
            else:
                self.add_turned(body)

    def array(self, values, name):
        made = self.np.numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        made.SetName(name)
        return made

    def image(self, low, pixel, shape, fields):
        made = self.vtk.vtkImageData()
        made.SetDimensions(*map(int, shape))
        made.SetOrigin(*map(float, low))
        made.SetSpacing(pixel, pixel, pixel)
        for name, values in fields.items():
            made.GetPointData().AddArray(self.array(values.ravel(order="F"), name))
        made.GetPointData().SetActiveScalars("phi")
        return made

    def keep(self, data, rgba, cells=False):
        """A mesh, with one colour for each of its points or cells."""
        colours = self.array((255 * rgba[:, :3]).round().astype(np.uint8), "colours")
        (data.GetCellData() if cells else data.GetPointData()).SetScalars(colours)
        self.meshes.append((data, cells, cells))

    def coloured(self, data):
        """By the values that the filters carried along."""
        values = data.GetPointData().GetArray("value")
        self.keep(data, self.colouring.rgba(self.np.vtk_to_numpy(values)))

    def add_points(self, body):
        h = float(self.run.summary.get("cell") or 2 * np.median(body.side)) / 2 ** self.run.finest
        values = self.colouring.values(body)
        planes = self.run.start_planes
        low, pixel, shape, field = voxels(body.x, body.volume, h, planes)
        phi = field(body.volume)
        value = field(body.volume * np.nan_to_num(values)) / np.maximum(phi, 1e-12)
        here = np.clip(np.rint((body.x - low) / pixel).astype(int), 0, shape - 1)
        alone = (phi[tuple(here.T)] < LONE) & ~at_corner(phi, here, h / pixel)
        for axis, at, inside in planes:
            places = low[axis] + pixel * np.arange(shape[axis])
            phi[tuple(slice(None) if k != axis else (places - at) * inside < -1e-9 for k in range(3))] = 0
        contour = self.vtk.vtkFlyingEdges3D()
        contour.SetInputData(self.image(low, pixel, shape, {"phi": phi, "value": value}))
        contour.SetInputArrayToProcess(0, 0, 0, 0, "phi")
        contour.SetValue(0, HALF)
        contour.InterpolateAttributesOn()
        contour.Update()
        if contour.GetOutput().GetNumberOfPoints():
            self.coloured(contour.GetOutput())
        if alone.any():
            self.specks.append((body.x[alone], body.side[alone], self.colouring.rgba(values[alone])))

    def polygons(self, points, cells):
        data = self.vtk.vtkPolyData()
        places = self.vtk.vtkPoints()
        places.SetData(self.array(points, "places"))
        data.SetPoints(places)
        faces = self.vtk.vtkCellArray()
        size = cells.shape[1]
        faces.SetData(size, self.np.numpy_to_vtkIdTypeArray(np.ascontiguousarray(cells.ravel(), dtype=np.int64), deep=True))
        (data.SetLines if size == 2 else data.SetPolys)(faces)
        return data

    def add_elements(self, body):
        faces, index = exposed(body.cells)
        self.keep(self.polygons(body.nodes, faces), self.colouring.of(body)[index], cells=True)

    def add_turned(self, body):
        """The section and what its edge sweeps."""
        if body.cells is not None:
            flat = self.polygons(body.nodes, body.cells)
            values = np.repeat(self.colouring.of(body)[:, :3], 1, axis=0)
            flat.GetCellData().SetScalars(self.array((255 * values).round().astype(np.uint8), "colours"))
            edges = np.concatenate([body.cells[:, [k, (k + 1) % 4]] for k in range(4)])
            _, first, counts = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
            lines = self.polygons(body.nodes, edges[first[counts == 1]])
            lines.GetCellData().SetScalars(self.array(
                (255 * values[first[counts == 1] % len(body.cells)]).round().astype(np.uint8), "colours"))
            return self.sweep(flat, lines, cells=True)
        box = [0.0, body.x[:, 0].max() + body.side.max(), body.x[:, 2].min() - body.side.max(), body.x[:, 2].max() + body.side.max()]
        cell = float(self.run.summary.get("cell") or 2 * np.median(body.side)) / 2 ** self.run.finest
        raster = Raster(box, cell, 700)
        inside = Fraction(raster, self.run.frame, body.x, body.volume, self.run.planes)
        values = self.colouring.values(body)
        mean = inside.mean(values)
        first = int(round(-raster.low[0] / raster.pixel))
        rows, columns = raster.shape[0], raster.shape[1] - first
        # From the axis on: pixel centres, the first of them moved onto it.
        x = (np.arange(columns) + 0.5) * raster.pixel
        x[0] = 0.0
        z = raster.low[1] + (np.arange(rows) + 0.5) * raster.pixel
        made = self.vtk.vtkRectilinearGrid()
        made.SetDimensions(columns, 1, rows)
        for put, places in ((made.SetXCoordinates, x), (made.SetYCoordinates, np.zeros(1)), (made.SetZCoordinates, z)):
            put(self.array(places, "places"))
        for name, of in (("phi", inside.phi), ("value", mean)):
            made.GetPointData().AddArray(self.array(of[:, first:].ravel(), name))
        made.GetPointData().SetActiveScalars("phi")
        surface = self.vtk.vtkRectilinearGridGeometryFilter()
        surface.SetInputData(made)
        cut = self.vtk.vtkClipPolyData()
        cut.SetInputConnection(surface.GetOutputPort())
        cut.SetValue(HALF)
        edge = self.vtk.vtkContourFilter()
        edge.SetInputData(made)
        edge.SetInputArrayToProcess(0, 0, 0, 0, "phi")
        edge.SetValue(0, HALF)
        cut.Update()
        edge.Update()
        self.sweep(cut.GetOutput(), edge.GetOutput())
        alone = np.unique(inside.index[inside.isolated(LONE)])
        self.add_rings(body.x[alone], body.side[alone], self.colouring.rgba(values[alone]))

    def sweep(self, section, edge, cells=False):
        swept = self.vtk.vtkRotationalExtrusionFilter()
        swept.SetInputData(edge)
        swept.SetResolution(STEPS)
        swept.SetAngle(-TURN)
        swept.CappingOff()
        swept.Update()
        for part, angle in ((swept.GetOutput(), WEDGE), (section, WEDGE), (section, WEDGE - TURN)):
            turn = self.vtk.vtkTransform()
            turn.RotateZ(angle)
            moved = self.vtk.vtkTransformPolyDataFilter()
            moved.SetInputData(part)
            moved.SetTransform(turn)
            moved.Update()
            out = moved.GetOutput()
            if not out.GetNumberOfPoints():
                continue
            if cells:
                self.meshes.append((out, True, part is section))
            else:
                self.coloured(out)

    def add_rings(self, x, side, rgba):
        """Fragments of an axisymmetric run are rings: specks around them."""
        count = 60
        angle = np.radians(WEDGE - TURN * (np.arange(count) + 0.5) / count)
        ring = np.stack([np.outer(x[:, 0], np.cos(angle)), np.outer(x[:, 0], np.sin(angle)), np.outer(x[:, 2], np.ones(count))], -1)
        if len(x):
            self.specks.append((ring.reshape(-1, 3), np.repeat(side, count), np.repeat(rgba, count, axis=0)))


# ------------------------------------------------------------------------------------------ picture

def reach_of(run, numbers, axes):
    """Box of all frames along right, up, towards: two rows."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for number in numbers:
        for body in run.bodies(number):
            x = body.x if body.nodes is None else body.nodes
            if run.frame != "3d":  # a ring reaches as far in every direction
                r = np.abs(x[:, 0]).max()
                x = np.array([[sx * r, sy * r, z] for sx in (-1, 1) for sy in (-1, 1) for z in (x[:, 2].min(), x[:, 2].max())])
            seen = x @ axes.T
            pad = body.side.max()
            low, high = np.minimum(low, seen.min(axis=0) - pad), np.maximum(high, seen.max(axis=0) + pad)
    return low, high


def specks(vtk, surfaces, height):
    for places, side, rgba in surfaces.specks:
        data = vtk.vtkPolyData()
        points = vtk.vtkPoints()
        points.SetData(surfaces.array(places, "places"))
        data.SetPoints(points)
        data.GetPointData().AddArray(surfaces.array(np.maximum(side, LEAST * height), "side"))
        data.GetPointData().AddArray(surfaces.array((255 * rgba[:, :3]).round().astype(np.uint8), "colours"))
        cube = vtk.vtkCubeSource()
        mapper = vtk.vtkGlyph3DMapper()
        mapper.SetInputData(data)
        mapper.SetSourceConnection(cube.GetOutputPort())
        mapper.SetScaleArray("side")
        mapper.SetScaleModeToScaleByMagnitude()
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray("colours")
        yield mapper


def render(run, bodies, colouring, view, reach, size):
    """An array of so many pixels (height, width, 3), and metres per pixel."""
    vtk = ready()
    axes = view_axes(view)
    low, high = reach
    width, height = size
    tall = 1.06 * max(high[1] - low[1], (high[0] - low[0]) * height / width)
    surfaces = Surfaces(vtk, run, bodies, colouring)
    scene = vtk.vtkRenderer()
    scene.SetBackground(1, 1, 1)
    mappers = [(mapper, False) for mapper in specks(vtk, surfaces, tall)]
    for data, cells, lines in surfaces.meshes:
        normals = vtk.vtkPolyDataNormals()
        normals.SetInputData(data)
        normals.SetFeatureAngle(40)
        normals.ConsistencyOff()
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputConnection(normals.GetOutputPort())
        mapper.SetScalarModeToUseCellData() if cells else mapper.SetScalarModeToUsePointData()
        mappers.append((mapper, lines and data.GetNumberOfCells() < 20000))
    for mapper, lines in mappers:
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        look = actor.GetProperty()
        look.SetAmbient(0.35)
        look.SetDiffuse(0.65)
        look.SetSpecular(0.05)
        look.SetEdgeVisibility(bool(lines))
        look.SetEdgeColor(0.2, 0.2, 0.2)
        look.SetLineWidth(0.6)
        scene.AddActor(actor)
    middle = (0.5 * (low + high)) @ axes
    camera = scene.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*middle)
    camera.SetPosition(*(middle + 10 * tall * axes[2]))
    camera.SetViewUp(*axes[1])
    camera.SetParallelScale(0.5 * tall)
    scene.ResetCameraClippingRange()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(width, height)
    window.AddRenderer(scene)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    image = surfaces.np.vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).reshape(height, width, 3)[::-1].copy()
    window.Finalize()
    return image, tall / height
