"""plm resume: goes on with the curve that plm response --save-every has left, and finishes the response."""
from . import response


def run(settings, console):
    response.run(settings, console, resumes=True)
