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
    no other name, on no point and on none of `lines`, pairs of arrays (x, y) as they are drawn. One without a free place is
    left out. Returns those left out.

        left_out = plm.plot.name_points(ax, [(1.3, 0.42, "coarse"), (2.3, 0.006, "default")])
    """
    ax.figure.draw_without_rendering()  # lays the axes out: only then is known where a point lies on the page
    renderer = ax.figure._get_renderer()
    pixel = ax.figure.dpi / 72
    dots = [ax.transData.transform(point[:2]) for point in points]
    taken = [Bbox.from_bounds(x - 3 * pixel, y - 3 * pixel, 6 * pixel, 6 * pixel) for x, y in dots]
    paths = [Path(ax.transData.transform(numpy.transpose(line))) for line in lines]
    frame = ax.get_window_extent(renderer)
    left_out = []
    for x, y, name, *colour in points:
        for far, right, up in _places():
            side = "left" if right > 0 else "right" if right < 0 else "center"
            height = "bottom" if up > 0 else "top" if up < 0 else "center"
            note = ax.annotate(name, (x, y), xytext=(right, up), textcoords="offset points", ha=side, va=height,
                               color=colour[0] if colour else "k",
                               arrowprops={"arrowstyle": "-", "lw": 0.5, "color": FAINT, "shrinkA": 0, "shrinkB": 2} if far >= _FAR
                               else None)
            note.set_in_layout(False)  # inside the axes anyway
            box = _box_of(note, renderer)
            if frame.x0 < box.x0 and box.x1 < frame.x1 and frame.y0 < box.y0 and box.y1 < frame.y1 and not any(
                    box.overlaps(other) for other in taken) and not any(
                        path.intersects_bbox(box, filled=False) for path in paths):
                taken.append(box)
                break
            note.remove()
        else:
            left_out.append(name)
    return left_out


def _box_of(note, renderer):
    """Of the text alone, without the line to its point."""
    note.update_positions(renderer)
    return Text.get_window_extent(note, renderer)
