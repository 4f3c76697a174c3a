#include "lab/quality/quality_message.h"

#include <concepts>
#include <cstring>
#include <string>
#include <type_traits>

#include "base/error.h"

namespace limpid::cli {
namespace {

constexpr const char* damaged = "a message between the processes is damaged";

/// Sent as its bytes.
template <typename T>
concept Plain = std::is_arithmetic_v<T> || std::same_as<T, image::FrameScores>;
static_assert(std::is_trivially_copyable_v<image::FrameScores>);

class Encoder {
  public:
    template <Plain T>
    void operator()(const T& value) {
        bytes(std::as_bytes(std::span<const T, 1>(&value, 1)));
    }
    void operator()(const std::string& text) { plainValues(text); }
    template <typename T>
    void operator()(const std::vector<T>& values) {
        if constexpr (Plain<T>) {
            plainValues(values);
        } else {
            (*this)(uint64_t{values.size()});
            for (const T& value : values) (*this)(value);
        }
    }
    template <typename K, typename V>
    void operator()(const std::map<K, V>& values) {
        (*this)(uint64_t{values.size()});
        for (const auto& [key, value] : values) {
            (*this)(key);
            (*this)(value);
        }
    }
    template <typename T>
    requires(!Plain<T>) void operator()(const T& value) { exchange(*this, value); }

    std::vector<std::byte> result;

  private:
    template <typename Values>
    void plainValues(const Values& values) {
        (*this)(uint64_t{values.size()});
        bytes(std::as_bytes(std::span(values)));
    }
    void bytes(std::span<const std::byte> added) { result.insert(result.end(), added.begin(), added.end()); }
};

class Decoder {
  public:
    explicit Decoder(std::span<const std::byte> message) : left_(message) {}

    template <Plain T>
    void operator()(T& value) {
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
    }
    void operator()(std::string& text) { plainValues(text); }
    template <typename T>
    void operator()(std::vector<T>& values) {
        if constexpr (Plain<T>) {
            plainValues(values);
        } else {
            values.clear();
            for (uint64_t left = count(1); left > 0; --left) (*this)(values.emplace_back());
        }
    }
    template <typename K, typename V>
    void operator()(std::map<K, V>& values) {
        values.clear();
        for (uint64_t left = count(1); left > 0; --left) {
            K key{};
            (*this)(key);
            (*this)(values[key]);
        }
    }
    template <typename T>
    requires(!Plain<T>) void operator()(T& value) { exchange(*this, value); }

    bool atEnd() const { return left_.empty(); }

  private:
    /// Of values of at least `size` bytes each.
    uint64_t count(size_t size) {
        uint64_t number = 0;
        (*this)(number);
        if (number > left_.size() / size) throw Error(damaged);
        return number;
    }
    template <typename Values>
    void plainValues(Values& values) {
        constexpr size_t size = sizeof(typename Values::value_type);
        values.resize(count(size));
        const auto taken = take(values.size() * size);
        if (!taken.empty()) std::memcpy(values.data(), taken.data(), taken.size());
    }
    std::span<const std::byte> take(size_t size) {
        if (size > left_.size()) throw Error(damaged);
        const auto taken = left_.first(size);
        left_ = left_.subspan(size);
        return taken;
    }

    std::span<const std::byte> left_;
};

// Each type once, for both directions: `T` is const when it is encoded.
template <typename T, typename U>
concept Same = std::is_same_v<std::remove_const_t<T>, U>;

void exchange(auto& coder, Same<image::Image> auto& picture) {
    coder(picture.width);
    coder(picture.height);
    coder(picture.components);
    coder(picture.pixels);
}

void exchange(auto& coder, Same<MethodQuality> auto& method) {
    coder(method.name);
    coder(method.scores);
    coder(method.last);
    coder(method.pictures);
    coder(method.errorMaps);
    coder(method.medianMs);
    coder(method.denoisingMs);
    coder(method.denoisingBytesPerPixel);
}

void exchange(auto& coder, Same<SequenceQuality> auto& quality) {
    coder(quality.methods);
    coder(quality.referencePsnr);
    coder(quality.exposure);
    coder(quality.reference);
    coder(quality.referencePictures);
}

void exchange(auto& coder, Same<MeasuredSequence> auto& measured) {
    coder(measured.triangles);
    coder(measured.quality);
}

void exchange(auto& coder, Same<SkippedSequence> auto& skipped) {
    coder(skipped.name);
    coder(skipped.reason);
}

/// The alternative's index, then its value.
void exchange(Encoder& coder, const QualityOutcome& outcome) {
    coder(uint64_t{outcome.index()});
    std::visit([&](const auto& value) { coder(value); }, outcome);
}

void exchange(Decoder& coder, QualityOutcome& outcome) {
    uint64_t index = 0;
    coder(index);
    if (index == 0) {
        coder(outcome.emplace<MeasuredSequence>());
    } else if (index == 1) {
        coder(outcome.emplace<SkippedSequence>());
    } else {
        throw Error(damaged);
    }
}

}  // namespace

std::vector<std::byte> encodeOutcomes(const QualityOutcomes& outcomes) {
    Encoder encoder;
    encoder(outcomes);
    return std::move(encoder.result);
}

QualityOutcomes decodeOutcomes(std::span<const std::byte> message) {
    QualityOutcomes outcomes;
    Decoder decoder(message);
    decoder(outcomes);
    if (!decoder.atEnd()) throw Error(damaged);
    return outcomes;
}

}  // namespace limpid::cli
