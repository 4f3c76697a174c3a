/* shot INPUT OUTPUT: explains and denoises a shot on the CPU, forwards and backwards. */
#include <limpid/shot.h>
#include <stdio.h>

static void print(void* user, const char* text) {
    (void)user;
    fputs(text, stdout);
}

static int32_t progress(void* user, uint32_t done, uint32_t total) {
    *(uint32_t*)user = done;
    return done > total;
}

int main(int argc, char** argv) {
    uint32_t done = 0;
    limpid_device_desc device = {sizeof device};
    limpid_shot_desc shot = {sizeof shot};
    limpid_shot_summary summary = {sizeof summary};
    if (argc != 3) return 2;
    device.select = "cpu";
    shot.input = argv[1];
    if (limpid_shot_explain(&shot, print, NULL) != LIMPID_OK ||
        limpid_shot_denoise(&device, &shot, &summary) != LIMPID_ERROR_INVALID_ARGUMENT) {
        fprintf(stderr, "%s\n", limpid_shot_last_error());
        return 1;
    }
    shot.output = argv[2];
    shot.bidirectional = 1;
    shot.progress = progress;
    shot.progress_user = &done;
    if (limpid_shot_denoise(&device, &shot, &summary) != LIMPID_OK) {
        fprintf(stderr, "%s\n", limpid_shot_last_error());
        return 1;
    }
    return summary.frames == 2 && done == 2 && !summary.stopped ? 0 : 1;
}
