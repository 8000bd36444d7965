"""Names beside the points of a picture, each in the first free place around its point."""
import numpy
from matplotlib.path import Path
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from .style import FAINT, styled

_NEAR, _FAR = (5, 12, 20, 30), 12  # points of the page; from _FAR on a thin line leads to the name


def _places():
    for far in _NEAR:
        for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1), (0.8, 0.8), (0.8, -0.8), (-0.8, 0.8), (-0.8, -0.8)):
            yield far, far * x, far * y


@styled
def name_points(ax, points, lines=()):
    """Names beside points: rows of (x, y, name) or (x, y, name, colour). Each takes the first place that is inside the axes, on
    no other name, on no point and on none of `lines`, pairs of arrays (x, y) as they are drawn; nor does the thin line that leads to it
    cross a name or a point. One without a free place is left out. Returns those left out.

        left_out = plm.plot.name_points(ax, [(1.3, 0.42, "coarse"), (2.3, 0.006, "default")])
    """
    ax.figure.draw_without_rendering()  # lays the axes out: only then is known where a point lies on the page
    renderer = ax.figure._get_renderer()
    pixel = ax.figure.dpi / 72
    dots = [ax.transData.transform(point[:2]) for point in points]
    markers = [Bbox.from_bounds(x - 3 * pixel, y - 3 * pixel, 6 * pixel, 6 * pixel) for x, y in dots]
    names = []
    paths = [Path(ax.transData.transform(numpy.transpose(line))) for line in lines]
    frame = ax.get_window_extent(renderer)
    left_out = []
    for (x, y, name, *colour), dot in zip(points, dots):
        others = [marker for marker, other in zip(markers, dots) if not numpy.allclose(other, dot, atol=3 * pixel)]
        size = _size_of(ax, name, renderer)
        for far, right, up in _places():
            to_side, to_height = (numpy.sign(right) - 1) / 2, (numpy.sign(up) - 1) / 2
            box = Bbox.from_bounds(dot[0] + right * pixel + to_side * size[0], dot[1] + up * pixel + to_height * size[1], *size)
            lead = Path([dot, (box.p0 + box.p1) / 2]) if far >= _FAR else None  # drawn up to the name
            inside = frame.x0 < box.x0 and box.x1 < frame.x1 and frame.y0 < box.y0 and box.y1 < frame.y1
            covers = any(box.overlaps(other) for other in markers + names) or any(path.intersects_bbox(box, filled=False) for path in paths)
            crosses = lead is not None and any(lead.intersects_bbox(other) for other in others + names)
            if inside and not covers and not crosses:
                names.append(box)
                paths += [] if lead is None else [lead]
                _write(ax, name, (x, y), (right, up), colour[0] if colour else "k", far >= _FAR)
                break
        else:
            left_out.append(name)
    return left_out


def _size_of(ax, name, renderer):
    note = ax.text(0, 0, name)
    box = Text.get_window_extent(note, renderer)
    note.remove()
    return box.width, box.height


def _write(ax, name, xy, offset, colour, with_line):
    side, height = (("right", "center", "left")[int(numpy.sign(offset[0])) + 1], ("top", "center", "bottom")[int(numpy.sign(offset[1])) + 1])
    note = ax.annotate(name, xy, xytext=offset, textcoords="offset points", ha=side, va=height, color=colour,
                       arrowprops={"arrowstyle": "-", "lw": 0.5, "color": FAINT, "shrinkA": 0, "shrinkB": 2} if with_line else None)
    note.set_in_layout(False)  # inside the axes anyway
