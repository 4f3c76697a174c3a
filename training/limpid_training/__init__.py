"""Trains the kernel-predicting networks of Limpid's denoiser `kpcn`. docs/kpcn.md explains how to use this package."""
