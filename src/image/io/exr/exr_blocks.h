// Copies parts of EXR files without decoding them. Private to src/image.
#pragma once

#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>

#include <cstddef>

namespace limpid::image {

/// Copies the compressed blocks of a part as they are, after a check of those that are deep. `header`: of the
/// output's part; `fileBytes`: of the input. Throws std::exception.
void copyExrBlocks(Imf::MultiPartInputFile& from, Imf::MultiPartOutputFile& to, int index,
                   const Imf::Header& header, size_t fileBytes);

}  // namespace limpid::image
