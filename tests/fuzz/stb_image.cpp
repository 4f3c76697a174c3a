// stb_image compiled with the fuzzer's instrumentation, in place of the system library's: otherwise neither
// the sanitizers nor the fuzzer see what it does.
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>
