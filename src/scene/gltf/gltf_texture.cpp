#include "scene/gltf/gltf_texture.h"

#include <fmt/format.h>

#include <cmath>

namespace limpid::scene::gltf {
namespace {

enum GlFilter : uint64_t {
    Nearest = 9728,
    Linear = 9729,
    NearestMipmapNearest = 9984,
    LinearMipmapNearest = 9985,
    NearestMipmapLinear = 9986,
    LinearMipmapLinear = 9987
};
enum GlWrap : uint64_t { ClampToEdge = 33071, MirroredRepeat = 33648, Repeat = 10497 };

Wrap toWrap(const Object& sampler, const char* key) {
    switch (const uint64_t mode = sampler.whole(key, Repeat)) {
        case Repeat:
            return Wrap::Repeat;
        case ClampToEdge:
            return Wrap::ClampToEdge;
        case MirroredRepeat:
            return Wrap::MirroredRepeat;
        default:
            sampler.fail(key, fmt::format("is {}, which is none of glTF's", mode));
    }
}

void setMinFilter(const Object& source, Sampler& sampler) {
    const uint64_t filter = source.whole("minFilter", LinearMipmapLinear);
    switch (filter) {
        case Nearest:
        case Linear:
            sampler.mip = MipFilter::None;
            break;
        case NearestMipmapNearest:
        case LinearMipmapNearest:
            sampler.mip = MipFilter::Nearest;
            break;
        case NearestMipmapLinear:
        case LinearMipmapLinear:
            sampler.mip = MipFilter::Linear;
            break;
        default:
            source.fail("minFilter", fmt::format("is {}, which is none of glTF's", filter));
    }
    sampler.minLinear = filter == Linear || filter == LinearMipmapNearest || filter == LinearMipmapLinear;
}

/// KHR_texture_transform: translate * rotate * scale. A positive rotation is counter-clockwise with v
/// pointing down, so the signs of the sine differ from the listing in the extension's early drafts
/// (KhronosGroup/glTF issue 1563).
void applyTransform(const Object& transform, TextureRef& ref) {
    const vec2 offset = transform.vector("offset", vec2(0.0f));
    const vec2 scale = transform.vector("scale", vec2(1.0f));
    const float rotation = transform.number("rotation", 0.0f);
    const float c = std::cos(rotation);
    const float s = std::sin(rotation);
    ref.rowU = {c * scale.x, s * scale.y, offset.x};
    ref.rowV = {-s * scale.x, c * scale.y, offset.y};
}

}  // namespace

TextureRef TextureLibrary::add(const Object& owner, const char* key, bool srgb) {
    TextureRef ref;
    const auto info = owner.object(key);
    if (!info) return ref;
    const int index = info->index("index", document_.lists().textures.size());
    if (index == none) info->fail("has no index");
    uint64_t uvSet = info->whole("texCoord", 0);
    if (const auto transform = info->extension("KHR_texture_transform")) {
        applyTransform(*transform, ref);
        uvSet = transform->whole("texCoord", uvSet);
    }
    if (uvSet > 1) {
        document_.warn(
            fmt::format("{} uses TEXCOORD_{}; only 0 and 1 are read, 0 is used", info->place(), uvSet));
        uvSet = 0;
    }
    ref.uvSet = static_cast<int>(uvSet);
    ref.texture = texture(index, srgb);
    return ref;
}

int TextureLibrary::texture(int index, bool srgb) {
    const Object& source = document_.lists().textures[static_cast<size_t>(index)];
    const int image = source.index("source", document_.lists().images.size());
    if (image == none) {
        // glTF 2.0, 5.29.2: the appearance of a texture without a source is undefined.
        document_.warn(source.place() +
                       " is used, but has no image in a format that is supported (PNG, JPEG); a plain colour "
                       "is used");
        return none;
    }
    return pool_.add(imageName(image), srgb, sampler(source), imageReader(image));
}

std::string TextureLibrary::imageName(int image) const {
    const Object& source = document_.lists().images[static_cast<size_t>(image)];
    const std::string uri = source.text("uri");
    if (!uri.empty() && !Document::isDataUri(uri))
        return (document_.file().parent_path() / decodePercent(uri)).string();
    const std::string name = source.text("name");
    return fmt::format("{}: {}{}", document_.file().string(), source.place(),
                       name.empty() ? "" : " '" + name + "'");
}

/// Throws immediately if the document is invalid; errors in the image are thrown when it is read.
std::function<std::vector<std::byte>()> TextureLibrary::imageReader(int image) {
    const Object& source = document_.lists().images[static_cast<size_t>(image)];
    if (source.has("uri")) {
        return [this, &source, uri = source.text("uri")] {
            return Document::isDataUri(uri) ? Document::decodeDataUri(uri, source)
                                            : document_.files().read(decodePercent(uri), maxImageMemory_);
        };
    }
    const int view = source.index("bufferView", document_.lists().bufferViews.size());
    if (view == none) source.fail("has neither a URI nor a buffer view");
    const auto bytes = document_.bytes(view);
    return [bytes] { return std::vector<std::byte>(bytes.begin(), bytes.end()); };
}

Sampler TextureLibrary::sampler(const Object& texture) {
    Sampler sampler;
    const auto& samplers = document_.lists().samplers;
    const int index = texture.index("sampler", samplers.size());
    if (index == none) return sampler;
    const Object& source = samplers[static_cast<size_t>(index)];
    sampler.wrapU = toWrap(source, "wrapS");
    sampler.wrapV = toWrap(source, "wrapT");
    const uint64_t magnify = source.whole("magFilter", Linear);
    if (magnify != Nearest && magnify != Linear) source.fail("magFilter", "is neither nearest nor linear");
    sampler.magLinear = magnify == Linear;
    setMinFilter(source, sampler);
    return sampler;
}

void TextureLibrary::checkUnused() {
    for (const Object& texture : document_.lists().textures) {
        if (!texture.has("source")) document_.warn(texture.place() + " has no image and is not used");
    }
}

}  // namespace limpid::scene::gltf
