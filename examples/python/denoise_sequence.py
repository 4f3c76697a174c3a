"""Denoises a noisy sequence that is made with NumPy, and prints the PSNR before and after.

    denoise_sequence.py [DEVICE]

A camera moves past three spheres on a floor. Each pixel's light is multiplied by a random number, as if it were an
estimate from one sample. No motion vectors are given: the scene is static, so Limpid can compute them from the
camera's matrices.
"""

import sys

import limpid
import numpy as np

WIDTH, HEIGHT, FRAMES, FOV = 320, 180, 16, 50.0
SPHERES = [((-1.6, 1.0, -0.5), 1.0, (0.8, 0.3, 0.2)), ((0.4, 0.7, 0.6), 0.7, (0.2, 0.6, 0.3)),
           ((1.9, 1.2, -1.0), 1.2, (0.3, 0.4, 0.8))]


def trace(view):
    """Traces rays through the pixels' centres; returns depth (0 where nothing is hit), normal and albedo."""
    half = np.tan(np.radians(FOV / 2))
    x = (2 * (np.arange(WIDTH) + 0.5) / WIDTH - 1) * half * WIDTH / HEIGHT
    y = (1 - 2 * (np.arange(HEIGHT) + 0.5) / HEIGHT) * half
    rays = np.stack([*np.meshgrid(x, y), np.full((HEIGHT, WIDTH), -1.0)], axis=2) @ view[:3, :3]
    rays /= np.linalg.norm(rays, axis=2, keepdims=True)
    eye = -view[:3, :3].T @ view[:3, 3]
    depth = np.where(rays[..., 1] < -1e-3, -eye[1] / np.minimum(rays[..., 1], -1e-3), np.inf)
    place = np.floor(eye + depth[..., None].clip(max=1e3) * rays).astype(int)
    albedo = np.where((place[..., [0]] + place[..., [2]]) % 2 == 0, 0.7, 0.3) * np.ones(3)
    normal = np.broadcast_to((0.0, 1.0, 0.0), rays.shape).copy()
    for centre, radius, color in SPHERES:
        away = eye - np.array(centre)
        b = rays @ away
        root = np.sqrt(np.maximum(b * b - away @ away + radius * radius, 0))
        hit = (root > 0) & (-b - root > 0) & (-b - root < depth)
        depth[hit] = (-b - root)[hit]
        normal[hit] = ((away + depth[..., None].clip(max=1e3) * rays) / radius)[hit]
        albedo[hit] = color
    depth[depth > 40] = 0
    return depth, normal, albedo


def psnr(test, truth):
    return -10 * np.log10(np.mean((np.clip(test, 0, 1) - np.clip(truth, 0, 1)) ** 2))


random = np.random.default_rng(1)
denoiser = limpid.Denoiser(WIDTH, HEIGHT, "svgf", device=sys.argv[1] if len(sys.argv) > 1 else None)
projection = limpid.perspective(FOV, WIDTH / HEIGHT)
for frame in range(FRAMES):
    view = limpid.look_at(eye=(-1 + 0.1 * frame, 2, 6), target=(0, 0.8, 0))
    depth, normal, albedo = trace(view)
    light = np.maximum(normal @ (0.36, 0.8, 0.48), 0)[..., None] + 0.1
    truth = np.where(depth[..., None] > 0, albedo * light, 0)
    noisy = truth * random.exponential(size=(HEIGHT, WIDTH, 1))
    clean = denoiser.denoise(noisy, normal, depth, albedo=albedo, view=view, projection=projection)
print(f"{denoiser.device.name}: PSNR {psnr(noisy, truth):.1f} dB before, {psnr(clean, truth):.1f} dB after")
