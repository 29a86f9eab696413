#pragma once
/// How the points of a LAZ file are dealt out to several readers.

#include "las_header.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace ray {

/// The number of chunks in the table that LASzip needs to seek, if it is there.
[[nodiscard]] std::optional<std::uint64_t> laz_tabled_chunks(const InputFile& input, const LasHeader& header);

/// Pieces that begin where LASzip can start without decoding what is before, as the file's chunk table and,
/// for chunks of different sizes, the pages of COPC tell.
class LazPieces {
 public:
  LazPieces(const InputFile& input, const LasHeader& header, std::size_t chunk_rays);

  /// False: only one reader, from the first point to the last, makes sense.
  [[nodiscard]] bool independent() const { return independent_; }

  /// Rows of the piece that starts at row `first`, where an earlier one ended. 0 at the end.
  [[nodiscard]] std::size_t rows_from(std::uint64_t first) const;

 private:
  void divide_fixed(std::uint64_t chunk_rows);
  void divide_variable(const std::vector<std::uint64_t>& chunks);

  std::uint64_t point_count_;
  std::uint64_t piece_rows_;
  std::uint64_t most_rows_;  ///< of one piece
  bool independent_ = false;
  std::uint64_t chunk_rows_ = 0;     ///< where a piece is half a chunk: pieces begin at multiples of this
  std::vector<std::uint64_t> ends_;  ///< of the pieces, where they differ
};

}  // namespace ray
