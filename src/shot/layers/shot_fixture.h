// Files of other renderers for tests: EXR documents in memory, with one part or several.
#pragma once

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/files/file.h"
#include "image/io/exr/exr_document.h"
#include "image/io/temp_folder.h"

namespace limpid::shot::test {

/// The value of a channel at a pixel.
using Values = std::function<float(const std::string& channel, uint32_t x, uint32_t y)>;

struct TestPart {
    std::string name;
    std::vector<std::string> channels;  ///< all float
    std::vector<std::pair<std::string, std::string>> texts;
    std::vector<std::pair<std::string, Imath::M44f>> matrices;
    std::string view;                ///< the part's; none if empty
    std::vector<std::string> views;  ///< the attribute "multiView"; none if empty
    float pixelAspect = 1.0f;
    int overscan = 0;  ///< how many columns of the data are left of the display window
};

inline Imf::Header headerOf(const TestPart& part, uint32_t width, uint32_t height) {
    Imf::Header header(static_cast<int>(width), static_cast<int>(height));
    header.compression() = Imf::ZIP_COMPRESSION;
    header.pixelAspectRatio() = part.pixelAspect;
    header.displayWindow().min.x += part.overscan;
    for (const std::string& channel : part.channels)
        header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    for (const auto& [name, text] : part.texts) header.insert(name, Imf::StringAttribute(text));
    for (const auto& [name, matrix] : part.matrices) header.insert(name, Imf::M44fAttribute(matrix));
    if (!part.view.empty()) header.setView(part.view);
    if (!part.views.empty()) Imf::addMultiView(header, part.views);
    return header;
}

/// Writes a file with the OpenEXR library: with one part, or with several that have names.
inline std::filesystem::path writeParts(const std::filesystem::path& path, const std::vector<TestPart>& parts,
                                        uint32_t width, uint32_t height, const Values& value) {
    std::vector<Imf::Header> headers;
    std::vector<std::vector<std::vector<float>>> planes;
    for (const TestPart& part : parts) {
        headers.push_back(headerOf(part, width, height));
        auto& channels = planes.emplace_back();
        for (const std::string& channel : part.channels) {
            auto& plane = channels.emplace_back();
            for (uint32_t y = 0; y < height; ++y)
                for (uint32_t x = 0; x < width; ++x) plane.push_back(value(channel, x, y));
        }
    }
    const auto frameOf = [&](size_t part) {
        Imf::FrameBuffer frame;
        for (size_t c = 0; c < parts[part].channels.size(); ++c)
            frame.insert(
                parts[part].channels[c],
                Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(planes[part][c].data()), 4, 4 * width));
        return frame;
    };
    if (parts.size() == 1) {
        Imf::OutputFile file(path.c_str(), headers.front());
        file.setFrameBuffer(frameOf(0));
        file.writePixels(static_cast<int>(height));
        return path;
    }
    for (size_t i = 0; i < parts.size(); ++i) {
        headers[i].setName(parts[i].name);
        headers[i].setType(Imf::SCANLINEIMAGE);
    }
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
    for (size_t i = 0; i < parts.size(); ++i) {
        Imf::OutputPart part(file, static_cast<int>(i));
        part.setFrameBuffer(frameOf(i));
        part.writePixels(static_cast<int>(height));
    }
    return path;
}

/// Splits "R G B" into names, each after `prefix`.
inline std::vector<std::string> names(const std::string& list, const std::string& prefix = {}) {
    std::vector<std::string> result;
    size_t begin = 0;
    while (begin < list.size()) {
        const size_t end = std::min(list.find(' ', begin), list.size());
        result.push_back(prefix + list.substr(begin, end - begin));
        begin = end + 1;
    }
    return result;
}

}  // namespace limpid::shot::test
