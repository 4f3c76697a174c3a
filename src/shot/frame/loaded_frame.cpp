#include "shot/frame/loaded_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <span>

#include "base/error.h"
#include "base/files/file.h"
#include "base/hash.h"
#include "image/io/pfm.h"
#include "image/io/picture.h"
#include "renderer/layers/frame_file.h"
#include "shot/camera/camera_attributes.h"
#include "shot/layers/recognise.h"

namespace limpid::shot {
namespace {

/// True if the denoiser reads this channel of Limpid's own files.
bool isRead(std::string_view channel, bool network, bool variances) {
    const ChannelName name = split(channel);
    if (channel.find(".variance") != std::string_view::npos)
        return network ||
               (variances && (channel.starts_with("diffuse.") || channel.starts_with("specular.")));
    return std::any_of(frameLayers.begin(), frameLayers.end(), [&](const LayerInfo& layer) {
        return layer.name == name.layer && (network || layer.forFilters != ForFilters::Nothing);
    });
}

/// The channels that are read of Limpid's own files, without their values.
image::LayeredImage layeredImage(const image::ExrDocument& file, bool network, bool variances) {
    image::LayeredImage picture;
    picture.width = file.width();
    picture.height = file.height();
    const image::ExrPart& part = file.parts().front();
    picture.metadata = part.texts;
    for (const auto& channel : part.channels)
        if (isRead(channel.name, network, variances))
            picture.channels.push_back({channel.name, channel.storage, {}});
    return picture;
}

/// Of a picture that is no EXR file: R, G and B, or Y.
image::LayeredImage layersOfPicture(const std::vector<std::byte>& bytes, const std::filesystem::path& path) {
    const image::Image picture = image::formatOf(bytes) == image::PictureFormat::Pfm
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
                 : image::ExrDocument::of(layersOfPicture(bytes, path), path);
}

/// A file beside the frame's. Its channels have the names of --map, whatever parts they lie in.
struct AttachedFile {
    image::PictureFormat format;
    image::ExrDocument file;
    ChannelTable channels;
};

AttachedFile openAttached(std::vector<std::byte> bytes, const std::filesystem::path& path) {
    const image::PictureFormat format = image::formatOf(bytes);
    image::ExrDocument file = openDocument(std::move(bytes), path);
    ChannelTable channels(file.parts());
    return {format, std::move(file), std::move(channels)};
}

/// All its channels, without their values.
image::LayeredImage channelsOf(const AttachedFile& attached) {
    image::LayeredImage result;
    result.width = attached.file.width();
    result.height = attached.file.height();
    for (const LayerChannels& layer : attached.channels.layers())
        for (const std::string& component : layer.components) {
            std::string name = joined(layer.name, component);
            const image::Storage storage = attached.channels.find(name)->storage;
            result.channels.push_back({std::move(name), storage, {}});
        }
    if (result.channels.empty())
        throw InputError(attached.file.name(),
                         attached.file.parts().front().unreadable + ", which is not supported");
    return result;
}

/// The channels of a part that the maps read.
std::set<std::string> channelsRead(const std::vector<LayerMap>& maps, size_t part) {
    std::set<std::string> channels;
    const auto add = [&](const LayerExpression& expression) {
        for (const ChannelPlace& place : expression.places())
            if (place.part == part) channels.insert(place.channel);
    };
    for (const LayerMap& map : maps) {
        for (const auto& [role, expression] : map.layers) add(expression);
        std::for_each(map.groups.begin(), map.groups.end(), add);
    }
    return channels;
}

/// Decodes the parts of attached files that the maps read. Each file is dropped before the next one is
/// decoded, since all of them decoded take much memory.
void fillAttached(LoadedFrame& frame, std::span<AttachedFile> files) {
    const size_t own = frame.file.parts().size() - files.size();
    for (size_t i = 0; i < files.size(); ++i) {
        for (const std::string& channel : channelsRead(frame.maps, own + i)) {
            const ChannelPlace& source = *files[i].channels.find(channel);
            frame.file.fill(own + i, channel, files[i].file.values(source.part, source.channel));
        }
        files[i].file = image::ExrDocument();
    }
}

/// Why a format cannot hold such values; empty if it can.
std::string_view whyUnfit(image::PictureFormat format, RoleValues values) {
    using image::PictureFormat;
    if ((format == PictureFormat::Png || format == PictureFormat::Jpeg) && values != RoleValues::Colors)
        return "PNG and JPEG hold colours for screens";
    if (format == PictureFormat::Hdr && values == RoleValues::Exact)
        return "Radiance HDR holds neither signs nor exact numbers";
    return {};
}

/// Throws UsageError if an attached file cannot hold what it is read as.
void checkFormats(const LoadedFrame& frame, const LoadOptions& options, std::span<const AttachedFile> files) {
    const size_t own = frame.file.parts().size() - files.size();
    for (const LayerMap& map : frame.maps) {
        for (const auto& [role, expression] : map.layers) {
            for (const ChannelPlace& place : expression.places()) {
                if (place.part < own) continue;
                const std::string_view why = whyUnfit(files[place.part - own].format, findRole(role)->values);
                if (why.empty()) continue;
                const auto& [name, pattern] = options.files[place.part - own];
                throw UsageError(
                    fmt::format("--file {}={}: {}; '{}' needs EXR or PFM", name, pattern.text(), why, role));
            }
        }
    }
}

std::vector<std::string> warningsOf(const image::ExrDocument& file, const std::vector<LayerMap>& maps) {
    std::vector<std::string> result;
    std::set<size_t> replaced;
    for (const LayerMap& map : maps) {
        for (const std::string& remark : map.remarks)  // each view has it
            if (std::find(result.begin(), result.end(), remark) == result.end()) result.push_back(remark);
        for (const ChannelPlace& place : map.target().places()) replaced.insert(place.part);
    }
    uint64_t outside = 0;
    for (const size_t part : replaced) outside += file.pixelsOutside(part);
    if (outside > 0)
        result.push_back(fmt::format("{}: {} pixels outside the display window (overscan) stay as they were",
                                     file.name().string(), outside));
    return result;
}

/// Some renderers show the sky where alpha is 0. At borders they mix it with surfaces, so that dividing by
/// alpha would be wrong.
bool showsBackground(const ShotLayers& layers) {
    const std::vector<float>& alpha = layers.images.at("alpha").pixels;
    const std::vector<float>& beauty = layers.images.at("beauty").pixels;
    size_t empty = 0, lit = 0;
    for (size_t p = 0; p < alpha.size(); ++p) {
        if (alpha[p] > 0.0f) continue;
        ++empty;
        lit += std::any_of(&beauty[3 * p], &beauty[3 * p] + 3, [](float c) { return c > 0.0f; }) ? 1 : 0;
    }
    return 2 * lit > empty;  // lamps have no alpha, either
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
        const auto number = [&](const char* name) {
            const auto found = part.numbers.find(name);
            return found == part.numbers.end() ? 0.0 : std::max(found->second, 0.0);
        };
        const double perSide = number("arnold/AA_samples");
        for (const double count : {number("samplesPerPixel"), perSide * perSide})
            if (count >= 1.0) samples = static_cast<uint32_t>(std::min(count, 1e6));
    }
    return samples;
}

}  // namespace

LoadedFrame loadFrame(const std::filesystem::path& path, int number, const LoadOptions& options) {
    Hash64 content;
    std::vector<std::byte> bytes = readFile(path);
    content.addValues(bytes);
    LoadedFrame frame{.number = number, .file = openDocument(std::move(bytes), path)};
    std::vector<AttachedFile> attached;
    for (const auto& [name, pattern] : options.files) {
        const std::filesystem::path file = pattern.format(std::max(number, 0));
        bytes = readFile(file);
        content.addValues(bytes);
        attached.push_back(openAttached(std::move(bytes), file));
        frame.file.attach(name, channelsOf(attached.back()), file);
    }
    frame.content = content.value();
    frame.maps = recognise(frame.file, options.assignments);
    checkFormats(frame, options, attached);
    fillAttached(frame, attached);
    frame.warnings = warningsOf(frame.file, frame.maps);
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
        const image::LayeredImage picture = layeredImage(frame.file, options.network, options.variances);
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
        ShotLayers& layers = frame.layers.emplace_back(readLayers(frame.file, map));
        layers.camera = cameraOfAttributes(frame.file, map.view);
        layers.samples = samplesOf(frame.file);
        layers.showsSky = layers.isTransparent && showsBackground(layers);
        layers.isTransparent = layers.isTransparent && !layers.showsSky;
        if (options.network || !options.searchMotion) restoreZeroMotion(layers);
    }
}

}  // namespace limpid::shot
