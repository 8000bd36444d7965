#!/usr/bin/env python3
"""Draws the motion of a .vtu series as plm response and plm.fe.write_vtu_series leave it, with VTK, off the screen.

    plot_motion.py SERIES.pvd PICTURE.png [--frame N] [--scale FACTOR] [--view ELEVATION AZIMUTH] [--zoom FACTOR] [--at X Y Z]
                   [--unit UNIT] [--size WIDTH HEIGHT]

The surface of the mesh, moved by its displacement times FACTOR (by default the largest displacement is a tenth of the size), in the
colours of how far it moves, and the outline of the structure at rest. Without --frame: when contact is widest open, by the mean
penetration of all pairs. A dot stands at each node of contact, dark where it is closed and white where it is open. --at: the place
looked at, else the middle of the structure.

VTK as Debian builds it draws through an X server, in memory if there is no screen: the script then runs itself in xvfb-run (of the
package xvfb).
"""
import argparse
import os
import pathlib
import shutil
import sys
import xml.etree.ElementTree

import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

CIVIDIS = ((0.0, 0.135, 0.305), (0.25, 0.42, 0.43), (0.5, 0.486, 0.483), (0.725, 0.670, 0.420), (0.995, 0.908, 0.217))


def frames_of(series):
    """[(time, path)] of a .pvd."""
    root = xml.etree.ElementTree.parse(series).getroot()
    return [(float(one.get("timestep")), series.parent / one.get("file")) for one in root.iter("DataSet")]


def read(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def widest_open(frames):
    """The number of the frame whose contact is open most."""
    means = []
    for _, path in frames:
        penetration = read(path).GetPointData().GetArray("penetration")
        if penetration is None:
            return 0
        means.append(numpy.nanmean(vtk_to_numpy(penetration)))
    return int(numpy.argmin(means))


def colours(largest):
    table = vtk.vtkLookupTable()
    ramp = vtk.vtkColorTransferFunction()
    for i, colour in enumerate(CIVIDIS):
        ramp.AddRGBPoint(i / (len(CIVIDIS) - 1), *colour)
    table.SetNumberOfTableValues(256)
    for i in range(256):
        table.SetTableValue(i, *ramp.GetColor(i / 255), 1)
    table.SetRange(0, largest or 1)
    return table


def moved_surface(grid, scale):
    """The surface of the moved mesh, without middle nodes on its edges' faces."""
    warp = vtk.vtkWarpVector()
    warp.SetInputData(grid)
    warp.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, "displacement")
    warp.SetScaleFactor(scale)
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputConnection(warp.GetOutputPort())
    surface.SetNonlinearSubdivisionLevel(0)
    length = vtk.vtkArrayCalculator()
    length.SetInputConnection(surface.GetOutputPort())
    length.AddVectorArrayName("displacement")
    length.SetFunction("mag(displacement)")
    length.SetResultArrayName("length")
    length.Update()
    return length.GetOutput()


def actor_of(data, colour=None, table=None, edges=False, width=1.0):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    if table:
        mapper.SelectColorArray("length")
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SetLookupTable(table)
        mapper.UseLookupTableScalarRangeOn()
    else:
        mapper.ScalarVisibilityOff()
        actor.GetProperty().SetColor(*colour)
    actor.GetProperty().SetLineWidth(width)
    actor.GetProperty().SetEdgeVisibility(edges)
    actor.GetProperty().SetEdgeColor(0.15, 0.15, 0.15)
    actor.GetProperty().SetAmbient(0.35)
    return actor


def outline(grid):
    """Sharp edges of the structure at rest."""
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.SetNonlinearSubdivisionLevel(0)
    edges = vtk.vtkFeatureEdges()
    edges.SetInputConnection(surface.GetOutputPort())
    edges.SetFeatureAngle(40)
    edges.ColoringOff()
    edges.Update()
    return edges.GetOutput()


def contact_dots(surface, closed, radius):
    """A ball at each node of contact whose state is `closed` (1 or 0)."""
    status = surface.GetPointData().GetArray("contact_status")
    points = vtk.vtkPoints()
    if status is not None:
        for i in numpy.flatnonzero(vtk_to_numpy(status) == closed).tolist():
            points.InsertNextPoint(surface.GetPoint(i))
    dots, ball, glyphs = vtk.vtkPolyData(), vtk.vtkSphereSource(), vtk.vtkGlyph3D()
    dots.SetPoints(points)
    ball.SetRadius(radius)
    ball.SetThetaResolution(16)
    ball.SetPhiResolution(16)
    glyphs.SetInputData(dots)
    glyphs.SetSourceConnection(ball.GetOutputPort())
    glyphs.ScalingOff()
    glyphs.Update()
    return glyphs.GetOutput()


def legend_of(table, title, height):
    """The bar of colours below the structure, with its title above it."""
    bar, words = vtk.vtkScalarBarActor(), vtk.vtkTextActor()
    bar.SetLookupTable(table)
    bar.SetTitle("")
    bar.SetNumberOfLabels(4)
    bar.SetLabelFormat("%.3g")
    bar.SetOrientationToHorizontal()
    bar.SetPosition(0.25, 0.02)
    bar.SetWidth(0.5)
    bar.SetHeight(0.09)
    bar.UnconstrainedFontSizeOn()
    words.SetInput(title)
    words.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    words.SetPosition(0.5, 0.12)
    words.GetTextProperty().SetJustificationToCentered()
    for text in (words.GetTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0, 0, 0)
        text.SetFontFamilyToArial()
        text.SetFontSize(int(height / 32))
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
    return bar, words


def draw(grid, given):
    displacement = vtk_to_numpy(grid.GetPointData().GetArray("displacement"))
    low, high = numpy.reshape(grid.GetBounds(), (3, 2)).T
    size, largest = (high - low).max(), numpy.linalg.norm(displacement, axis=1).max()
    scale = given.scale or (0.1 * size / largest if largest else 1.0)
    surface, table = moved_surface(grid, scale), colours(largest)
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor_of(surface, table=table, edges=True))
    renderer.AddActor(actor_of(outline(grid), (0.45, 0.45, 0.45), width=2))
    dot = 0.006 * size / given.zoom
    renderer.AddActor(actor_of(contact_dots(surface, 1, dot), (0.83, 0.37, 0.0)))
    renderer.AddActor(actor_of(contact_dots(surface, 0, dot), (1.0, 1.0, 1.0)))
    unit = f" ({given.unit})" if given.unit else ""
    for part in legend_of(table, f"displacement{unit}, drawn {scale:.3g} times", given.size[1]):
        renderer.AddActor2D(part)
    elevation, azimuth = numpy.radians(given.view)
    camera, middle = renderer.GetActiveCamera(), (low + high) / 2 if given.at is None else numpy.array(given.at)
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*middle)
    camera.SetPosition(*(middle + size * numpy.array([numpy.cos(elevation) * numpy.cos(azimuth),
                                                      numpy.cos(elevation) * numpy.sin(azimuth), numpy.sin(elevation)])))
    camera.SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    camera.SetFocalPoint(*middle)
    camera.Zoom(1.15 * given.zoom)
    renderer.ResetCameraClippingRange()
    save(renderer, given)


def save(renderer, given):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*given.size)
    window.AddRenderer(renderer)
    window.Render()
    image, cut, writer = vtk.vtkWindowToImageFilter(), vtk.vtkExtractVOI(), vtk.vtkPNGWriter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    image.Update()
    cut.SetInputConnection(image.GetOutputPort())
    cut.SetVOI(*without_margins(image.GetOutput()), 0, 0)
    writer.SetInputConnection(cut.GetOutputPort())
    writer.SetFileName(str(given.picture))
    writer.Write()


def without_margins(image, margin=15):
    """The columns and rows of a picture that are not white, with a margin."""
    width, height, _ = image.GetDimensions()
    drawn = (vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1) < 250).any(axis=2)
    limits = []
    for n, places in ((width, numpy.flatnonzero(drawn.any(axis=0))), (height, numpy.flatnonzero(drawn.any(axis=1)))):
        limits += [max(places[0] - margin, 0), min(places[-1] + margin, n - 1)]
    return limits


def need_display():
    """Goes on in a server in memory where there is none; VTK would end the process."""
    if os.environ.get("DISPLAY") or not hasattr(vtk, "vtkXOpenGLRenderWindow"):
        return
    if shutil.which("xvfb-run") is None:
        sys.exit("there is no display to draw through: install xvfb, or set DISPLAY")
    os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", "-screen 0 1600x1200x24", sys.executable, *sys.argv])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("series", type=pathlib.Path)
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("--frame", type=int, help="number of the frame, from 0")
    parser.add_argument("--scale", type=float, help="factor on the displacement")
    parser.add_argument("--view", type=float, nargs=2, default=(35, -60), metavar=("ELEVATION", "AZIMUTH"), help="degrees")
    parser.add_argument("--zoom", type=float, default=1.0, help="1: the whole structure with some space around it")
    parser.add_argument("--at", type=float, nargs=3, metavar=("X", "Y", "Z"), help="the place looked at")
    parser.add_argument("--unit", default="", help="of the displacement, for the legend")
    parser.add_argument("--size", type=int, nargs=2, default=(1400, 900), metavar=("WIDTH", "HEIGHT"), help="pixels")
    given = parser.parse_args()
    frames = frames_of(given.series)
    number = widest_open(frames) if given.frame is None else given.frame
    if not 0 <= number < len(frames):
        sys.exit(f"{given.series} has the frames 0 to {len(frames) - 1}, not {number}")
    need_display()
    draw(read(frames[number][1]), given)


if __name__ == "__main__":
    main()
