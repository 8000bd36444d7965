"""The progress bar: tqdm's where it is installed, else a plain line on a terminal."""
import sys


class PlainBar:
    """One line that is written over."""

    def __init__(self):
        self._shown = None

    def __call__(self, stage, fraction):
        line = f"{stage}: {100 * fraction:3.0f} %"
        if line != self._shown and sys.stderr.isatty():
            sys.stderr.write("\r" + line.ljust(40))
            sys.stderr.flush()
        self._shown = line

    def close(self):
        if self._shown and sys.stderr.isatty():
            sys.stderr.write("\n")


class TqdmBar:
    """A tqdm bar in percent, whose text is the stage."""

    def __init__(self, tqdm):
        self._bar = tqdm(total=100, leave=False)

    def __call__(self, stage, fraction):
        self._bar.set_description(stage, refresh=False)
        self._bar.n = round(100 * fraction, 1)
        self._bar.refresh()

    def close(self):
        self._bar.close()


def make_bar():
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return PlainBar()
    return TqdmBar(tqdm)
