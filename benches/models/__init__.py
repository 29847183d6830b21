"""Scattering models' time per call, ours and Mitsuba's."""
