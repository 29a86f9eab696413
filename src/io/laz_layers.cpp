#include "laz_layers.h"

#include "laz_reader.h"

#include <raycloud/core/error.h>

#include <limits>
#include <string>

namespace ray {

std::vector<std::uint64_t> layered_chunks(const InputFile& input, const LasHeader& header) {
  std::vector<std::uint64_t> starts;
  const std::vector<std::size_t> layers = laszip_layers(header);
  if (layers.empty()) return starts;
  std::size_t layer_count = 0;
  for (const std::size_t count : layers)
    layer_count += count;
  // A whole point, the number of points, the sizes of the layers, the layers.
  std::vector<std::byte> head(header.record_length + 4 + 4 * layer_count);
  const std::uint32_t fixed = laz_chunk_rows(header);
  std::uint64_t at = header.points_at + 8;
  for (std::uint64_t row = 0; row < header.point_count;) {
    starts.push_back(at);
    if (input.read_at(at, head) < head.size()) break;
    const std::byte* word = head.data() + header.record_length;
    const auto rows = load<std::uint32_t>(word);
    at += head.size();
    for (const std::size_t count : layers) {
      std::uint64_t bytes = 0;
      for (std::size_t layer = 0; layer < count; ++layer)
        bytes += load<std::uint32_t>(word += 4);
      if (bytes > std::numeric_limits<std::uint32_t>::max())
        throw Error(ErrorCode::file_format, input.path().string() + ": damaged after point " +
                                                std::to_string(row) + " of " +
                                                std::to_string(header.point_count));
      at += bytes;
    }
    if (at >= input.size()) break;
    row += fixed == kVariableChunk ? rows : fixed;
  }
  return starts;
}

}  // namespace ray
