// Drops files on a window of X11, as a file manager does (XDND version 5): drop_files WINDOW FILE...
// For tests of the viewer; exits 0 once the window says that it has taken them.
#include <X11/Xlib.h>
#include <poll.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

namespace {

using Clock = std::chrono::steady_clock;

class Source {
  public:
    Source(Display* display, Window target, std::string uris)
        : display_(display), target_(target), uris_(std::move(uris)) {
        window_ = XCreateSimpleWindow(display_, DefaultRootWindow(display_), 0, 0, 1, 1, 0, 0, 0);
        XSetSelectionOwner(display_, atom("XdndSelection"), window_, CurrentTime);
    }
    ~Source() { XDestroyWindow(display_, window_); }
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;

    bool drop() {
        send("XdndEnter", 5L << 24, static_cast<long>(atom("text/uri-list")), 0, 0);
        send("XdndPosition", 0, 10L << 16 | 10L, CurrentTime, static_cast<long>(atom("XdndActionCopy")));
        if (!serveUntil("XdndStatus")) return false;
        send("XdndDrop", 0, CurrentTime, 0, 0);
        return serveUntil("XdndFinished");
    }

  private:
    Atom atom(const char* name) const { return XInternAtom(display_, name, False); }

    void send(const char* type, long a, long b, long c, long d) {
        XEvent event{};
        event.xclient.type = ClientMessage;
        event.xclient.window = target_;
        event.xclient.message_type = atom(type);
        event.xclient.format = 32;
        event.xclient.data.l[0] = static_cast<long>(window_);
        event.xclient.data.l[1] = a;
        event.xclient.data.l[2] = b;
        event.xclient.data.l[3] = c;
        event.xclient.data.l[4] = d;
        XSendEvent(display_, target_, False, NoEventMask, &event);
        XFlush(display_);
    }

    /// In between, the target requests the files' names.
    bool serveUntil(const char* type) {
        const auto end = Clock::now() + std::chrono::seconds(60);
        while (Clock::now() < end) {
            pollfd connection{ConnectionNumber(display_), POLLIN, 0};
            if (XPending(display_) == 0 && ::poll(&connection, 1, 200) <= 0) continue;
            XEvent event;
            XNextEvent(display_, &event);
            if (event.type == SelectionRequest) answer(event.xselectionrequest);
            if (event.type == ClientMessage && event.xclient.message_type == atom(type)) return true;
        }
        return false;
    }

    void answer(const XSelectionRequestEvent& request) {
        XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(uris_.data()), static_cast<int>(uris_.size()));
        XEvent reply{};
        reply.xselection.type = SelectionNotify;
        reply.xselection.requestor = request.requestor;
        reply.xselection.selection = request.selection;
        reply.xselection.target = request.target;
        reply.xselection.property = request.property;
        reply.xselection.time = request.time;
        XSendEvent(display_, request.requestor, False, NoEventMask, &reply);
        XFlush(display_);
    }

    Display* display_;
    Window target_, window_ = 0;
    std::string uris_;
};

}  // namespace

int main(int argc, char** argv) {
    const std::unique_ptr<Display, int (*)(Display*)> display(XOpenDisplay(nullptr), XCloseDisplay);
    if (!display || argc < 3) {
        std::fprintf(stderr, "usage, where there is a display: drop_files WINDOW FILE...\n");
        return 2;
    }
    std::string uris;
    for (int i = 2; i < argc; ++i) uris += std::string("file://") + argv[i] + "\r\n";
    Source source(display.get(), std::strtoul(argv[1], nullptr, 0), uris);
    return source.drop() ? 0 : 1;
}
