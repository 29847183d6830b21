"""What ``benches/integrals.py`` measures, in the environment that it makes."""
