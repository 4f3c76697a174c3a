#include "neural/channels_last.h"

#include <algorithm>
#include <oneapi/dnnl/dnnl.hpp>

#include "base/error.h"

namespace limpid::neural {
namespace {

using dnnl::memory;
using Forward = dnnl::convolution_forward;

struct Engine {
    dnnl::engine engine{dnnl::engine::kind::cpu, 0};
    dnnl::stream stream{engine};
};

memory::desc floats(const memory::dims& size, memory::format_tag tag) {
    return {size, memory::data_type::f32, tag};
}

/// What is done to the sums.
dnnl::primitive_attr afterwards(const ConvolutionShape& shape) {
    dnnl::post_ops steps;
    if (shape.adds) steps.append_sum(1.0f);
    if (shape.slope != 1.0f) steps.append_eltwise(1.0f, dnnl::algorithm::eltwise_relu, shape.slope, 0.0f);
    dnnl::primitive_attr attributes;
    attributes.set_post_ops(steps);
    return attributes;
}

Forward::primitive_desc describe(const ConvolutionShape& shape, const dnnl::engine& engine) {
    constexpr auto last = memory::format_tag::nhwc;
    const uint32_t around = shape.taps % 2 == 1 ? shape.taps / 2 : 0;
    const memory::dims padding{around, around};
    return {{dnnl::prop_kind::forward_inference,
             dnnl::algorithm::convolution_direct,
             floats({1, shape.inputs, shape.rows, shape.columns}, last),
             floats({shape.outputs, shape.inputs, shape.taps, shape.taps}, memory::format_tag::any),
             floats({shape.outputs}, memory::format_tag::x),
             floats({1, shape.outputs, shape.rows / shape.stride, shape.columns / shape.stride}, last),
             {shape.stride, shape.stride},
             padding,
             padding},
            afterwards(shape),
            engine};
}

}  // namespace

struct ChannelsLastConvolution::Impl {
    Engine cpu;
    Forward::primitive_desc description;
    Forward primitive;
    memory input, weights, biases, result;
    size_t inputSize, resultSize;

    explicit Impl(const ConvolutionShape& shape)
        : description(describe(shape, cpu.engine)),
          primitive(description),
          input(description.src_desc(), cpu.engine, nullptr),
          weights(description.weights_desc(), cpu.engine),
          biases(description.bias_desc(), cpu.engine),
          result(description.dst_desc(), cpu.engine, nullptr),
          inputSize(size_t{shape.rows} * shape.columns * shape.inputs),
          resultSize(size_t{shape.rows / shape.stride} * (shape.columns / shape.stride) * shape.outputs) {}
};

ChannelsLastConvolution::ChannelsLastConvolution(const ConvolutionShape& shape,
                                                 std::span<const float> weights,
                                                 std::span<const float> biases)
    : impl_(std::make_unique<Impl>(shape)) {
    memory given(floats({shape.outputs, shape.inputs, shape.taps, shape.taps}, memory::format_tag::oihw),
                 impl_->cpu.engine, const_cast<float*>(weights.data()));
    if (weights.size() != given.get_desc().get_size() / sizeof(float) ||
        (!biases.empty() && biases.size() != shape.outputs))
        throw Error("a convolution has weights or biases of another shape");
    dnnl::reorder(given, impl_->weights).execute(impl_->cpu.stream, given, impl_->weights);
    impl_->cpu.stream.wait();
    auto* const kept = static_cast<float*>(impl_->biases.get_data_handle());
    std::fill_n(kept, shape.outputs, 0.0f);
    std::ranges::copy(biases, kept);
}

ChannelsLastConvolution::~ChannelsLastConvolution() = default;
ChannelsLastConvolution::ChannelsLastConvolution(ChannelsLastConvolution&&) noexcept = default;
ChannelsLastConvolution& ChannelsLastConvolution::operator=(ChannelsLastConvolution&&) noexcept = default;

void ChannelsLastConvolution::run(std::span<const float> input, std::span<float> result) {
    if (input.size() != impl_->inputSize || result.size() != impl_->resultSize)
        throw Error("a convolution's input or result has another size than its shape says");
    impl_->input.set_data_handle(const_cast<float*>(input.data()));
    impl_->result.set_data_handle(result.data());
    impl_->primitive.execute(impl_->cpu.stream, {{DNNL_ARG_SRC, impl_->input},
                                                 {DNNL_ARG_WEIGHTS, impl_->weights},
                                                 {DNNL_ARG_BIAS, impl_->biases},
                                                 {DNNL_ARG_DST, impl_->result}});
    impl_->cpu.stream.wait();
}

}  // namespace limpid::neural
