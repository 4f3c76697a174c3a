#include "viewer/panel/interface.h"

#include <GLFW/glfw3.h>
#include <imgui.h>
// Debian keeps the back ends in a separate folder.
#include <backends/imgui_impl_glfw.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "viewer/looks/theme.h"

namespace limpid::viewer {
namespace {

static_assert(sizeof(ImDrawVert) == sizeof(gpu::OverlayVertex) && sizeof(ImDrawIdx) == sizeof(uint16_t));

}  // namespace

Interface::Interface(Window& window, gpu::Presenter& presenter) : window_(window), scale_(window.scale()) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    addTypeface(scale_);
    thumbnails_.reserve(thumbnailFolder());
    ImGui_ImplGlfw_InitForVulkan(window.handle(), false);  // events come from the queue instead
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&texels, &width, &height);
    thumbnails_.copy(texels, width, height);
    const auto* words = reinterpret_cast<const uint32_t*>(texels);
    presenter.setTexture({static_cast<uint32_t>(width), static_cast<uint32_t>(height)},
                         {words, static_cast<size_t>(width) * static_cast<size_t>(height)});
}

Interface::~Interface() {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Interface::begin(bool dark) {
    if (std::exchange(dark_, dark) != dark) setTheme(dark, scale_);
    ImGui_ImplGlfw_NewFrame();
    ImGuiIO& io = ImGui::GetIO();
    clickedTwice_ = askedForKeys_ = false;
    for (const InputEvent& event : window_.input().take(io.WantTextInput)) apply(event);
    // The back end reads the window's current state, which is ahead of the queue.
    io.MousePos = {mouse_.x, mouse_.y};
    std::copy(buttons_.begin(), buttons_.end(), io.MouseDown);
    ImGui::NewFrame();
}

// ImGui wants text for one picture after its end: a key right after Return would be lost.
bool Interface::typesText() {
    return ImGui::GetIO().WantTextInput && ImGui::IsAnyItemActive();
}

void Interface::apply(const InputEvent& event) {
    ImGuiIO& io = ImGui::GetIO();
    const auto code = static_cast<size_t>(event.code);
    switch (event.kind) {
        case InputEvent::Kind::Move:
            mouse_ = event;
            break;
        case InputEvent::Kind::Button:
            if (code < buttons_.size()) buttons_[code] = event.down;
            clickedTwice_ |= event.twice && event.code == GLFW_MOUSE_BUTTON_LEFT;
            break;
        case InputEvent::Kind::Wheel:
            io.MouseWheelH += event.x;
            io.MouseWheel += event.y;
            break;
        case InputEvent::Kind::Text:
            askedForKeys_ |= event.code == '?' && !typesText();
            io.AddInputCharacter(static_cast<unsigned>(event.code));
            break;
        case InputEvent::Kind::Key:
            if (code < std::size(io.KeysDown)) io.KeysDown[code] = event.down;
            const auto held = [&](int left, int right) { return io.KeysDown[left] || io.KeysDown[right]; };
            io.KeyCtrl = held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
            io.KeyShift = held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
            io.KeyAlt = held(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
            io.KeySuper = held(GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER);
            break;
    }
}

gpu::Overlay Interface::end() {
    ImGui::Render();
    const ImDrawData& data = *ImGui::GetDrawData();
    const ImVec2 scale = data.FramebufferScale;  // pixels of the screen per pixel of the window
    vertices_.clear();
    indices_.clear();
    draws_.clear();
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        const auto firstVertex = static_cast<uint32_t>(vertices_.size()),
                   firstIndex = static_cast<uint32_t>(indices_.size());
        for (const ImDrawVert& v : list.VtxBuffer)
            vertices_.push_back({(v.pos.x - data.DisplayPos.x) * scale.x,
                                 (v.pos.y - data.DisplayPos.y) * scale.y, v.uv.x, v.uv.y, v.col});
        indices_.insert(indices_.end(), list.IdxBuffer.begin(), list.IdxBuffer.end());
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const ImVec4& clip = command.ClipRect;
            draws_.push_back({(clip.x - data.DisplayPos.x) * scale.x, (clip.y - data.DisplayPos.y) * scale.y,
                              (clip.z - data.DisplayPos.x) * scale.x, (clip.w - data.DisplayPos.y) * scale.y,
                              firstIndex + command.IdxOffset, command.ElemCount,
                              firstVertex + command.VtxOffset});
        }
    }
    return {vertices_, indices_, draws_};
}

}  // namespace limpid::viewer
