"""Fetches pictures of the frame before where their surfaces are now."""

import torch
from torch.nn import functional

from . import clips


def carried(image, motion):
    """Returns a picture (batch, channels, rows, columns) of the frame before, bilinearly fetched at each pixel's
    position plus its motion (clips.Frame.motion), and where that is valid (batch, 1, rows, columns): where there is
    motion and it does not lead out of the picture."""
    rows, columns = image.shape[2:]
    none = motion.abs().amax(1, keepdim=True) > clips.MOST_MOTION
    motion = motion.masked_fill(none, 0)
    y, x = torch.meshgrid(torch.arange(rows, device=image.device), torch.arange(columns, device=image.device),
                          indexing="ij")
    x, y = x + motion[:, 0], y + motion[:, 1]
    inside = (x >= 0) & (x <= columns - 1) & (y >= 0) & (y <= rows - 1)
    # grid_sample counts from -1 to 1 between the centres of the first and the last pixel.
    places = torch.stack([x / max(columns - 1, 1), y / max(rows - 1, 1)], -1) * 2 - 1
    fetched = functional.grid_sample(image, places, mode="bilinear", padding_mode="border", align_corners=True)
    return fetched, inside.unsqueeze(1) & ~none
