"""Sets of nodes and elements: labels, other sets by name, and those that are generated."""
import numpy

from .deck_lines import shown, whole
from .errors import FileError

LARGEST_SET = 10**7  # labels that one line may generate
SETS_DEEP = 100


class Names(dict):
    """A dictionary whose keys are names, alike in upper and lower case."""

    def __getitem__(self, name):
        return super().__getitem__(name.upper())

    def __contains__(self, name):
        return super().__contains__(name.upper())

    def get(self, name, default=None):
        return super().get(name.upper(), default)


class SetTable:
    """Definitions as they are read; a set may name others that come later in the deck.

    add(name, labels, line) and add_lines(block, name, scope) collect, labels_of(name) resolves."""

    def __init__(self, what):
        self.what, self.items, self.done, self.open = what, {}, Names(), []

    def add(self, name, labels, line):
        self.items.setdefault(name, []).append((labels, line))

    def add_lines(self, block, name, scope):
        """Data lines of *NSET and *ELSET. scope: the one in which their labels and names count."""
        self.items.setdefault(name, [])
        if "GENERATE" in block:
            for line in block.lines:
                self.add(name, self._generated(line) + scope.shift, line)
            return
        for line in block.lines:
            labels = [whole(field) for field in line.fields]
            known = [label for label in labels if label is not None]
            if known:
                self.add(name, numpy.array(known, dtype=numpy.int64) + scope.shift, line)
            for label, field in zip(labels, line.fields):
                if label is None and field:
                    self.add(name, (field.strip("\"'").strip(), scope), line)

    def _generated(self, line):
        first, last = line.integer(0, "the first label"), line.integer(1, "the last label")
        step = line.integer(2, "the increment", 1)
        if step < 1 or last < first:
            line.fail(f"labels from {first} to {last} by {step}: there are none; first <= last, and an increment above 0")
        if (last - first) // step >= LARGEST_SET:
            line.fail(f"labels from {first} to {last} by {step} are more than {LARGEST_SET}")
        return numpy.arange(first, last + 1, step, dtype=numpy.int64)

    def find(self, name, scope):
        """The full name of a set that a scope calls so; None where there is none."""
        for full in (scope.full(name), name.upper()):
            if full in self.items:
                return full
        return None

    def labels_of(self, full):
        """Sorted labels of a set, without those that come twice."""
        if full in self.done:
            return self.done[full]
        self.open.append(full)
        parts = [numpy.empty(0, dtype=numpy.int64)]
        for item, line in self.items[full]:
            if isinstance(item, tuple):
                other = self.find(*item)
                if other is None:
                    line.fail(f"there is no {self.what} set {shown(item[0])}")
                if other in self.open or len(self.open) > SETS_DEEP:
                    line.fail(f"the {self.what} set {shown(item[0])} contains itself, or sets nest more than {SETS_DEEP} deep")
                item = self.labels_of(other)
            parts.append(item)
        self.open.pop()
        self.done[full] = numpy.unique(numpy.concatenate(parts))
        return self.done[full]

    def resolve(self):
        """{full name: labels} of all."""
        for full in self.items:
            self.labels_of(full)
        return self.done

    def chosen(self, text, line, scope):
        """Labels that a field says: one label, or a set."""
        label = whole(text)
        if label is not None:
            return numpy.array([label + scope.shift], dtype=numpy.int64)
        text = text.strip("\"'").strip()
        full = self.find(text, scope)
        if full is not None:
            return self.labels_of(full)
        instance, dot, rest = text.rpartition(".")  # of Abaqus: instance.label
        label = whole(rest) if dot else None
        if label is not None and instance.upper() in scope.instances:
            return numpy.array([label + scope.instances[instance.upper()].shift], dtype=numpy.int64)
        raise FileError(line.file, line.number, f"there is no {self.what} set {shown(text)}")
