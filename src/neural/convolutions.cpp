#include "neural/convolutions.h"

#include <algorithm>
#include <cstring>
#include <oneapi/dnnl/dnnl.hpp>
#include <optional>

#include "base/error.h"

namespace limpid::neural {
namespace {

using dnnl::memory;

constexpr uint32_t taps = 5, reach = taps / 2;
constexpr uint32_t inputBlock = 16;  ///< channels per block in the input of begin()

uint32_t blocksOf(uint32_t channels, uint32_t block) {
    return (channels + block - 1) / block;
}

/// Returns the channels per block with which oneDNN has fast convolutions for this CPU.
uint32_t blockOfCpu() {
    const auto isa = static_cast<unsigned>(dnnl::get_effective_cpu_isa());
    return isa >= static_cast<unsigned>(dnnl::cpu_isa::avx512_core) ? 16 : 8;
}

memory::desc picture(uint32_t channels, uint32_t rows, uint32_t columns, memory::format_tag tag) {
    return {{1, channels, rows, columns}, memory::data_type::f32, tag};
}

/// One layer for pictures of a fixed size.
struct Step {
    dnnl::convolution_forward primitive;
    memory weights, bias, scratch;
    memory::desc source, result;
};

}  // namespace

struct ConvolutionChain::Impl {
    struct Kept {
        uint32_t inputs, outputs;  ///< rounded up to whole blocks for the first layer
        bool relu;
        memory weights, bias;  ///< (outputs, inputs, 5, 5)
    };

    dnnl::engine engine{dnnl::engine::kind::cpu, 0};
    dnnl::stream stream{engine};
    const uint32_t block = blockOfCpu();
    const memory::format_tag tag = block == 16 ? memory::format_tag::nChw16c : memory::format_tag::nChw8c;
    std::vector<Kept> layers;
    uint32_t columns = 0, height = 0;
    std::vector<Step> hidden;
    std::vector<memory> channels;  ///< results of the hidden layers, used alternately
    memory last;                   ///< input of the output layer

    uint32_t bandRows = 0;  ///< rows per step of the output layer
    std::optional<Step> output;
    memory band, blocked,
        planar;  ///< the output layer's input for one step, including the rows around it; its result in
                 ///< blocks; the same result as planar channels

    Kept keep(const ConvolutionLayer& layer, bool first) {
        Kept kept{layer.inputs, layer.outputs, layer.relu, {}, {}};
        if (first) kept.inputs = blocksOf(layer.inputs, inputBlock) * inputBlock;
        const memory::desc desc({layer.outputs, kept.inputs, taps, taps}, memory::data_type::f32,
                                memory::format_tag::oihw);
        kept.weights = memory(desc, engine);
        auto* into = static_cast<float*>(kept.weights.get_data_handle());
        std::fill_n(into, size_t{layer.outputs} * kept.inputs * taps * taps, 0.0f);
        const size_t line = size_t{layer.inputs} * taps * taps;
        for (uint32_t o = 0; o < layer.outputs; ++o)
            std::copy_n(&layer.weights[o * line], line, into + size_t{o} * kept.inputs * taps * taps);
        kept.bias = memory({{layer.outputs}, memory::data_type::f32, memory::format_tag::x}, engine);
        std::ranges::copy(layer.bias, static_cast<float*>(kept.bias.get_data_handle()));
        return kept;
    }

    /// `above`: rows of zero padding above and below; the output layer's input already includes them.
    Step step(const Kept& layer, uint32_t rows, uint32_t above) {
        using Forward = dnnl::convolution_forward;
        const memory::desc source = picture(layer.inputs, rows, columns, tag);
        const memory::desc result = picture(layer.outputs, rows + 2 * above - 2 * reach, columns, tag);
        const memory::desc weights({layer.outputs, layer.inputs, taps, taps}, memory::data_type::f32,
                                   memory::format_tag::any);
        dnnl::primitive_attr attributes;
        if (layer.relu) {
            dnnl::post_ops after;
            after.append_eltwise(1.0f, dnnl::algorithm::eltwise_relu, 0.0f, 0.0f);
            attributes.set_post_ops(after);
        }
        const memory::dims padding{above, reach};
        const Forward::primitive_desc desc({dnnl::prop_kind::forward_inference,
                                            dnnl::algorithm::convolution_direct,
                                            source,
                                            weights,
                                            layer.bias.get_desc(),
                                            result,
                                            {1, 1},
                                            padding,
                                            padding},
                                           attributes, engine);
        Step made{Forward(desc), memory(desc.weights_desc(), engine), layer.bias, {}, source, result};
        dnnl::reorder(layer.weights, made.weights)
            .execute(stream, const_cast<memory&>(layer.weights), made.weights);
        stream.wait();
        return made;
    }

    void run(const Step& step, const memory& source, const memory& result) {
        step.primitive.execute(stream, {{DNNL_ARG_SRC, source},
                                        {DNNL_ARG_WEIGHTS, step.weights},
                                        {DNNL_ARG_BIAS, step.bias},
                                        {DNNL_ARG_DST, result}});
        stream.wait();
    }

    void resize(uint32_t newColumns, uint32_t rows) {
        if (columns == newColumns && height == rows) return;
        columns = newColumns;
        height = rows;
        hidden.clear();
        channels.clear();
        bandRows = 0;
        for (size_t i = 0; i + 1 < layers.size(); ++i) {
            hidden.push_back(step(layers[i], rows, reach));
            channels.push_back(i < 2 ? memory(hidden.back().result, engine) : channels[i - 2]);
        }
    }

    void resizeBand(uint32_t rows) {
        if (bandRows == rows) return;
        bandRows = rows;
        output = step(layers.back(), rows + 2 * reach, 0);
        band = memory(output->source, engine);
        blocked = memory(output->result, engine);
        planar = memory(picture(layers.back().outputs, rows, columns, memory::format_tag::nchw), engine);
    }

    /// Copies rows of `last` from `first` - reach on; rows outside are zero.
    void fillBand(uint32_t first, uint32_t rows) {
        const size_t line = size_t{columns} * block;
        const auto* from = static_cast<const float*>(last.get_data_handle());
        auto* into = static_cast<float*>(band.get_data_handle());
        for (uint32_t b = 0; b < blocksOf(layers.back().inputs, block); ++b) {
            for (uint32_t i = 0; i < rows + 2 * reach; ++i, into += line) {
                const int64_t row = int64_t{first} + i - reach;
                if (row < 0 || row >= height)
                    std::fill_n(into, line, 0.0f);
                else
                    std::memcpy(into, from + (size_t{b} * height + static_cast<size_t>(row)) * line,
                                line * sizeof(float));
            }
        }
    }
};

ConvolutionChain::ConvolutionChain(const std::vector<ConvolutionLayer>& layers)
    : impl_(std::make_unique<Impl>()) {
    if (layers.empty()) throw Error("a chain of no convolutions");
    for (const ConvolutionLayer& layer : layers)
        impl_->layers.push_back(impl_->keep(layer, &layer == &layers.front()));
}

ConvolutionChain::~ConvolutionChain() = default;

void ConvolutionChain::begin(std::span<const float> input, uint32_t columns, uint32_t rows) {
    if (input.size() <
        size_t{blocksOf(impl_->layers.front().inputs, inputBlock)} * inputBlock * columns * rows)
        throw Error("a convolution's input is smaller than its picture");
    impl_->resize(columns, rows);
    memory source(picture(impl_->layers.front().inputs, rows, columns, memory::format_tag::nChw16c),
                  impl_->engine, const_cast<float*>(input.data()));
    if (impl_->block != inputBlock) {
        memory reordered(picture(impl_->layers.front().inputs, rows, columns, impl_->tag), impl_->engine);
        dnnl::reorder(source, reordered).execute(impl_->stream, source, reordered);
        impl_->stream.wait();
        source = reordered;
    }
    for (size_t i = 0; i < impl_->hidden.size(); ++i) {
        impl_->run(impl_->hidden[i], source, impl_->channels[i]);
        source = impl_->channels[i];
    }
    impl_->last = source;
}

std::span<float> ConvolutionChain::rows(uint32_t first, uint32_t count) {
    impl_->resizeBand(count);
    impl_->fillBand(first, count);
    impl_->run(*impl_->output, impl_->band, impl_->blocked);
    dnnl::reorder(impl_->blocked, impl_->planar).execute(impl_->stream, impl_->blocked, impl_->planar);
    impl_->stream.wait();
    return {static_cast<float*>(impl_->planar.get_data_handle()),
            size_t{impl_->layers.back().outputs} * count * impl_->columns};
}

}  // namespace limpid::neural
