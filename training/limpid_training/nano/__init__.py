"""Trains the network of Limpid's denoiser `nano`. docs/nano.md explains how to use this package."""
