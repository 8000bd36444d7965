"""Where the other pages speak of a function: the sections of theory, choosing and the tutorials that name it in some language."""
import re

from plm_header import ROOT

DOCS = ROOT / "docs"
PAGES = {"getting-started": "Getting started", "tutorial": "Tutorial", "choosing": "Choosing", "beyond": "Beyond the first curve", "theory": "Theory",
         "embedding": "Embedding", "decks": "Decks and meshes", "exact-motions": "Exact motions"}

# What stands behind each kind of handle, where no section names a function.
BEHIND = {"status": [("choosing", "Symptom, cause, remedy")], "keys": [("choosing", "Accuracy and effort")],
          "context": [("embedding", "What a host hands over")], "model": [("theory", "Equations of motion")],
          "sampler": [("theory", "Evolution of the contact area"), ("choosing", "Basis and samples")],
          "basis": [("theory", "Piecewise-linear modes"), ("choosing", "Basis and samples")],
          "hbm": [("theory", "Harmonic balance"), ("choosing", "Exact motions or harmonics")],
          "branch": [("theory", "Paths")], "transient": [("theory", "Exact motions"), ("beyond", "Motion in time")],
          "study": [("choosing", "What costs what"), ("beyond", "Other methods")]}

# Theory of single functions, where the page speaks of the thing and not of the function.
THEORY = {"plm_model_solve_rest": "Rest", "plm_model_set_preload": "Rest", "plm_model_set_rest_force": "Rest", "plm_model_build": "Contact space",
          "plm_model_get_modes": "Contact space", "plm_model_count_modes": "Contact space", "plm_hbm_find_isolated": "Resonances and isolated branches",
          "plm_hbm_find_backbones": "Resonances and isolated branches", "plm_hbm_track_fold": "Paths", "plm_hbm_switch_branch": "Paths",
          "plm_hbm_sweep": "Paths", "plm_hbm_estimate_error": "Error estimate", "plm_hbm_refine_basis": "A basis for a tolerance",
          "plm_branch_get_multipliers": "Stability", "plm_transient_get_multipliers": "Stability", "plm_branch_get_full_residual": "Error estimate",
          "plm_branch_get_contact": "Event-exact forces", "plm_branch_get_coefficients": "Harmonic balance", "plm_basis_set_parent": "Reduced model",
          "plm_hbm_find_nonlinear_mode": "Resonances and isolated branches", "plm_model_compute_response": "Frequency window",
          "plm_basis_set_responses": "A basis for a tolerance", "plm_transient_find_periodic": "Exact motions"}


def anchor_of(heading):
    """As MkDocs makes it."""
    plain = re.sub(r"[`*]|\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[-\s]+", "-", re.sub(r"[^\w\s-]", "", plain).strip().lower())


def sections():
    """(page, title, text) of every section."""
    for page in PAGES:
        text = (DOCS / f"{page}.md").read_text(encoding="utf-8")
        for part in re.split(r"^##+ ", text, flags=re.M)[1:]:
            title, _, body = part.partition("\n")
            yield page, title.strip(), body


class Explained:
    def __init__(self, methods):
        """methods: {described name: names that no other function has, in any language}."""
        self.sections = list(sections())
        self.titles = {(page, title) for page, title, _ in self.sections}
        self.methods = methods

    def of(self, name, noun):
        """[(page, title)], at most five: what is named first."""
        words = {name, *self.methods.get(name, ())}
        pattern = re.compile("|".join(rf"\b{re.escape(word)}(?:_i(?:32|64))?\b(?=\(|`)" for word in sorted(words)))
        found = [(page, title) for page, title, body in self.sections if pattern.search(body)]
        theory = [("theory", THEORY[name])] if name in THEORY else []
        chosen = list(dict.fromkeys(theory + found))
        if not any(page in ("theory", "choosing", "embedding") for page, _ in chosen):
            chosen += BEHIND[noun]
        for one in chosen:
            if one not in self.titles:
                raise SystemExit(f"docs/reference/explained.py: {one[0]}.md has no section '{one[1]}'")
        first = sorted(chosen, key=lambda one: one[0] not in ("theory", "choosing"))
        return first[:5]

    @staticmethod
    def link(page, title, from_folder="../"):
        return f"[{PAGES[page]}: {title}]({from_folder}{page}.md#{anchor_of(title)})"
