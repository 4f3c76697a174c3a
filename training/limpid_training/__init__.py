"""Trains the networks that Limpid denoises with."""
