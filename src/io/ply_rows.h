#pragma once
/// The rows of a PLY file's vertex element, block by block, from any encoding to the one of PlyLayout.

#include "ply_header.h"
#include "ply_schema.h"

#include <raycloud/core/ray_stream.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace ray {

class PlyRows {
 public:
  virtual ~PlyRows() = default;

  /// The next block of at most `most_rows`, as RaySource::fetch. Throws Error(file_format) where the file
  /// ends early.
  [[nodiscard]] virtual bool fetch(RawChunk& raw, std::size_t most_rows) = 0;
  /// The next fetch begins at this row, if the encoding allows to jump; at row 0 otherwise.
  virtual void jump(std::uint64_t row) = 0;
  /// The fetched rows in the form of layout(): views `raw` or what it wrote to `scratch`. Thread-safe.
  [[nodiscard]] virtual std::span<const std::byte> unpack(const RawChunk& raw,
                                                          std::vector<std::byte>& scratch) const = 0;
};

/// Names one row of a file for a message: "scan.ply: truncated at ray 10412 of 34579 (byte 375004)".
struct PlyRowNames {
  std::string path;
  std::string noun;  ///< "ray" or "point"
};

/// Checks what can be checked without reading all: a binary file's size to the byte, a text file's roughly.
/// Throws Error(file_format) for a file that is too short, or too long with nothing but vertices.
[[nodiscard]] std::unique_ptr<PlyRows> open_ply_rows(const InputFile& file, const PlyHeader& header,
                                                     PlyRowNames names);

}  // namespace ray
