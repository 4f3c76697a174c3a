// The channels of all parts of an EXR file by name, as `limpid denoise --map` and its messages name them.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/io/exr/exr_document.h"

namespace limpid::shot {

/// Where a channel is.
struct ChannelPlace {
    size_t part = 0;
    std::string channel;  ///< its name in that part
    image::Storage storage = image::Storage::Half;
};

/// The channels of one layer: "Combined.R", "Combined.G" and so on. Layer "" has the channels without a dot.
struct LayerChannels {
    std::string name;
    std::vector<std::string> components;  ///< what follows the last dot, in the file's order
};

/// A layer of an attached part.
struct AttachedLayer {
    size_t part = 0;
    std::string partName;    ///< without its view
    LayerChannels channels;  ///< the name begins with the part's; without channels that another part hides
};

/// "Combined.R": the layer "Combined", the component "R". The layer is empty without a dot.
struct ChannelName {
    std::string_view layer, component;
};
ChannelName split(std::string_view channel);
/// The opposite.
std::string joined(std::string_view layer, std::string_view component);

/// A channel's name is that in its part. If several parts have it, or if it has no layer ("R") and lies in
/// another part than the first, the part's name and a dot precede it: "albedo.R". Unreadable parts are left
/// out. Attached parts always have their name before, and hide channels of that name.
class ChannelTable {
  public:
    /// With a view, only that view's channels are in the table, and their names are without the view.
    explicit ChannelTable(std::span<const image::ExrPart> parts, const std::string& view = {});

    /// Returns null if there is no channel of this name.
    const ChannelPlace* find(std::string_view name) const;
    /// Sorted by name.
    const std::vector<LayerChannels>& layers() const { return layers_; }
    /// Returns null if there is no layer of this name.
    const LayerChannels* layer(std::string_view name) const;
    /// Those of attached parts alone; layers() has them, too.
    const std::vector<AttachedLayer>& attached() const { return attached_; }

  private:
    void addAttached(size_t part, std::string partName, const ChannelName& channel);

    std::map<std::string, ChannelPlace, std::less<>> channels_;
    std::vector<LayerChannels> layers_;
    std::vector<AttachedLayer> attached_;
};

/// The views of a stereo (or multi-view) file, the default view first; empty if the file has none. The names
/// are from the attribute "multiView" of a part, or from the attribute "view" of each part. What lies in
/// which view follows https://openexr.com/en/latest/MultiViewOpenEXR.html:
///   - a part with the attribute "view" lies in that view;
///   - else "layer.view.channel", and "view.channel", are of that view;
///   - else all is of the default view, unless the part's name ends with another view ("albedo.right").
std::vector<std::string> viewsOf(std::span<const image::ExrPart> parts);

}  // namespace limpid::shot
