"""Trains the networks of Limpid's denoisers `nano` and `film`. docs/nano.md explains how to use this package."""
