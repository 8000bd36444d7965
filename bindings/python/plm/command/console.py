"""What is said to the user: results on the standard output, messages on the standard error."""
import contextlib
import re
import shutil
import sys
import textwrap
import warnings

from .. import _functions as constants
from .._context import Context
from .._errors import PlmError, PlmWarning
from ..fe.errors import FileError

# what is worth knowing and takes nothing from the result
_HARMLESS = {constants.REASON_ROUNDED, constants.REASON_NO_SWITCHING}


def _to_stderr(text):
    """One line, for programs that read it; on a terminal as many as it takes."""
    if sys.stderr.isatty():
        text = textwrap.fill(text, max(shutil.get_terminal_size().columns - 1, 40), subsequent_indent="     ", break_on_hyphens=False)
    print(text, file=sys.stderr)


# what the library calls its options, in the words of the command
_WORDS = (("raise the effort of the context", "raise --effort (0: no limit)"),
          (r"spent before there was a result; raise effort", "spent before there was a result; raise --effort (0: no limit)"),
          (r"window_min_hz and window_max_hz of a sampler|\(frequency_min_hz, frequency_max_hz\)",
           "--frequency-min-hz and --frequency-max-hz"),
          (r'\("mode"\s+or\s+"mode_frequency_hz"\)', "by --frequency-min-hz and --frequency-max-hz around it"),
          ("were not looked for: find_isolated and find_by_marching do", "were not looked for; without a range they are"))
_FUNCTION = r"\bplm_[a-z0-9_]+: "  # which refused or warned: nothing that the command's user has called
_DOFS = r"\bDOFs? (\d+(?:(?:, | and )\d+)*)(?:\s+\(counted\s+from\s+0\)|,\s+counted\s+from\s+0(?=\)))?"


def in_words_of_the_command(text, name_of=None):
    """A message of the library, with the options that its reader has; name_of: of DOFs by their numbers, where the nodes are known."""
    text = re.sub(_FUNCTION, "", text)
    for library, command in _WORDS:  # a page breaks its lines, and advice may begin a sentence
        text = re.sub(library.replace(" ", r"\s+"), lambda found, command=command: command[0].upper() + command[1:]
                      if found[0][0].isupper() else command, text, flags=re.I)
    if name_of is not None:
        text = re.sub(_DOFS, lambda found: re.sub(r"\d+", lambda dof: name_of(int(dof[0])), found[1]), text)
    return text


def _says_nothing_but(findings, text):
    for finding in findings:
        text = text.replace(finding.text, "")
    return bool(findings) and not re.sub(r"^plm_\w+:", "", text).strip(" ;")


class Console:
    """Collects what the library says in a run: `warnings` (texts), `log` (of level, text), and whether one of them matters."""

    def __init__(self, quiet=False):
        self.quiet = quiet
        self.warnings, self.log, self.notes = [], [], []
        self.matters = False
        self.name_of = None  # of DOFs, as soon as the nodes are known
        self.context = Context(log=lambda level, text: self.log.append((level, text)))
        self.progress = sys.stderr.isatty() and not quiet

    def in_words(self, text):
        """A text of the library as the user of the command understands it."""
        return in_words_of_the_command(text, self.name_of)

    def say(self, text):
        """A result."""
        print(self.in_words(text), flush=True)

    def note(self, text):
        """Something the command did by itself."""
        self.notes.append(text)
        if not self.quiet:
            _to_stderr(f"plm: {text}")

    def warn(self, text, matters=True):
        """Something that should be looked at; every text once."""
        text = self.in_words(text)
        self.matters = self.matters or matters
        if text not in self.warnings:
            self.warnings.append(text)
            _to_stderr(f"plm: warning: {text}")

    @contextlib.contextmanager
    def explaining(self):
        """What the library refuses inside is refused in the words of the command."""
        try:
            yield
        except (PlmError, FileError) as error:
            error.args = (self.in_words(str(error)),)
            raise

    @contextlib.contextmanager
    def listening(self, with_log=False, findings=()):
        """Warnings that are issued inside become messages, and none is lost when the work fails. with_log: also those of the log
        that no call repeats, which are worth a look where a response is computed. findings: a list that may be filled inside, of
        what is printed as a result: a warning that says nothing else is no message."""
        with warnings.catch_warnings(record=True) as issued:
            warnings.simplefilter("always")
            try:
                yield
            finally:
                for one in issued:
                    is_own = isinstance(one.message, PlmWarning)
                    if is_own and _says_nothing_but(findings, str(one.message)):
                        continue
                    self.warn(str(one.message), not (is_own and one.message.reason in _HARMLESS))
                if with_log:
                    self._tell_logged()

    def _tell_logged(self):
        for level, text in self.log:
            if level >= 2 and not any(self.in_words(text) in told for told in self.warnings):
                self.warn(text, matters=False)
