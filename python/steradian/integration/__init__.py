"""Integrals with an error that can be believed."""

from steradian.integration.errors import IntegrandError, IntegrationWarning, SupportError
from steradian.integration.estimate import Estimate
from steradian.integration.estimators import IntegrationProgress, integrate, mis_integrate, ris_integrate

__all__ = [
    "Estimate",
    "IntegrandError",
    "IntegrationProgress",
    "IntegrationWarning",
    "SupportError",
    "integrate",
    "mis_integrate",
    "ris_integrate",
]
