/* Limpid for files of any renderer, in C: reads a shot's frames, denoises them, and writes them back.
 *
 *     limpid_shot_desc shot = {sizeof shot};
 *     shot.input = "shot.%04d.exr";
 *     shot.output = "clean.%04d.exr";
 *     if (limpid_shot_denoise(NULL, &shot, NULL) != LIMPID_OK) puts(limpid_shot_last_error());
 *
 * It does what `limpid denoise` does, with the same bits: it recognises the layers of Blender, Mitsuba, pbrt, Arnold,
 * RenderMan, Karma and others, finds the camera, follows the motion, and keeps everything else in the files as it is.
 * docs/denoise-your-renders.md describes this and all options.
 *
 * It is a library of its own, liblimpid-shot.so.0, which needs OpenEXR, TBB and others, and does not need
 * liblimpid.so.0. C++ programs can use shot.hpp. The types and general rules are those of denoise.h, except:
 * - limpid_shot_last_error() describes this library's failures; limpid_last_error() does not.
 * - Each call opens a device of its own. Several threads may run several shots.
 * - Texts are in UTF-8 and written as on the command line; NULL is the default.
 */
#ifndef LIMPID_SHOT_H
#define LIMPID_SHOT_H

#include <limpid/denoise.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The library's version, like limpid_version(); LIMPID_VERSION_* are the header's. */
LIMPID_API uint32_t limpid_shot_version(void);

/* Describes the calling thread's last failure in this library; "" if there was none. Valid until its next call. */
LIMPID_API const char* limpid_shot_last_error(void);

/* A list of texts. */
typedef struct limpid_texts {
    const char* const* data;
    size_t count;
} limpid_texts;

typedef struct limpid_shot_desc {
    size_t size;
    const char* input;    /* "frame.exr", or "shot.%04d.exr" for all frames that exist; also .pfm, .hdr, .png */
    const char* output;   /* .exr: the input's file with a clean beauty; or .png. Not read by limpid_shot_explain(). */
    const char* denoiser; /* "svgf" (default), "nano", "film", "atrous", "temporal", "bilateral" or "kpcn" */
    const char* preset;   /* the settings of a paper or course; `limpid info` lists them */
    limpid_texts settings; /* of parameters: "svgf.alpha=0.1" */
    const char* weights;   /* a file of weights for "kpcn" instead of the installed one */
    limpid_texts map;      /* which layers are what: "albedo=MyAlbedo.RGB" */
    const char* map_file;  /* a JSON file of the same */
    limpid_texts files;    /* layers in files of their own: "albedo=albedo.%04d.pfm" */
    const char* cameras;   /* a file of the frames' cameras: JSON, or glTF ("scene.glb#NAME" chooses one) */
    float fps;             /* of the animation in a glTF file of cameras, frames per second; 0: 24 */
    int32_t camera_start;  /* the frame at time 0 of that animation */
    const char* motion;    /* where files have no motion: "auto" (default) searches it, "none" does without */
    const char* frames;    /* "10-20" or "7": only these are written; those around them make histories */
    const char* shard;     /* "2/4": only the second of four parts */
    const char* cuts;      /* "auto" (default), "none", or the first frames after cuts: "12,40" */
    const char* on_error;  /* what an unreadable frame does: "stop" (default) or "skip" */
    const char* exposure;  /* of a PNG: stops, or "auto" (default) */
    float strength;        /* share of the clean picture in the result, above 0 to 1; 0: 1 */
    float preserve;        /* share of filtered detail that is given back, 0 to 1: more detail and more noise */
    int32_t bidirectional; /* not 0: denoise forwards and backwards, and merge both; takes twice as long */
    int32_t resume;        /* not 0: go on after the last complete output (EXR) */
    /* Called on the calling thread for each frame that is denoised. `done` frames are finished; it stays the same
     * while only histories are made (before `frames` or a `shard`, and backwards). With `resume` it is also called for
     * each output that is complete; these do not count as done, and are no part of `total` afterwards. Not 0 stops the
     * run: frames so far are written. May be NULL. */
    int32_t (*progress)(void* user, uint32_t done, uint32_t total);
    void* progress_user;
    const char* recover; /* what was taken away besides noise comes back: "auto" (default; "svgf", "nano" and "film",
                          * files of Cycles and pbrt-v4), "on" or "off"; with a preset it is off by default */
} limpid_shot_desc;

typedef struct limpid_shot_summary {
    size_t size;
    uint32_t frames;  /* written */
    uint32_t kept;    /* found complete, with `resume` */
    uint32_t skipped; /* unreadable; limpid_device_desc::message named each */
    uint32_t cuts;    /* found or given */
    int32_t stopped;  /* not 0: by `progress` */
    double seconds;
} limpid_shot_summary;

/* Denoises a shot. `device` may be NULL: the best one, as for limpid_device_create(); its `message` gets warnings, for
 * example of missing layers. `summary` may be NULL.
 * LIMPID_ERROR_INVALID_ARGUMENT: an option is wrong. LIMPID_ERROR_UNREADABLE: a file is missing or damaged, and
 * `on_error` is not "skip"; frames before it are complete. LIMPID_ERROR_FAILED: an output cannot be written. */
LIMPID_API limpid_result limpid_shot_denoise(const limpid_device_desc* device, const limpid_shot_desc* shot,
                                             limpid_shot_summary* summary);

/* Calls `text` once with several lines: how each layer is understood, what is missing and what that costs, where the
 * camera is from, and how much of the change between two frames the motion explains. Opens no device. */
LIMPID_API limpid_result limpid_shot_explain(const limpid_shot_desc* shot, void (*text)(void* user, const char* text),
                                             void* user);

#ifdef __cplusplus
}
#endif
#endif
