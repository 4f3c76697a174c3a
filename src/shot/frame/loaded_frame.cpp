#include "shot/frame/loaded_frame.h"

#include <algorithm>
#include <charconv>
#include <span>

#include "base/files/file.h"
#include "base/hash.h"
#include "image/io/exr/exr.h"
#include "image/io/pfm.h"
#include "image/io/picture.h"
#include "renderer/layers/frame_file.h"
#include "shot/camera/camera_attributes.h"
#include "shot/layers/recognise.h"

namespace limpid::shot {
namespace {

/// True if the denoiser reads this channel of Limpid's own files.
bool isRead(std::string_view channel, bool network) {
    if (channel.find(".variance") != std::string_view::npos) return network;
    const ChannelName name = split(channel);
    return std::any_of(frameLayers.begin(), frameLayers.end(), [&](const LayerInfo& layer) {
        return layer.name == name.layer && (network || layer.forFilters != ForFilters::Nothing);
    });
}

/// The channels that are read of Limpid's own files, without their values.
image::LayeredImage layeredImage(const image::ExrDocument& file, bool network) {
    image::LayeredImage picture;
    picture.width = file.width();
    picture.height = file.height();
    const image::ExrPart& part = file.parts().front();
    picture.metadata = part.texts;
    for (const auto& channel : part.channels)
        if (isRead(channel.name, network)) picture.channels.push_back({channel.name, channel.storage, {}});
    return picture;
}

/// A file's layers; a picture of another format has R, G and B, or Y.
image::LayeredImage layersOf(std::span<const std::byte> bytes, const std::filesystem::path& path) {
    const image::PictureFormat format = image::formatOf(bytes);
    if (format == image::PictureFormat::Exr) return image::decodeExr(bytes, path);
    const image::Image picture = format == image::PictureFormat::Pfm
                                     ? image::decodePfm(bytes, path)
                                     : image::decodePicture(bytes, path).linear;
    image::LayeredImage layers;
    layers.width = picture.width;
    layers.height = picture.height;
    layers.add("", picture.components == 1 ? "Y" : "RGB", picture, image::Storage::Float);
    return layers;
}

image::ExrDocument openDocument(std::vector<std::byte> bytes, const std::filesystem::path& path) {
    const image::PictureFormat format = image::formatOf(bytes);
    // Most frames are EXR files, so those that are nothing known get the error of such a file.
    const bool isExr = format == image::PictureFormat::Exr || format == image::PictureFormat::Unknown;
    return isExr ? image::ExrDocument::decode(std::move(bytes), path)
                 : image::ExrDocument::of(layersOf(bytes, path), path);
}

bool has(const image::ExrPart& part, const LayerInfo& layer) {
    return std::all_of(layer.suffixes.begin(), layer.suffixes.end(), [&](char suffix) {
        return std::any_of(part.channels.begin(), part.channels.end(), [&](const auto& channel) {
            return channel.name == std::string(layer.name) + "." + suffix;
        });
    });
}

/// True if the file has the layers that Limpid writes for a still, and (`sequence`) those for a sequence.
bool isOwn(const image::ExrDocument& file, bool sequence) {
    const image::ExrPart& part = file.parts().front();
    return part.unreadable.empty() && part.texts.contains("limpid.camera") &&
           std::all_of(frameLayers.begin(), frameLayers.end(), [&](const LayerInfo& layer) {
               const bool needed =
                   layer.need == Need::Always || (sequence && layer.need == Need::InSequences);
               return !needed || has(part, layer);
           });
}

/// A file with more decoded channels than Limpid's own at 1920x1080 (240 MB) is decoded when it is used: the
/// one that is denoised and the one that is written take enough memory.
constexpr uint64_t decodedAhead = uint64_t{256} << 20;

bool isDecodedAhead(const image::ExrDocument& file) {
    uint64_t bytes = 0;
    for (size_t part = 0; part < file.parts().size(); ++part) bytes += file.decodedBytes(part);
    return bytes <= decodedAhead;
}

/// Samples per pixel by an attribute such as "cycles.ViewLayer.samples"; 0 if there is none.
uint32_t samplesOf(const image::ExrDocument& file) {
    uint32_t samples = 0;
    for (const image::ExrPart& part : file.parts()) {
        for (const auto& [name, text] : part.texts)
            if (name.ends_with(".samples")) std::from_chars(text.data(), text.data() + text.size(), samples);
        for (const char* name : {"samplesPerPixel", "arnold/AA_samples"})
            if (const auto found = part.numbers.find(name);
                found != part.numbers.end() && found->second >= 1.0)
                samples = static_cast<uint32_t>(std::min(found->second, 1e6));
    }
    return samples;
}

}  // namespace

LoadedFrame loadFrame(const std::filesystem::path& path, int number, const LoadOptions& options) {
    Hash64 content;
    std::vector<std::byte> bytes = readFile(path);
    content.addValues(bytes);
    LoadedFrame frame{.number = number, .file = openDocument(std::move(bytes), path)};
    for (const auto& [name, pattern] : options.files) {
        const std::filesystem::path file = pattern.format(std::max(number, 0));
        const std::vector<std::byte> attached = readFile(file);
        content.addValues(attached);
        frame.file.attach(name, layersOf(attached, file), file);
    }
    frame.content = content.value();
    frame.maps = recognise(frame.file, options.assignments);
    const bool decodes = isDecodedAhead(frame.file);
    for (LayerMap& map : frame.maps) {
        if (decodes) decodeParts(frame.file, map);
        if (map.find("motion") || !options.searchMotion || !options.sequence || options.network) continue;
        map.searchesMotion = map.find("albedo") || map.find("normal");
        // What is found is in pixels; the encoding that belongs to the renderer's layer does not apply.
        const Encoding plain;
        map.encoding.motionUnit = plain.motionUnit;
        map.encoding.motionScale = plain.motionScale;
        map.encoding.noMotion = plain.noMotion;
    }
    return frame;
}

uint64_t contentOf(const std::filesystem::path& path, int number, const LoadOptions& options) {
    Hash64 content;
    content.addValues(readFile(path));
    for (const auto& [name, pattern] : options.files)
        content.addValues(readFile(pattern.format(std::max(number, 0))));
    return content.value();
}

void unpack(LoadedFrame& frame, const LoadOptions& options) {
    const bool sequence = options.sequence && !options.network;
    const bool asWritten = options.assignments.empty() && options.files.empty() && !options.layersOnly &&
                           isOwn(frame.file, sequence);
    if (asWritten) {
        const image::LayeredImage picture = layeredImage(frame.file, options.network);
        if (options.network) frame.estimated = lackingVariances(picture);
        frame.file.decode(0);  // before several threads read it
        const ChannelReader reader = [&](const std::string& channel, std::span<float> to, size_t stride) {
            frame.file.read(0, channel, to, stride);
        };
        frame.own = frameOf(picture, frame.file.name(), sequence, frame.lacking, reader);
        return;
    }
    if (options.network)
        for (const LayerInfo& layer : frameLayers)
            if (layer.varianceInFiles) frame.estimated.push_back(&layer);
    for (const LayerMap& map : frame.maps) {
        frame.layers.push_back(readLayers(frame.file, map));
        frame.layers.back().camera = cameraOfAttributes(frame.file, map.view);
        frame.layers.back().samples = samplesOf(frame.file);
    }
}

}  // namespace limpid::shot
