/* Prints the sizes, offsets and values of neural.h. They must not change without a new SONAME. */
#include <limpid/neural.h>
#include <stddef.h>
#include <stdio.h>

#define STRUCT(type) printf("struct %s %zu\n", #type, sizeof(type))
#define MEMBER(type, member) printf("  %s %zu %zu\n", #member, offsetof(type, member), sizeof(((type*)0)->member))
#define VALUE(name) printf("  %s %d\n", #name, (int)name)

int main(void) {
    printf("enum limpid_network_input %zu\n", sizeof(limpid_network_input));
    VALUE(LIMPID_NETWORK_INPUT_DIFFUSE);
    VALUE(LIMPID_NETWORK_INPUT_SPECULAR);
    VALUE(LIMPID_NETWORK_INPUT_EMISSION);
    VALUE(LIMPID_NETWORK_INPUT_ALBEDO);
    VALUE(LIMPID_NETWORK_INPUT_NORMAL);
    VALUE(LIMPID_NETWORK_INPUT_DEPTH);
    VALUE(LIMPID_NETWORK_INPUT_DIFFUSE_VARIANCE);
    VALUE(LIMPID_NETWORK_INPUT_SPECULAR_VARIANCE);
    VALUE(LIMPID_NETWORK_INPUT_ALBEDO_VARIANCE);
    VALUE(LIMPID_NETWORK_INPUT_NORMAL_VARIANCE);
    VALUE(LIMPID_NETWORK_INPUT_DEPTH_VARIANCE);
    VALUE(LIMPID_NETWORK_INPUT_MAX);
    STRUCT(limpid_network_desc);
    MEMBER(limpid_network_desc, size);
    MEMBER(limpid_network_desc, weights);
    MEMBER(limpid_network_desc, far_depth);
    STRUCT(limpid_network_frame);
    MEMBER(limpid_network_frame, size);
    MEMBER(limpid_network_frame, width);
    MEMBER(limpid_network_frame, height);
    MEMBER(limpid_network_frame, samples);
    MEMBER(limpid_network_frame, inputs);
    MEMBER(limpid_network_frame, color);
    return 0;
}
