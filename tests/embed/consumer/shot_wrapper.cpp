// shot_wrapper INPUT OUTPUT: denoises a shot by the C++ wrapper, and stops it after its first frame.
#include <cstdio>
#include <limpid/shot.hpp>
#include <string>

namespace {

int failures = 0;

void expect(bool good, const char* what) {
    if (good) return;
    std::fprintf(stderr, "not so: %s\n", what);
    ++failures;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    limpid::DeviceDesc cpu;
    cpu.select = "cpu";
    std::string warning;
    cpu.message_user = &warning;
    cpu.message = [](void* user, limpid_message_level level, const char* message) {
        if (level == LIMPID_MESSAGE_WARNING) *static_cast<std::string*>(user) = message;
    };
    limpid::ShotDesc shot(argv[1], argv[2]);
    const char* const map[] = {"motion="};
    shot.map = {map, 1};
    expect(limpid::explainShot(shot).find("layers of Cycles") != std::string::npos,
           "the layers are recognised");

    shot.progress = [](void*, uint32_t, uint32_t) { return int32_t{1}; };
    const limpid::ShotSummary summary = limpid::denoiseShot(shot, cpu);
    expect(summary.frames == 1 && summary.stopped, "the run stops after a frame");
    expect(warning.find("'motion' is missing") != std::string::npos, "a missing layer is a warning");

    shot.denoiser = "other";
    try {
        limpid::denoiseShot(shot, cpu);
        expect(false, "an unknown denoiser is refused");
    } catch (const limpid::Error& error) {
        expect(error.result() == LIMPID_ERROR_INVALID_ARGUMENT, "an unknown denoiser is an invalid argument");
    }
    shot.denoiser = nullptr;
    shot.cameras = "missing.glb";
    shot.fps = -1.0f;
    try {
        limpid::denoiseShot(shot, cpu);
        expect(false, "a negative frame rate is refused");
    } catch (const limpid::Error& error) {
        expect(error.result() == LIMPID_ERROR_INVALID_ARGUMENT,
               "a negative frame rate is an invalid argument");
    }
    shot.cameras = nullptr;
    shot.fps = 0.0f;
    limpid_shot_summary wrong{};
    expect(limpid_shot_denoise(&cpu, &shot, &wrong) == LIMPID_ERROR_INVALID_ARGUMENT,
           "a summary without size");
    shot.input = "missing.exr";
    shot.denoiser = nullptr;
    try {
        limpid::explainShot(shot);
        expect(false, "a missing file is refused");
    } catch (const limpid::Error& error) {
        expect(error.result() == LIMPID_ERROR_UNREADABLE, "a missing file is unreadable");
    }
    return failures == 0 ? 0 : 1;
}
