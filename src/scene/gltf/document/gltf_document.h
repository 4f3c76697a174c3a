// A glTF document in memory: its JSON, its binary chunk and its buffers. Checks every byte range before use.
// Compressed buffer views (gltf_meshopt.h) and primitives (gltf_draco.h) are decoded when the document is
// loaded, so code that reads accessors sees plain data.
//
// Specification: glTF 2.0, sections 3.6 (binary data) and 4 (GLB),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/gltf/document/gltf_json.h"
#include "scene/load/scene_files.h"

namespace limpid::scene::gltf {

/// Reads the file and all its buffers. Throws InputError on every fault: not JSON, a GLB with an incorrect
/// header, a version other than 2, a required extension that is not supported, a buffer that is missing or
/// short, damaged compressed data.
class Document {
  public:
    explicit Document(const std::filesystem::path& file, const std::filesystem::path& assetRoot = {});
    ~Document();
    Document(const Document&) = delete;
    Document& operator=(const Document&) = delete;

    const std::filesystem::path& file() const { return files_.sceneFile(); }
    const Object& root() const { return lists_->root; }
    SceneFiles& files() { return files_; }

    /// The document's lists of objects, by index; empty if absent.
    struct Lists {
        explicit Lists(const Object& root);
        Object root;
        std::vector<Object> accessors, animations, bufferViews, cameras, images, lights, materials, meshes,
            nodes, samplers, scenes, skins, textures;
    };
    const Lists& lists() const { return *lists_; }

    /// Number of bytes of the file and all buffers, as stored.
    uint64_t byteCount() const { return byteCount_; }

    /// Returns the bytes of a buffer view (valid index), decoded if it is compressed. Throws InputError if
    /// they are not inside its buffer.
    std::span<const std::byte> bytes(int bufferView) const;

    /// The limit on the total size of decoded data: `decodedFloor` plus a multiple of the buffers' bytes, but
    /// at most `maxDecodedBytes`. So a file that repeats its data cannot fill the memory.
    static constexpr uint64_t decodedFloor = uint64_t{64} << 20;
    static constexpr uint64_t decodedPerByte = 64;
    static constexpr uint64_t maxDecodedBytes = uint64_t{4} << 30;

    /// Decodes a "data:...;base64,..." URI. The error for an invalid one names `owner`.
    static std::vector<std::byte> decodeDataUri(std::string_view uri, const Object& owner);
    static bool isDataUri(std::string_view uri) { return uri.starts_with("data:"); }

    /// Logs a warning with the file's name; each text only once, and only a handful in total.
    void warn(const std::string& message);

  private:
    std::vector<std::byte> takeJson(std::vector<std::byte> content);
    void checkAsset() const;
    void checkExtensions();
    void readBuffers();
    bool isPlaceholder(const Object& buffer) const;
    void decodeViews();
    void expandPrimitives();
    std::span<const std::byte> slice(const Object& view) const;

    SceneFiles files_;
    std::unique_ptr<Json> json_;
    std::unique_ptr<const Lists> lists_;
    std::vector<std::byte> binaryChunk_;
    std::vector<std::vector<std::byte>> buffers_;
    std::map<int, std::vector<std::byte>> decodedViews_;  ///< the compressed ones
    uint64_t decodedBytesLeft_ = 0;
    uint64_t byteCount_ = 0;
    std::set<std::string> warnings_;
};

}  // namespace limpid::scene::gltf
