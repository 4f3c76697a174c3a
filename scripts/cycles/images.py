"""Creates images: textures as 8-bit PNG files, with the bottom row first; an environment as EXR."""

import os

import bpy
import numpy


def save_png(folder, name, rgba, data=False):
    """Saves an image as PNG and loads it. `rgba`: height x width x 4, values from 0 to 1 as stored in the file.
    `data`: the values are not sRGB."""
    image = new(name, rgba, False)
    image.filepath_raw, image.file_format = os.path.join(folder, name + ".png"), "PNG"
    image.save()
    loaded = bpy.data.images.load(image.filepath_raw)
    loaded.colorspace_settings.name = "Non-Color" if data else "sRGB"
    loaded.alpha_mode = "CHANNEL_PACKED"  # otherwise Cycles multiplies colours by alpha in 8 bits
    bpy.data.images.remove(image)
    return loaded


def new(name, rgba, is_float):
    height, width = rgba.shape[:2]
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=is_float)
    image.pixels.foreach_set(numpy.ascontiguousarray(rgba, numpy.float32).ravel())
    return image


def save_picture(path, rgb, kind="OPEN_EXR"):
    """Saves linear values as 32-bit EXR, or display values as JPEG. The top row is first."""
    rgba = numpy.concatenate([rgb[::-1], numpy.ones_like(rgb[..., :1])], axis=2)
    image = new("saved", rgba, True)
    scene = bpy.context.scene
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode = kind, "RGB"
    if kind == "OPEN_EXR":
        settings.color_depth = "32"
    else:
        settings.quality = 85
        scene.view_settings.view_transform = "Raw"
    image.save_render(path)
    bpy.data.images.remove(image)


def read_picture(path):
    """Returns an image file as height x width x 3, with the top row first."""
    image = bpy.data.images.load(path, check_existing=False)
    pixels = numpy.empty(image.size[0] * image.size[1] * 4, numpy.float32)
    image.pixels.foreach_get(pixels)
    result = pixels.reshape(image.size[1], image.size[0], 4)[::-1, :, :3].astype(float)
    bpy.data.images.remove(image)
    return result


def decoded(folder, image):
    """Returns the image as floats, decoded from sRGB, so that Cycles filters it after decoding, not before."""
    pixels = numpy.empty(image.size[0] * image.size[1] * 4, numpy.float32)
    image.pixels.foreach_get(pixels)
    rgba = pixels.reshape(image.size[1], image.size[0], 4)
    c = rgba[..., :3]
    rgba[..., :3] = numpy.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    path = os.path.join(folder, "decoded.exr")
    save_picture(path, rgba[::-1, :, :3])
    return bpy.data.images.load(path)


def checker(cells, size, dark, light, alpha=(1, 1)):
    """Returns a checkerboard. `dark` and `light` are the cells' colours, `alpha` their alphas."""
    at = numpy.arange(size) * cells // size
    odd = (at[:, None] + at[None, :]) % 2
    values = numpy.array([(*dark, alpha[0]), (*light, alpha[1])])
    return values[odd]


def random_texels(size, seed):
    rgba = numpy.ones((size, size, 4))
    rgba[..., :3] = numpy.random.default_rng(seed).uniform(0.05, 1.0, (size, size, 3))
    return rgba


def waves(size, count, height):
    """Returns a normal map of crossing waves. `height`: the steepest slope."""
    t = (numpy.arange(size) + 0.5) / size * 2 * numpy.pi * count
    x, y = height * numpy.cos(t)[None, :], height * numpy.cos(t)[:, None]
    normal = numpy.stack(numpy.broadcast_arrays(-x, -y, numpy.ones((size, size))), axis=2)
    normal /= numpy.linalg.norm(normal, axis=2, keepdims=True)
    return numpy.concatenate([normal * 0.5 + 0.5, numpy.ones((size, size, 1))], axis=2)


def sky(height):
    """Returns an environment, twice as wide as high: a gradient with a soft sun. The top row is first."""
    row, column = numpy.mgrid[0:height, 0:2 * height]
    theta, phi = (row + 0.5) / height * numpy.pi, ((column + 0.5) / height - 1) * numpy.pi
    ring = numpy.sin(theta)
    direction = numpy.stack([ring * numpy.sin(phi), numpy.cos(theta), -ring * numpy.cos(phi)], axis=2)
    sun = numpy.array([0.6, 0.6, 0.53])
    near = numpy.exp(40 * (direction @ (sun / numpy.linalg.norm(sun)) - 1))
    up = direction[..., 1:2]
    colors = numpy.where(up > 0, numpy.array([0.3, 0.5, 0.9]) * (0.4 + up), numpy.array([0.35, 0.3, 0.25]))
    return colors + near[..., None] * numpy.array([20.0, 16.0, 10.0])
