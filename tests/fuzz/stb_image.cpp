// stb_image compiled with the fuzzer's instrumentation, replacing the system library's; otherwise neither the
// sanitizers nor the fuzzer can observe it.
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>
