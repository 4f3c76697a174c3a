/* Limpid's kernel-predicting network for C: one frame of about 32 samples a pixel in, a clean picture out.
 *
 *     limpid_network* network;
 *     limpid_network_create(NULL, NULL, &network);               // any Vulkan device, the installed weights
 *     limpid_network_frame frame = {sizeof frame};
 *     frame.width = 1280, frame.height = 720, frame.samples = 32;
 *     frame.inputs[LIMPID_NETWORK_INPUT_DIFFUSE] = (limpid_host_image){diffuse, 3};
 *     frame.inputs[LIMPID_NETWORK_INPUT_DIFFUSE_VARIANCE] = (limpid_host_image){variance, 1};
 *     ...
 *     frame.color = (limpid_host_output){clean, 3};
 *     limpid_network_denoise(network, &frame);
 *
 * It is a library of its own, liblimpid-neural.so.0, which needs oneDNN and TBB, and does not need liblimpid.so.0.
 * C++ programs have neural.hpp. Types and rules are those of denoise.h, with these differences:
 * - limpid_network_last_error() tells of this library's failures, limpid_last_error() does not.
 * - Each network opens a device for itself.
 * - On CPUs the layers run on the threads of OpenMP and TBB, whose environment variables those libraries read.
 * docs/kpcn.md explains the method, its parameters and its memory.
 */
#ifndef LIMPID_NEURAL_H
#define LIMPID_NEURAL_H

#include <limpid/denoise.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The library's version, as limpid_version() has it; LIMPID_VERSION_* are the header's. */
LIMPID_API uint32_t limpid_network_version(void);

/* Of the calling thread's last failure in this library; "" if there was none. Valid until its next call. */
LIMPID_API const char* limpid_network_last_error(void);

/* --------------------------------------------------------------- networks */

typedef struct limpid_network limpid_network;

typedef struct limpid_network_desc {
    size_t size;
    /* The file of weights. NULL or "": those that are installed with the library; kpcn.cis565 says which of the two.
     */
    const char* weights;
    float far_depth; /* from here on nothing is seen; 0: 1e9 */
} limpid_network_desc;

/* Opens a device as limpid_device_create() does, and loads the weights onto it. Both descriptions may be NULL.
 * LIMPID_ERROR_UNSUPPORTED if no device fits, LIMPID_ERROR_UNREADABLE if the weights are missing or damaged. */
LIMPID_API limpid_result limpid_network_create(const limpid_device_desc* device, const limpid_network_desc* desc,
                                               limpid_network** network);
/* NULL is ignored. */
LIMPID_API void limpid_network_destroy(limpid_network* network);

/* The device, as its driver calls it. Valid as long as the network. */
LIMPID_API const char* limpid_network_device_name(const limpid_network* network);
/* How it is computed: "half precision, cooperative matrices", "single precision, oneDNN". Static storage: valid until
 * the program ends. */
LIMPID_API const char* limpid_network_precision(const limpid_network* network);

/* ------------------------------------------------------------- parameters */

/* From 0 on. LIMPID_ERROR_INVALID_ARGUMENT beyond the last. Strings have static storage: they are valid until the
 * program ends. */
LIMPID_API limpid_result limpid_network_parameter(uint32_t index, limpid_parameter* parameter);

/* As limpid_denoiser_set() and limpid_denoiser_get(). kpcn.half and kpcn.cis565 load the weights anew; if that fails,
 * the parameter keeps its value. kpcn.cis565 has no effect where limpid_network_desc names a file. */
LIMPID_API limpid_result limpid_network_set(limpid_network* network, const char* name, double value);
LIMPID_API limpid_result limpid_network_get(const limpid_network* network, const char* name, double* value);

/* ----------------------------------------------------------------- frames */

/* Images of a frame, each the mean over a pixel's samples, and the variances of these means: s^2 / N, s^2 being the
 * variance of N samples. Colours, albedo, normals: 3 or 4 components, of which the first 3 are read. */
typedef enum limpid_network_input {
    LIMPID_NETWORK_INPUT_DIFFUSE = 0,  /* rgb: diffuse light, textures in it. This or SPECULAR is needed. */
    LIMPID_NETWORK_INPUT_SPECULAR = 1, /* rgb: specular light. Without it: none. */
    LIMPID_NETWORK_INPUT_EMISSION = 2, /* rgb: what the camera sees directly (emitters, sky): added, not filtered.
                                          Without it: none. */
    LIMPID_NETWORK_INPUT_ALBEDO = 3,   /* rgb: diffuse albedo, 0 to 1, textures in it. Without it: 1. */
    LIMPID_NETWORK_INPUT_NORMAL = 4,   /* xyz: in world space, -1 to 1; 0 where there is none. Needed. */
    LIMPID_NETWORK_INPUT_DEPTH = 5,    /* r: distance from the eye, along the ray, world units. Where nothing is seen:
                                          0 or below, not finite, or far_depth and beyond. Needed. */
    LIMPID_NETWORK_INPUT_DIFFUSE_VARIANCE = 6,  /* r: of the luminance. Needed with DIFFUSE. */
    LIMPID_NETWORK_INPUT_SPECULAR_VARIANCE = 7, /* r: of the luminance. Needed with SPECULAR. */
    LIMPID_NETWORK_INPUT_ALBEDO_VARIANCE = 8,   /* r: of the luminance. Without it: 0, as of rays through the pixels'
                                                   centres. The same for the two that follow. */
    LIMPID_NETWORK_INPUT_NORMAL_VARIANCE = 9,   /* r: mean of the components' variances */
    LIMPID_NETWORK_INPUT_DEPTH_VARIANCE = 10,   /* r */
    LIMPID_NETWORK_INPUT_MAX = 32               /* room for more */
} limpid_network_input;

typedef struct limpid_network_frame {
    size_t size;
    uint32_t width, height; /* pixels of all images, 1 to 32768; may differ from frame to frame */
    /* In each pixel's means; 0: 32. Of fewer than 8 the variances are too rough for kpcn.errors, which is then off. */
    uint32_t samples;
    limpid_host_image inputs[LIMPID_NETWORK_INPUT_MAX];
    limpid_host_output color; /* rgb: the clean picture, emission and albedo in it; a: 1 */
} limpid_network_frame;

/* Denoises one frame, by itself, and waits for it. A NaN or an infinity counts as 0 (of the depth: as nothing seen),
 * and a warning tells limpid_device_desc::message of how many pixels; LIMPID_ERROR_INVALID_ARGUMENT if no pixel of the
 * diffuse or of the specular light is finite. */
LIMPID_API limpid_result limpid_network_denoise(limpid_network* network, const limpid_network_frame* frame);

#ifdef __cplusplus
}
#endif
#endif
