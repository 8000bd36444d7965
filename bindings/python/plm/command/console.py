"""What is said to the user: results on the standard output, messages on the standard error."""
import contextlib
import re
import shutil
import sys
import textwrap
import warnings

from .. import _functions as constants
from .._context import Context
from .._errors import PlmWarning

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
          ("were not looked for: find_isolated and find_by_marching do", "were not looked for; without a range and --save-every they are"))


def in_words_of_the_command(text):
    """A message of the library, with the options that its reader has."""
    for library, command in _WORDS:
        text = re.sub(library.replace(" ", r"\s+"), command, text)  # a page breaks its lines
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
        self.context = Context(log=lambda level, text: self.log.append((level, text)))
        self.progress = sys.stderr.isatty() and not quiet

    def say(self, text):
        """A result."""
        print(text, flush=True)

    def note(self, text):
        """Something the command did by itself."""
        self.notes.append(text)
        if not self.quiet:
            _to_stderr(f"plm: {text}")

    def warn(self, text, matters=True):
        """Something that should be looked at; every text once."""
        text = in_words_of_the_command(text)
        self.matters = self.matters or matters
        if text not in self.warnings:
            self.warnings.append(text)
            _to_stderr(f"plm: warning: {text}")

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
            if level >= 2 and not any(in_words_of_the_command(text) in told for told in self.warnings):
                self.warn(text, matters=False)
