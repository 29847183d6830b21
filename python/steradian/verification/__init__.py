"""Every check on every building block: what ``steradian verify`` runs.

    found = verification.run(["rough conductor"])
    found.holds

A block is a scattering model, a light, a distribution, a pixel filter, the weights of multiple importance
sampling, or a scene whose answer is known. Checks are that samples follow their density, that the density
integrates to one, that ``sample``, ``eval`` and ``pdf`` agree, that nothing of f is out of reach, that
energy and reciprocity hold, and that no parameter and no direction gives NaN. Blocks that are wrong on
purpose must be caught.
"""

from steradian.verification.found import Block, Failure, Flaw, Found, Row
from steradian.verification.page import page
from steradian.verification.run import blocks, run

__all__ = ["Block", "Failure", "Flaw", "Found", "Row", "blocks", "page", "run"]
