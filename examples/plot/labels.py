"""Short texts beside points of a plot, each in the first free place around its point."""
from matplotlib.transforms import Bbox


class Labels:
    """Add all points, draw the figure once, then place the texts. One without a free place is left out."""

    places = [(7, -3), (-7, -3), (0, 7), (0, -13), (7, 6), (7, -12), (-7, 6), (-7, -12), (12, 14), (-12, 14), (12, -20),
              (-12, -20), (0, 18), (0, -26), (20, 24), (-20, 24), (20, -32), (-20, -32)]

    def __init__(self, axes):
        self.axes = axes
        self.points, self.texts = [], []

    def add(self, x, y, text, color):
        self.points.append((x, y))
        self.texts.append((x, y, text, color))

    def place(self):
        renderer = self.axes.figure.canvas.get_renderer()
        dots = self.axes.transData.transform(self.points) if self.points else []
        taken = [Bbox.from_bounds(x - 4, y - 4, 8, 8) for x, y in dots]
        frame = self.axes.get_window_extent(renderer)
        for x, y, text, color in self.texts:
            for place in self.places:
                side = "left" if place[0] > 0 else "right" if place[0] < 0 else "center"
                note = self.axes.annotate(text, (x, y), xytext=place, textcoords="offset points", fontsize=7, ha=side,
                                          color=color)
                box = note.get_window_extent(renderer)
                inside = frame.x0 < box.x0 and box.x1 < frame.x1 and frame.y0 < box.y0 and box.y1 < frame.y1
                if inside and not any(box.overlaps(other) for other in taken):
                    taken.append(box)
                    break
                note.remove()
