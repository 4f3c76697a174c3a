// Writes the pixels that X11 shows in a window as a PPM to standard output: window_pixels WINDOW. For tests
// of the viewer.
#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <bit>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

namespace {

/// Extracts an 8-bit channel.
unsigned char channel(unsigned long pixel, unsigned long mask) {
    return static_cast<unsigned char>((pixel & mask) >> std::countr_zero(mask));
}

int freeImage(XImage* image) {
    return XDestroyImage(image);
}

}  // namespace

int main(int argc, char** argv) {
    const std::unique_ptr<Display, int (*)(Display*)> display(XOpenDisplay(nullptr), XCloseDisplay);
    if (!display || argc != 2) {
        std::fprintf(stderr, "usage, where there is a display: window_pixels WINDOW\n");
        return 2;
    }
    const Window window = std::strtoul(argv[1], nullptr, 0);
    XWindowAttributes size{};
    if (!XGetWindowAttributes(display.get(), window, &size)) return 1;
    const std::unique_ptr<XImage, int (*)(XImage*)> image(
        XGetImage(display.get(), window, 0, 0, static_cast<unsigned>(size.width),
                  static_cast<unsigned>(size.height), AllPlanes, ZPixmap),
        freeImage);
    if (!image) return 1;
    std::vector<unsigned char> bytes;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const unsigned long pixel = XGetPixel(image.get(), x, y);
            for (const unsigned long mask : {image->red_mask, image->green_mask, image->blue_mask})
                bytes.push_back(channel(pixel, mask));
        }
    }
    std::printf("P6\n%d %d\n255\n", size.width, size.height);
    return std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() ? 0 : 1;
}
