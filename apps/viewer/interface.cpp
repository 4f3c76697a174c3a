#include "interface.h"

#include <imgui.h>
// Debian keeps the back ends in a folder of their own.
#include <backends/imgui_impl_glfw.h>

#include <algorithm>

namespace limpid::viewer {
namespace {

static_assert(sizeof(ImDrawVert) == sizeof(gpu::OverlayVertex) && sizeof(ImDrawIdx) == sizeof(uint16_t));

}  // namespace

Interface::Interface(const Window& window, gpu::Presenter& presenter) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    ImGui::StyleColorsDark();
    ImGui_ImplGlfw_InitForVulkan(window.handle(), true);
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&texels, &width, &height);
    const auto* words = reinterpret_cast<const uint32_t*>(texels);
    presenter.setTexture({static_cast<uint32_t>(width), static_cast<uint32_t>(height)},
                         {words, static_cast<size_t>(width) * static_cast<size_t>(height)});
}

Interface::~Interface() {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Interface::begin() {
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

gpu::Overlay Interface::end() {
    ImGui::Render();
    const ImDrawData& data = *ImGui::GetDrawData();
    const ImVec2 scale = data.FramebufferScale;  // pixels of the screen to those of the window
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
