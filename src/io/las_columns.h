#pragma once
/// Which extra columns a LAS file has, and in what order.

#include "las_decoder.h"

namespace ray {

/// The byte of the GPS time, and of red, in a record of that format; 0 where it has none.
[[nodiscard]] std::size_t las_times_at(int format);
[[nodiscard]] std::size_t las_colours_at(int format);

/// The standard's fields first, then `extra`; for a file of this project the columns its notes name, in that
/// order.
[[nodiscard]] std::vector<LasColumn> las_columns(const LasHeader& header,
                                                 const std::vector<LasExtraField>& extra);

}  // namespace ray
