/* Tests the network's C interface: equal versions of header and library, installed weights, and one denoised frame. */
#include <limpid/neural.h>
#include <stdio.h>

#define WIDTH 16
#define HEIGHT 8

static int denoise(limpid_network* network, float* clean) {
    static float light[WIDTH * HEIGHT * 3], normals[WIDTH * HEIGHT * 3], depths[WIDTH * HEIGHT],
        variances[WIDTH * HEIGHT];
    limpid_network_frame frame = {sizeof frame};
    for (int i = 0; i < WIDTH * HEIGHT; ++i) {
        for (int c = 0; c < 3; ++c) light[3 * i + c] = i % 2 == 0 ? 0.25f : 0.75f;
        normals[3 * i + 2] = 1.0f;
        depths[i] = 2.0f;
        variances[i] = 0.0625f;
    }
    frame.width = WIDTH, frame.height = HEIGHT;
    frame.inputs[LIMPID_NETWORK_INPUT_DIFFUSE] = (limpid_host_image){light, 3, 0, 0};
    frame.inputs[LIMPID_NETWORK_INPUT_DIFFUSE_VARIANCE] = (limpid_host_image){variances, 1, 0, 0};
    frame.inputs[LIMPID_NETWORK_INPUT_NORMAL] = (limpid_host_image){normals, 3, 0, 0};
    frame.inputs[LIMPID_NETWORK_INPUT_DEPTH] = (limpid_host_image){depths, 1, 0, 0};
    frame.color = (limpid_host_output){clean, 3, 0, 0};
    return limpid_network_denoise(network, &frame) == LIMPID_OK;
}

int main(void) {
    const uint32_t header =
        10000u * LIMPID_VERSION_MAJOR + 100u * LIMPID_VERSION_MINOR + LIMPID_VERSION_PATCH;
    static float clean[WIDTH * HEIGHT * 3];
    limpid_device_desc cpu = {sizeof cpu};
    limpid_network* network = NULL;
    int good;
    cpu.select = "cpu";
    if (limpid_network_version() != header) {
        printf("the library is of version %u, its header of %u\n", limpid_network_version(), header);
        return 1;
    }
    good = limpid_network_create(&cpu, NULL, &network) == LIMPID_OK && denoise(network, clean);
    if (!good) printf("%s\n", limpid_network_last_error());
    if (good) printf("%s, %s\n", limpid_network_device_name(network), limpid_network_precision(network));
    for (int i = 0; good && i < WIDTH * HEIGHT * 3; ++i) good = clean[i] > 0.3f && clean[i] < 0.7f;
    limpid_network_destroy(network);
    return good ? 0 : 1;
}
