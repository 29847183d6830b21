"""Integrals with an error that can be believed."""

from steradian.integration.adaptive import Adapted, Iteration, adapt
from steradian.integration.errors import IntegrandError, IntegrationWarning, SupportError
from steradian.integration.estimate import Estimate
from steradian.integration.estimators import integrate, mis_integrate, ris_integrate
from steradian.integration.requests import IntegrationProgress

__all__ = [
    "Adapted",
    "Estimate",
    "IntegrandError",
    "IntegrationProgress",
    "IntegrationWarning",
    "Iteration",
    "SupportError",
    "adapt",
    "integrate",
    "mis_integrate",
    "ris_integrate",
]
