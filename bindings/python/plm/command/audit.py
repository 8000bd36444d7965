"""plm audit: what is probably not meant so."""
from .structure import assemble

_WORDS = ("", "look at   ", "wrong     ")


def run(settings, console):
    findings = []  # they are results, on the standard output alone: the build warns of the same
    with console.listening(findings=findings):
        structure = assemble(settings, console)
        structure.model.build(progress=console.progress)
        findings += structure.model.audit()
    for finding in sorted(findings, key=lambda one: -one.severity):  # what matters first, else as the library has them
        console.say(f"{_WORDS[finding.severity] or 'fact      '}{finding.text}")
    worst = [sum(finding.severity == severity for finding in findings) for severity in (2, 1)]
    console.say(f"{worst[0]} findings are probably wrong, {worst[1]} are worth a look, {len(findings) - sum(worst)} are facts")
    console.matters = console.matters or worst[0] > 0
