// The loop of one level of an a-trous filter: a kernel of 5x5 (or 3x3) taps that lie a step apart. Each invocation
// filters a block of pixels that lie a step apart, too, so that they share taps: of the 3 x 25 taps of a column of
// three, 35 are different. What a tap weighs is the including shader's; it declares beforehand:
//   - `params` with width, height and step (a power of 2)
//   - const ivec2 BLOCK: the pixels of an invocation, as given to levelInvocations()
//   - const int REACH: 2 for 5x5 taps, 1 for 3x3
//   - struct Tap, Tap loadTap(ivec2 at); `at` may lie outside of the picture
//   - struct Centre, Centre begin(ivec2 at, int number): the pixel's own tap added; `number` counts within the block
//   - bool isFiltered(Centre): false if the pixel keeps its own light
//   - void addTo(inout Centre, Tap, ivec2 from): `from` is the tap's offset in steps
//   - void store(ivec2 at, Centre): `at` may lie outside of the picture
// A shader that defines LIMPID_LEVEL_LOOKS_FIRST may visit all taps twice, and declares:
//   - const bool LOOKS: true: visit all taps with lookAt() first, then all with addTo()
//   - void lookAt(inout Centre, Tap, ivec2 from)
//   - void looked(inout Centre): after the last lookAt()
#ifndef LIMPID_ATROUS_LEVEL_GLSL
#define LIMPID_ATROUS_LEVEL_GLSL

#extension GL_EXT_control_flow_attributes : require

const int BLOCK_PIXELS = BLOCK.x * BLOCK.y;

ivec2 inBlock(int number) {
    return ivec2(number % BLOCK.x, number / BLOCK.x);
}

/// The first pixel of an invocation's block. Neighbouring invocations filter neighbouring pixels, so that a row of
/// them reads whole cache lines at any step.
ivec2 firstOfBlock(ivec2 invocation) {
    const int power = findMSB(params.step);  // shifts are cheaper than divisions
    return (invocation >> power) * (BLOCK << power) + (invocation & (params.step - 1));
}

bool isTapOf(ivec2 from) {
    return abs(from.x) <= REACH && abs(from.y) <= REACH && from != ivec2(0);
}

#ifndef LIMPID_LEVEL_LOOKS_FIRST
const bool LOOKS = false;
void lookAt(inout Centre centre, Tap tap, ivec2 from) {}
void looked(inout Centre centre) {}
#endif

Centre centres[BLOCK_PIXELS];

/// A second visit loads the taps again: they are cached, and take too many registers to be kept.
void visitTaps(ivec2 first, bool looking) {
    [[unroll]] for (int j = -2; j < BLOCK.y + 2; ++j) {
        [[unroll]] for (int i = -2; i < BLOCK.x + 2; ++i) {
            if (i < -REACH || i >= BLOCK.x + REACH || j < -REACH || j >= BLOCK.y + REACH) continue;
            const Tap tap = loadTap(first + params.step * ivec2(i, j));
            [[unroll]] for (int number = 0; number < BLOCK_PIXELS; ++number) {
                const ivec2 from = ivec2(i, j) - inBlock(number);
                if (!isTapOf(from)) continue;
                if (looking)
                    lookAt(centres[number], tap, from);
                else
                    addTo(centres[number], tap, from);
            }
        }
    }
}

void filterBlock(ivec2 first) {
    bool any = false;
    [[unroll]] for (int number = 0; number < BLOCK_PIXELS; ++number) {
        centres[number] = begin(first + params.step * inBlock(number), number);
        any = any || isFiltered(centres[number]);
    }
    if (any && LOOKS) {
        visitTaps(first, true);
        [[unroll]] for (int number = 0; number < BLOCK_PIXELS; ++number) looked(centres[number]);
    }
    if (any) visitTaps(first, false);
    [[unroll]] for (int number = 0; number < BLOCK_PIXELS; ++number)
        store(first + params.step * inBlock(number), centres[number]);
}

#endif
