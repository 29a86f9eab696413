#pragma once
/// The chunks of LAZ files whose fields are stored as layers (point formats 6 to 10), checked before LASzip
/// sees them: it adds the sizes of the layers in 32 bits, and would write past its memory where the sum does
/// not fit.

#include "las_header.h"

#include <cstdint>
#include <vector>

namespace ray {

/// Where each chunk begins, in bytes from the start of the file, as the layer sizes of the one before tell;
/// the last may be cut short. Empty where fields are not stored as layers. Throws Error(file_format) for
/// sizes that overflow. Reads some 100 bytes a chunk. Precondition: check_laszip_record.
[[nodiscard]] std::vector<std::uint64_t> layered_chunks(const InputFile& input, const LasHeader& header);

}  // namespace ray
