/* Limpid's denoisers for C: they turn noisy frames into clean ones.
 *
 *     limpid_device* device;
 *     limpid_device_create(NULL, &device);                       // any Vulkan device, CPUs included
 *     limpid_denoiser_desc desc = {sizeof desc};
 *     desc.method = LIMPID_METHOD_SVGF;
 *     desc.width = 1280, desc.height = 720;
 *     limpid_denoiser* denoiser;
 *     limpid_denoiser_create(device, &desc, &denoiser);
 *     limpid_host_frame frame = {sizeof frame};
 *     frame.inputs[LIMPID_INPUT_RADIANCE] = (limpid_host_image){pixels, 3};
 *     ...
 *     limpid_denoise_host(denoiser, &frame);
 *
 * Programs with a Vulkan device of their own can record into their own command buffers: see denoise_vulkan.h. C++
 * programs can use denoise.hpp.
 *
 * General rules:
 * - Structs begin with `size`, which is the sizeof of the struct in the caller's version of this header. Zero is the
 *   default of every other member, so `limpid_denoiser_desc desc = {sizeof desc};` is complete. Later versions append
 *   members.
 * - Functions return a limpid_result and throw no exceptions. limpid_last_error() describes the calling thread's last
 *   failure.
 * - Strings are UTF-8. Memory that is passed in is only read during the call.
 * - Only one thread at a time may use a denoiser. Several threads may use several denoisers, even on one device.
 * - Nothing is logged or printed, and no environment variable is read.
 * - Pixels: row 0 is the top row; pixel centres are at +0.5. Radiance is linear.
 */
#ifndef LIMPID_DENOISE_H
#define LIMPID_DENOISE_H

#include <stddef.h>
#include <stdint.h>

#if defined(LIMPID_STATIC)
#define LIMPID_API
#else
#define LIMPID_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The version of this header; limpid_version() returns the library's. Minor versions only add features. */
#define LIMPID_VERSION_MAJOR 0
#define LIMPID_VERSION_MINOR 2
#define LIMPID_VERSION_PATCH 0

/* Returns 10000 major + 100 minor + patch. */
LIMPID_API uint32_t limpid_version(void);

typedef enum limpid_result {
    LIMPID_OK = 0,
    LIMPID_ERROR_INVALID_ARGUMENT = 1, /* a null pointer, a wrong size, an unknown name, a missing input */
    LIMPID_ERROR_UNSUPPORTED = 2,      /* the device lacks a required feature */
    LIMPID_ERROR_OUT_OF_MEMORY = 3,    /* on the device or the host */
    LIMPID_ERROR_DEVICE_LOST = 4,      /* destroy everything that was created on the device */
    LIMPID_ERROR_FAILED = 5,           /* anything else */
    LIMPID_ERROR_UNREADABLE = 6        /* an input file is missing or damaged (neural.h, shot.h) */
} limpid_result;

/* Describes the calling thread's last failure; "" if there was none. Valid until the thread's next call. */
LIMPID_API const char* limpid_last_error(void);

/* ---------------------------------------------------------------- devices */

typedef struct limpid_device limpid_device;

typedef enum limpid_message_level {
    LIMPID_MESSAGE_DEBUG = 0,
    LIMPID_MESSAGE_INFO = 1,
    LIMPID_MESSAGE_WARNING = 2,
    LIMPID_MESSAGE_ERROR = 3
} limpid_message_level;

/* May be called from any thread that calls the library, and from the Vulkan driver's threads. */
typedef void (*limpid_message_callback)(void* user, limpid_message_level level, const char* message);

typedef struct limpid_device_desc {
    size_t size;
    /* NULL or "": the best device (discrete before integrated before CPU); "cpu": a software device; a number: the
     * device with that index; anything else: the first device whose name contains it, ignoring case. */
    const char* select;
    /* Not 0: Vulkan's validation layer checks every call and reports to `message`. Slow. */
    int32_t validation;
    limpid_message_callback message;
    void* message_user;
} limpid_device_desc;

/* Opens a Vulkan device. `desc` may be NULL. Returns LIMPID_ERROR_UNSUPPORTED if no device is suitable; the message
 * lists the available ones. `*device` is NULL on failure. */
LIMPID_API limpid_result limpid_device_create(const limpid_device_desc* desc, limpid_device** device);
/* Destroy all denoisers on the device first. NULL is ignored. */
LIMPID_API void limpid_device_destroy(limpid_device* device);
/* Returns the name that the driver reports. Valid as long as the device. */
LIMPID_API const char* limpid_device_name(const limpid_device* device);

/* Returns the driver's compiled pipelines. Store them and load them in the next run of the program, so that nothing is
 * compiled again. Sets `size` to the number of bytes. With `data` not NULL, `size` says beforehand how many bytes fit
 * there, and all are written; if they do not fit, none, and LIMPID_ERROR_INVALID_ARGUMENT is returned: another thread
 * may have made pipelines since `size` was asked for, so try again. */
LIMPID_API limpid_result limpid_device_pipeline_cache(const limpid_device* device, void* data, size_t* size);
/* Call it before the first denoiser is created. Ignores data that is damaged, or from another device or driver. */
LIMPID_API limpid_result limpid_device_load_pipeline_cache(limpid_device* device, const void* data, size_t size);

/* -------------------------------------------------------------- denoisers */

typedef struct limpid_denoiser limpid_denoiser;

typedef enum limpid_method {
    LIMPID_METHOD_SVGF = 0,      /* spatiotemporal variance-guided filtering: the best without a network */
    LIMPID_METHOD_ATROUS = 1,    /* temporal accumulation, then the edge-avoiding a-trous filter */
    LIMPID_METHOD_TEMPORAL = 2,  /* temporal accumulation alone: each pixel's mean follows its surface */
    LIMPID_METHOD_BILATERAL = 3, /* a joint bilateral filter of one frame, without history: the simplest method */
    /* For ambient occlusion or a shadow mask alone: one number from 0 to 1 for each pixel, the first component of
     * LIMPID_INPUT_RADIANCE. It is COLOR as grey, limited to 0 to 1. Better for them than SVGF, in less time and
     * memory. For two masks, make two denoisers. */
    LIMPID_METHOD_VISIBILITY = 4,
    /* SVGF, and behind it a small trained network, which predicts the weights of a filter and how much of SVGF's
     * result to replace. Inputs, outputs and `signals` are those of SVGF, and its parameters `svgf.` count, too.
     * Closer to the truth, about as stable, slower. Light should be exposed so that white is about 1, and distances be
     * in metres. Needs no files. */
    LIMPID_METHOD_NANO = 5,
    /* The same with a network of ten times as many operations: for sequences offline and for stills, of 1 to 64
     * samples a pixel. Slow on CPUs. */
    LIMPID_METHOD_FILM = 6
} limpid_method;

/* The images of a frame, by content. docs/embedding.md lists which ones a method needs, and the effect of leaving one
 * out. */
typedef enum limpid_input {
    LIMPID_INPUT_RADIANCE = 0,          /* rgb: light scattered towards the eye; with two signals diffuse light.
                                           Required. Any unit, but filters keep light divided by albedo in half
                                           precision: scale it if much of that is above 65504 (it is cut off) or
                                           below 1e-5 (it is rounded to multiples of 6e-8).
                                           r alone: visibility, with LIMPID_METHOD_VISIBILITY. */
    LIMPID_INPUT_SPECULAR = 1,          /* rgb: specular light. Required with two signals. */
    LIMPID_INPUT_EMISSION = 2,          /* rgb: directly visible emitters and sky; not filtered */
    LIMPID_INPUT_ALBEDO = 3,            /* rgb: diffuse albedo including textures, 0 to 1 */
    LIMPID_INPUT_ALBEDO_SPECULAR = 4,   /* rgb: pre-integrated reflectance of the specular lobe, 0 to 1 */
    LIMPID_INPUT_NORMAL = 5,            /* limpid_normal_encoding, limpid_space. Required. */
    LIMPID_INPUT_DEPTH = 6,             /* limpid_depth. Required. */
    LIMPID_INPUT_MOTION = 7,            /* limpid_motion_unit etc. If missing, only the camera moves. */
    LIMPID_INPUT_PREVIOUS_NORMAL = 8,   /* like NORMAL, for the same surface point in the previous frame */
    LIMPID_INPUT_REFLECTION_MOTION = 9, /* like MOTION, for the image that the surface reflects */
    LIMPID_INPUT_ID = 10,               /* r: a number for each object (Vulkan: unsigned integers) */
    /* r: roughness of the specular lobe, 0 to 1: the square root of the microfacet distribution's alpha; negative or
     * NaN: unknown. Keeps patterns of gloss and glossy bumps sharp. */
    LIMPID_INPUT_ROUGHNESS = 11,
    /* r: length of the ray that found the specular light, from the surface to its first hit, world units. 1e9 or more:
     * it hit nothing; 0, negative or NaN: unknown. Needs ROUGHNESS. If REFLECTION_MOTION is missing, the motion of
     * reflections is computed from it. */
    LIMPID_INPUT_HIT_DISTANCE = 12,
    /* r: with limpid_denoiser_desc::samples, the variance of RADIANCE's luminance (0.2126 r + 0.7152 g + 0.0722 b): of
     * the pixel's mean, which is s^2 / N, s^2 being the variance of its N samples. NaN, infinite or negative: 0. SVGF,
     * NANO and FILM take the noise of a history's first frames from it, instead of from the pixels around. */
    LIMPID_INPUT_RADIANCE_VARIANCE = 13,
    LIMPID_INPUT_SPECULAR_VARIANCE = 14, /* the same of SPECULAR: with that, both or none */
    LIMPID_INPUT_MAX = 32                /* room for more */
} limpid_input;

typedef enum limpid_output {
    LIMPID_OUTPUT_COLOR = 0,    /* rgb: the denoised picture including emission and albedo; a: 1 */
    LIMPID_OUTPUT_RADIANCE = 1, /* rgb: the denoised LIMPID_INPUT_RADIANCE. SVGF and NANO only. */
    LIMPID_OUTPUT_SPECULAR = 2, /* rgb: the denoised LIMPID_INPUT_SPECULAR. The same with two signals only. */
    LIMPID_OUTPUT_MAX = 8       /* room for more */
} limpid_output;

typedef enum limpid_normal_encoding {
    LIMPID_NORMAL_SIGNED = 0,            /* xyz, -1 to 1 */
    LIMPID_NORMAL_UNORM = 1,             /* xyz, 0 to 1 for -1 to 1 */
    LIMPID_NORMAL_OCTAHEDRAL_SIGNED = 2, /* xy, -1 to 1 */
    LIMPID_NORMAL_OCTAHEDRAL_UNORM = 3   /* xy, 0 to 1 for -1 to 1 */
} limpid_normal_encoding;

typedef enum limpid_space {
    LIMPID_SPACE_WORLD = 0,
    LIMPID_SPACE_VIEW = 1 /* that of the frame's view matrix */
} limpid_space;

/* Values that mean a miss: 0 or below, not finite, or `far_depth` and beyond. */
typedef enum limpid_depth {
    LIMPID_DEPTH_DISTANCE = 0, /* along the pixel's ray, from the eye, world units */
    LIMPID_DEPTH_LINEAR = 1,   /* along the view axis, from the eye, world units; the sign is ignored */
    LIMPID_DEPTH_DEVICE = 2 /* depth-buffer values; the projection matrix defines them (reversed, infinite). A miss has
                               the far value: 0 if reversed, else 1. */
} limpid_depth;

typedef enum limpid_motion_unit {
    LIMPID_MOTION_PIXELS = 0, /* x points right and y down, whatever limpid_clip_y is */
    LIMPID_MOTION_UV = 1,     /* 1 is the width or height of the picture; v points down */
    LIMPID_MOTION_NDC = 2     /* 2 is the width or height; y as in clip space (limpid_clip_y) */
} limpid_motion_unit;

typedef enum limpid_motion_direction {
    LIMPID_MOTION_TO_PREVIOUS = 0,  /* position in the previous frame minus position now */
    LIMPID_MOTION_FROM_PREVIOUS = 1 /* position now minus position in the previous frame */
} limpid_motion_direction;

typedef enum limpid_motion_depth {
    LIMPID_MOTION_2D = 0, /* xy only: the change of depth is computed as if objects, and what reflects, stood still */
    LIMPID_MOTION_DISTANCE =
        1 /* z: the change of distance from the eye, world units, with the sign convention of xy */
} limpid_motion_depth;

typedef enum limpid_clip_y {
    LIMPID_CLIP_Y_DOWN = 0, /* Vulkan: y = -1 is the top row */
    LIMPID_CLIP_Y_UP = 1    /* OpenGL and Direct3D, or Vulkan with a flipped viewport: y = 1 is the top row */
} limpid_clip_y;

typedef struct limpid_denoiser_desc {
    size_t size;
    limpid_method method;
    uint32_t width, height; /* pixels of all images, 1 to 32768, and no more than the device's images may have */
    /* 0 or 1: RADIANCE is all light that is filtered. 2: RADIANCE is diffuse and SPECULAR specular light; takes up
     * to twice the time. */
    uint32_t signals;
    /* Not 0: radiance is already divided by albedo, and so are the outputs. The albedo inputs are then not needed, and
     * COLOR is the sum of the signals and emission. */
    int32_t demodulated;
    limpid_normal_encoding normal_encoding;
    limpid_space normal_space;
    limpid_depth depth;
    float far_depth; /* for LIMPID_DEPTH_DISTANCE and LINEAR; not negative; 0: 1e9 */
    limpid_motion_unit motion_unit;
    limpid_motion_direction motion_direction;
    limpid_motion_depth motion_depth;
    limpid_clip_y clip_y;
    /* With denoise_vulkan.h: the number of recorded frames not yet finished on the device, 1 to 8; 0: 2. */
    uint32_t frames_in_flight;
    /* Not 0: enables limpid_denoiser_timings(). */
    int32_t timings;
    /* Prefix of image and pass names in debuggers; NULL: "limpid/". */
    const char* name;
    /* Samples per pixel in each frame's light, 1 to 65536; 0: 1. Only counts in frames that have RADIANCE_VARIANCE,
     * which need 2 or more. */
    uint32_t samples;
} limpid_denoiser_desc;

/* Matrices are column-major as in GLSL, element [4 * column + row], and do not include jitter. The previous frame is
 * the last one that this denoiser took without an error: if you skip frames, give that one's matrices, and motion
 * since then, or set `reset`. */
typedef struct limpid_camera {
    float view[16]; /* from world to view space: a rotation (or reflection) and a translation, without scale */
    /* From view to clip space; depth 0 to 1. Perspective or orthographic, also off-centre. Depth must not depend on x
     * and y (no oblique near plane), and the clip volume of an orthographic one must not begin behind the eye: move
     * the eye back instead. */
    float projection[16];
    /* Of the previous frame. Not read in the first frame, after a cut or a new size, and by methods without history
     * (BILATERAL unless taa.frames is above 1). */
    float previous_view[16], previous_projection[16];
    /* Offset of the rays from the pixels' centres, pixels: -0.5 to 0.5; x points right and y down, whatever
     * limpid_clip_y is. */
    float jitter[2];
} limpid_camera;

/* Creates a denoiser, and compiles its pipelines on several threads if `device` does not have them yet. Its images are
 * created for the first frame; limpid_denoiser_memory() returns their size. `*denoiser` is NULL on failure.
 * LIMPID_ERROR_UNSUPPORTED: the device has no images of this size (its maxImageDimension2D), or no buffers that large
 * (maxStorageBufferRange, maxBufferSize, maxMemoryAllocationSize): they have 8 bytes a pixel on GPUs.
 * LIMPID_METHOD_NANO and LIMPID_METHOD_FILM have 32 and 96 on all devices, and compute the picture in parts where that
 * is too much. */
LIMPID_API limpid_result limpid_denoiser_create(limpid_device* device, const limpid_denoiser_desc* desc,
                                                limpid_denoiser** denoiser);
/* NULL is ignored. Everything it has recorded must be finished on the device. */
LIMPID_API void limpid_denoiser_destroy(limpid_denoiser* denoiser);

/* Returns the device memory in bytes that such a denoiser's images need at least; needs no device. `for_gpu` 0: on
 * CPUs. Drivers align images, and frames in flight need parameters, both of which come on top. Each of the outputs
 * RADIANCE and SPECULAR, if requested, takes another 16 bytes per pixel. */
LIMPID_API limpid_result limpid_denoiser_memory(const limpid_denoiser_desc* desc, int32_t for_gpu, uint64_t* bytes);

/* Changes the size of the frames that follow. History restarts. Fails like limpid_denoiser_create(), and changes
 * nothing then. */
LIMPID_API limpid_result limpid_denoiser_resize(limpid_denoiser* denoiser, uint32_t width, uint32_t height);
/* Marks a cut: the next frame starts without history. */
LIMPID_API limpid_result limpid_denoiser_reset(limpid_denoiser* denoiser);

/* ------------------------------------------------------------- parameters */

typedef enum limpid_parameter_type {
    LIMPID_PARAMETER_BOOL = 0,
    LIMPID_PARAMETER_INT = 1,
    LIMPID_PARAMETER_FLOAT = 2
} limpid_parameter_type;

typedef struct limpid_parameter {
    const char* name; /* "svgf.alpha" */
    limpid_parameter_type type;
    double default_value, minimum, maximum;
    const char* unit; /* "" if it has none */
    const char* help; /* one line: what it does, and the effect of a larger value */
} limpid_parameter;

/* Returns the parameters of a method by index, from 0 on; LIMPID_ERROR_INVALID_ARGUMENT beyond the last. Strings
 * have static storage: they are valid until the program ends. */
LIMPID_API limpid_result limpid_method_parameter(limpid_method method, uint32_t index, limpid_parameter* parameter);

/* Takes effect in the next frame. Bools are 0 and 1. Returns LIMPID_ERROR_INVALID_ARGUMENT if there is no such
 * parameter, the value is outside its range, or a bool or int is given a fraction. */
LIMPID_API limpid_result limpid_denoiser_set(limpid_denoiser* denoiser, const char* name, double value);
LIMPID_API limpid_result limpid_denoiser_get(const limpid_denoiser* denoiser, const char* name, double* value);

/* ---------------------------------------------------------------- frames */

/* Floats in host memory. */
typedef struct limpid_host_image {
    const float* data; /* NULL: the image is missing */
    /* Per pixel in memory: 3 or 4 for colours (LIMPID_METHOD_VISIBILITY: 1 to 4) and normals (octahedral: 2 to 4), 2
     * to 4 for motion (LIMPID_MOTION_DISTANCE: 3 or 4), 1 to 4 for all else. */
    uint32_t components;
    size_t pixel_stride; /* in bytes, from pixel to pixel; 0: components * 4 */
    size_t row_stride;   /* in bytes, from row to row; 0: width * pixel stride */
} limpid_host_image;

typedef struct limpid_host_output {
    float* data;         /* NULL: not requested */
    uint32_t components; /* 3 or 4; with LIMPID_METHOD_VISIBILITY also 1 */
    size_t pixel_stride, row_stride;
} limpid_host_output;

typedef struct limpid_host_frame {
    size_t size;
    limpid_host_image inputs[LIMPID_INPUT_MAX];
    limpid_host_output outputs[LIMPID_OUTPUT_MAX];
    limpid_camera camera;
    int32_t reset; /* not 0: a cut; history starts with this frame */
} limpid_host_frame;

/* Denoises one frame and waits for it, also without any output. Call it for frames in order. Not available on devices
 * of denoise_vulkan.h. LIMPID_ERROR_INVALID_ARGUMENT: an input is missing, an image has a wrong number of components,
 * the method does not have a requested output, or the camera is not as limpid_camera says. LIMPID_ERROR_OUT_OF_MEMORY,
 * LIMPID_ERROR_DEVICE_LOST. After INVALID_ARGUMENT the outputs are unchanged, and history does not advance: the next
 * frame follows the last one that succeeded. Only a cut (`reset`) may stay in effect. After other errors the outputs
 * are undefined; call limpid_denoiser_reset() before you go on. */
LIMPID_API limpid_result limpid_denoise_host(limpid_denoiser* denoiser, const limpid_host_frame* frame);

typedef struct limpid_timing {
    const char* pass; /* valid until the denoiser's next call */
    double milliseconds;
} limpid_timing;

/* Returns the device time of each pass of the latest frame known to be finished. With `timings` NULL, sets `count` to
 * the number of passes; otherwise writes up to `count` of them and sets `count` to the number written. */
LIMPID_API limpid_result limpid_denoiser_timings(limpid_denoiser* denoiser, limpid_timing* timings, uint32_t* count);

#ifdef __cplusplus
}
#endif
#endif
