"""Trains the networks of Limpid's denoisers: `kpcn` (docs/kpcn.md explains how), and in `nano` that of `nano`."""
