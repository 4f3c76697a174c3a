#include "shot/layers/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "base/error.h"

namespace limpid::shot {
namespace {

/// How files name the components of colours and vectors; the same position in each is the same component.
constexpr std::array<std::array<std::string_view, 4>, 6> spellings = {{{"R", "G", "B", "A"},
                                                                       {"X", "Y", "Z", "W"},
                                                                       {"r", "g", "b", "a"},
                                                                       {"x", "y", "z", "w"},
                                                                       {"red", "green", "blue", "alpha"},
                                                                       {"Red", "Green", "Blue", "Alpha"}}};

std::optional<size_t> positionOf(std::string_view component) {
    for (const auto& spelling : spellings) {
        const auto found = std::find(spelling.begin(), spelling.end(), component);
        if (found != spelling.end()) return static_cast<size_t>(found - spelling.begin());
    }
    return std::nullopt;
}

/// Adds the channels of the layer that `names` lists. False if one is missing.
template <typename Names>
bool addChannels(Factor& factor, const ChannelTable& table, std::string_view layer, const Names& names) {
    factor.channels.clear();
    for (const std::string_view name : names) {
        const ChannelPlace* const place = table.find(joined(layer, name));
        if (!place) return false;
        factor.channels.push_back(*place);
    }
    return true;
}

/// Finds the first layer with exactly this component, whatever its name.
std::optional<Factor> anyLayer(std::string_view component, const ChannelTable& table,
                               std::string_view prefix) {
    for (const LayerChannels& layer : table.layers()) {
        if (!layer.name.starts_with(prefix) || layer.name.size() == prefix.size()) continue;
        Factor factor{joined(layer.name, component), {}};
        if (addChannels(factor, table, layer.name, std::array{component})) return factor;
    }
    return std::nullopt;
}

/// Finds "Nx", "Ny" and "Nz" for "N.XYZ".
std::optional<Factor> joinedNames(const std::string& layer, const std::vector<std::string_view>& letters,
                                  const ChannelTable& table) {
    std::vector<std::string> names;
    for (const std::string_view letter : letters)
        if (const auto position = positionOf(letter))
            names.push_back(layer + std::string(spellings[3][*position]));
    Factor factor{fmt::format("{}", fmt::join(names, ",")), {}};
    if (layer.empty() || names.size() != letters.size() || !addChannels(factor, table, "", names))
        return std::nullopt;
    return factor;
}

std::optional<Factor> resolveFactor(std::string_view text, const ChannelTable& table,
                                    std::string_view prefix) {
    const ChannelName name = split(text);
    if (name.layer == "*") return anyLayer(name.component, table, prefix);
    const std::string layer = std::string(prefix) + std::string(name.layer);
    Factor factor{joined(layer, name.component), {}};
    if (name.component == "?") {
        const LayerChannels* const channels = table.layer(layer);
        if (!channels || channels->components.size() != 1) return std::nullopt;
        factor.text = joined(layer, channels->components.front());
        addChannels(factor, table, layer, channels->components);
        return factor;
    }
    std::vector<std::string_view> letters;
    for (size_t i = 0; i < name.component.size(); ++i) letters.push_back(name.component.substr(i, 1));
    if (addChannels(factor, table, layer, letters)) return factor;
    if (addChannels(factor, table, layer, std::array{name.component})) return factor;  // "alpha", "distance"
    if (letters.size() < 2) return std::nullopt;  // a depth "Z" is no "B"
    for (const auto& spelling : spellings) {
        std::vector<std::string_view> names;
        for (const std::string_view letter : letters)
            if (const auto position = positionOf(letter)) names.push_back(spelling[*position]);
        if (names.size() == letters.size() && addChannels(factor, table, layer, names)) return factor;
    }
    return joinedNames(layer, letters, table);
}

/// Splits at " SIGN " for any of the signs, and tells which sign preceded each piece.
struct Piece {
    char sign;
    std::string_view text;
};
std::vector<Piece> pieces(std::string_view text, std::string_view signs) {
    std::vector<Piece> result;
    char sign = signs.front();
    size_t begin = 0;
    for (size_t i = 0; i + 2 < text.size(); ++i) {
        if (text[i] != ' ' || text[i + 2] != ' ' || signs.find(text[i + 1]) == std::string_view::npos)
            continue;
        result.push_back({sign, text.substr(begin, i - begin)});
        sign = text[i + 1];
        begin = i + 3;
        i += 2;
    }
    result.push_back({sign, text.substr(begin)});
    return result;
}

std::optional<float> numberOf(std::string_view text) {
    float value = 0.0f;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::optional<Term> resolveTerm(const Piece& piece, const ChannelTable& table, std::string_view prefix) {
    Term term{piece.sign == '-' ? -1.0f : 1.0f, {}};
    for (const Piece& factor : pieces(piece.text, "*")) {
        if (factor.text.empty() || factor.text.front() == ' ' || factor.text.back() == ' ')
            throw UsageError(fmt::format("'{}' is no product of layers", piece.text));
        if (const auto number = numberOf(factor.text)) {
            term.scale *= *number;
            continue;
        }
        auto resolved = resolveFactor(factor.text, table, prefix);
        if (!resolved) return std::nullopt;
        term.factors.push_back(std::move(*resolved));
    }
    if (term.factors.empty()) throw UsageError(fmt::format("'{}' names no layer", piece.text));
    return term;
}

/// Multiplies the product by the factor's channels.
void multiply(image::Image& product, const Factor& factor, image::ExrDocument& file) {
    std::vector<float> values;
    for (uint32_t c = 0; c < product.components; ++c) {
        if (c < factor.channels.size())
            values = file.values(factor.channels[c].part, factor.channels[c].channel);
        for (size_t p = 0; p < values.size(); ++p) product.pixels[product.components * p + c] *= values[p];
    }
}

}  // namespace

std::optional<LayerExpression> LayerExpression::resolve(std::string_view text, const ChannelTable& table,
                                                        std::string_view prefix, bool partial) {
    LayerExpression result;
    for (const Piece& piece : pieces(text, "+-")) {
        auto term = resolveTerm(piece, table, prefix);
        if (!term && !partial) return std::nullopt;
        if (term) result.terms_.push_back(std::move(*term));
    }
    if (result.terms_.empty()) return std::nullopt;
    for (const Term& term : result.terms_)
        for (const Factor& factor : term.factors)
            if (factor.channels.size() != 1 && factor.channels.size() != result.components())
                throw UsageError(
                    fmt::format("'{}': '{}' has another number of components", text, factor.text));
    return result;
}

std::string LayerExpression::text() const {
    std::string result;
    for (const Term& term : terms_) {
        if (!result.empty() || term.scale < 0.0f) result += term.scale < 0.0f ? " - " : " + ";
        std::string product;
        if (std::abs(term.scale) != 1.0f) product = fmt::format("{}", std::abs(term.scale));
        for (const Factor& factor : term.factors) product += (product.empty() ? "" : " * ") + factor.text;
        result += product;
    }
    return result;
}

std::vector<ChannelPlace> LayerExpression::places() const {
    std::vector<ChannelPlace> result;
    for (const Term& term : terms_)
        for (const Factor& factor : term.factors)
            result.insert(result.end(), factor.channels.begin(), factor.channels.end());
    return result;
}

uint32_t LayerExpression::components() const {
    size_t most = 0;
    for (const Term& term : terms_)
        for (const Factor& factor : term.factors) most = std::max(most, factor.channels.size());
    return static_cast<uint32_t>(most);
}

image::Image LayerExpression::evaluate(image::ExrDocument& file) const {
    image::Image sum;
    for (const Term& term : terms_) {
        image::Image product(file.width(), file.height(), components(), term.scale);
        for (const Factor& factor : term.factors) multiply(product, factor, file);
        if (sum.pixels.empty())  // most have one term: no second image
            sum = std::move(product);
        else
            for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += product.pixels[i];
    }
    for (float& value : sum.pixels) value += 0.0f;  // no negative zeros
    return sum;
}

}  // namespace limpid::shot
