/* Tests that header and library have the same version, and that a call that needs no device works. */
#include <limpid/denoise.h>
#include <stdio.h>

int main(void) {
    const uint32_t header =
        10000u * LIMPID_VERSION_MAJOR + 100u * LIMPID_VERSION_MINOR + LIMPID_VERSION_PATCH;
    limpid_parameter parameter;
    if (limpid_version() != header) {
        printf("the library is of version %u, its header of %u\n", limpid_version(), header);
        return 1;
    }
    if (limpid_method_parameter(LIMPID_METHOD_SVGF, 0, &parameter) != LIMPID_OK) {
        printf("%s\n", limpid_last_error());
        return 1;
    }
    printf("Limpid %u, first parameter of SVGF: %s\n", header, parameter.name);
    return 0;
}
