/* Denoises pictures in host memory with Limpid, in C99; the program itself does not use Vulkan. It paints noisy
 * pictures of a disc that moves in front of a wall and denoises them frame by frame. For the last frame it prints the
 * PSNR before and after, and writes noisy.ppm and clean.ppm.
 *
 *     limpid-c [DEVICE]      DEVICE: part of a GPU's name, or cpu
 */
#include <limpid/denoise.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 320, HEIGHT = 180, PIXELS = WIDTH * HEIGHT, FRAMES = 16 };

/* Colours and normals have three floats per pixel, motion two, depth one. */
static float truth[PIXELS * 3], noisy[PIXELS * 3], clean[PIXELS * 3];
static float albedo[PIXELS * 3], normal[PIXELS * 3], depth[PIXELS], motion[PIXELS * 2];

/* Returns a uniform random number from 0 to 1. */
static float uniform(void) {
    static uint32_t state = 1;
    state = state * 1664525u + 1013904223u;
    return (float)(state >> 8) / 16777216.0f;
}

/* The camera is orthographic and looks along -z; one world unit is one pixel. The disc is in front of the wall. */
static void paint(int frame) {
    const float step = 4.0f, discX = 80.0f + step * (float)frame, discY = 90.0f;
    for (int i = 0; i < PIXELS; ++i) {
        const float x = (float)(i % WIDTH) + 0.5f, y = (float)(i / WIDTH) + 0.5f;
        const int disc = hypotf(x - discX, y - discY) < 40.0f;
        const int square = ((int)(x / 16.0f) + (int)(y / 16.0f)) % 2;
        const float light = disc ? 0.6f : 0.2f + 0.4f * x / WIDTH;
        depth[i] = disc ? 5.0f : 10.0f;
        motion[2 * i] = disc ? -step : 0.0f; /* previous minus current position, in pixels */
        motion[2 * i + 1] = 0.0f;
        const float found = light * 4.0f * (uniform() < 0.25f); /* noise: few pixels find light */
        for (int c = 0; c < 3; ++c) {
            albedo[3 * i + c] = disc ? (c == 0 ? 0.9f : 0.3f) : square ? 0.8f : 0.4f;
            normal[3 * i + c] = c == 2 ? 1.0f : 0.0f;
            truth[3 * i + c] = albedo[3 * i + c] * light;
            noisy[3 * i + c] = albedo[3 * i + c] * found;
        }
    }
}

static void setCamera(limpid_camera* camera) {
    const float view[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    /* Column-major. Clip space: x and y from -1 to 1 over the picture, y down; z from 0 to 1 at distances 0 to 100. */
    const float projection[16] = {2.0f / WIDTH, 0, 0, 0, 0, -2.0f / HEIGHT, 0, 0, 0, 0, -0.01f, 0, 0, 0, 0, 1};
    for (int i = 0; i < 16; ++i) {
        camera->view[i] = camera->previous_view[i] = view[i];
        camera->projection[i] = camera->previous_projection[i] = projection[i];
    }
}

static double psnr(const float* picture) {
    double sum = 0.0;
    for (int i = 0; i < 3 * PIXELS; ++i) {
        const double error = fmin(picture[i], 1.0) - fmin(truth[i], 1.0);
        sum += error * error;
    }
    return 10.0 * log10(3.0 * PIXELS / sum);
}

static void save(const char* name, const float* picture) {
    FILE* file = fopen(name, "wb");
    if (!file) {
        perror(name);
        exit(1);
    }
    fprintf(file, "P6 %d %d 255\n", WIDTH, HEIGHT);
    for (int i = 0; i < 3 * PIXELS; ++i) fputc((int)(255.0 * pow(fmin(picture[i], 1.0), 1 / 2.2) + 0.5), file);
    fclose(file);
}

static void check(limpid_result result) {
    if (result == LIMPID_OK) return;
    fprintf(stderr, "limpid-c: %s\n", limpid_last_error());
    exit(1);
}

int main(int argc, char** argv) {
    limpid_device_desc deviceDesc = {.size = sizeof deviceDesc};
    if (argc > 1) deviceDesc.select = argv[1];
    limpid_device* device;
    check(limpid_device_create(&deviceDesc, &device));

    limpid_denoiser_desc desc = {.size = sizeof desc};
    desc.method = LIMPID_METHOD_SVGF;
    desc.width = WIDTH;
    desc.height = HEIGHT;
    limpid_denoiser* denoiser;
    check(limpid_denoiser_create(device, &desc, &denoiser));

    limpid_host_frame frame = {.size = sizeof frame};
    frame.inputs[LIMPID_INPUT_RADIANCE] = (limpid_host_image){.data = noisy, .components = 3};
    frame.inputs[LIMPID_INPUT_ALBEDO] = (limpid_host_image){.data = albedo, .components = 3};
    frame.inputs[LIMPID_INPUT_NORMAL] = (limpid_host_image){.data = normal, .components = 3};
    frame.inputs[LIMPID_INPUT_DEPTH] = (limpid_host_image){.data = depth, .components = 1};
    frame.inputs[LIMPID_INPUT_MOTION] = (limpid_host_image){.data = motion, .components = 2};
    frame.outputs[LIMPID_OUTPUT_COLOR] = (limpid_host_output){.data = clean, .components = 3};
    setCamera(&frame.camera);
    for (int i = 0; i < FRAMES; ++i) {
        paint(i);
        check(limpid_denoise_host(denoiser, &frame));
    }
    printf("%s: PSNR %.1f dB before, %.1f dB after\n", limpid_device_name(device), psnr(noisy), psnr(clean));
    save("noisy.ppm", noisy);
    save("clean.ppm", clean);
    limpid_denoiser_destroy(denoiser);
    limpid_device_destroy(device);
    return psnr(clean) > psnr(noisy) + 6.0 ? 0 : 1;
}
