#include "laz_pieces.h"

#include "laz_reader.h"

#include <algorithm>
#include <set>

namespace ray {
namespace {

constexpr std::uint64_t kMostRows = 65536;
constexpr std::uint64_t kMostPieceBytes = 64 << 20;  ///< of the records of a piece

struct CopcNode {
  std::uint64_t at;
  std::uint64_t points;
};

/// The points of each chunk in file order, as the pages of the octree list them; empty if they make no sense.
std::vector<std::uint64_t> copc_chunks(const InputFile& input, const LasHeader& header) {
  std::vector<CopcNode> nodes;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> pages{{header.copc_pages_at, header.copc_pages_size}};
  std::set<std::uint64_t> seen;
  for (std::size_t next = 0; next < pages.size(); ++next) {
    const auto [at, size] = pages[next];
    if (at > input.size() || size > input.size() - at || !seen.insert(at).second) return {};
    std::vector<std::byte> page(size);
    page.resize(input.read_at(at, page));
    for (std::size_t entry = 0; entry + 32 <= page.size(); entry += 32) {
      const auto node_at = load<std::uint64_t>(page.data() + entry + 16);
      const auto bytes = load<std::int32_t>(page.data() + entry + 24);
      const auto points = load<std::int32_t>(page.data() + entry + 28);
      if (points == -1 && bytes > 0) pages.emplace_back(node_at, static_cast<std::uint64_t>(bytes));
      if (points > 0) nodes.push_back({node_at, static_cast<std::uint64_t>(points)});
    }
  }
  std::sort(nodes.begin(), nodes.end(), [](const CopcNode& a, const CopcNode& b) { return a.at < b.at; });
  std::vector<std::uint64_t> chunks;
  std::uint64_t total = 0;
  for (const CopcNode& node : nodes) {
    chunks.push_back(node.points);
    total += node.points;
  }
  if (total != header.point_count) chunks.clear();
  return chunks;
}

}  // namespace

std::optional<std::uint64_t> laz_tabled_chunks(const InputFile& input, const LasHeader& header) {
  if (header.chunk_table_lost) return std::nullopt;
  std::array<std::byte, 8> bytes;
  if (input.size() < header.points_at + 16 || input.read_at(header.points_at, bytes) < 8) return std::nullopt;
  auto at = load<std::int64_t>(bytes.data());
  if (at == -1) {
    input.read_at(input.size() - 8, bytes);
    at = load<std::int64_t>(bytes.data());
  }
  if (at < static_cast<std::int64_t>(header.points_at + 8) ||
      at > static_cast<std::int64_t>(input.size() - 8))
    return std::nullopt;
  input.read_at(static_cast<std::uint64_t>(at), bytes);
  const auto count = load<std::uint32_t>(bytes.data() + 4);
  // Every chunk starts with a whole point. LASzip would believe any number, and take memory for it.
  if (count > input.size() / las_format_length(0)) return std::nullopt;
  return count;
}

LazPieces::LazPieces(const InputFile& input, const LasHeader& header, std::size_t chunk_rays)
    : point_count_(header.point_count) {
  const std::uint64_t fitting = kMostPieceBytes / header.record_length;
  piece_rows_ = std::clamp<std::uint64_t>(chunk_rays, 1, fitting);
  most_rows_ = std::max(piece_rows_, std::min(kMostRows, fitting));
  const auto chunks = laz_tabled_chunks(input, header);
  const std::uint64_t chunk_rows = laz_chunk_rows(header);
  if (!chunks || chunk_rows == 0) return;
  if (chunk_rows == kVariableChunk) {
    const std::vector<std::uint64_t> sizes = copc_chunks(input, header);
    if (sizes.size() == *chunks) divide_variable(sizes);
  } else if ((point_count_ + chunk_rows - 1) / chunk_rows == *chunks) {
    divide_fixed(chunk_rows);
  }
}

void LazPieces::divide_fixed(std::uint64_t chunk_rows) {
  // Half of a large chunk costs its reader the decoding of the other half.
  if (chunk_rows > 2 * most_rows_) return;
  independent_ = true;
  chunk_rows_ = chunk_rows;
  piece_rows_ =
      chunk_rows <= piece_rows_ ? piece_rows_ / chunk_rows * chunk_rows : std::min(chunk_rows, most_rows_);
}

void LazPieces::divide_variable(const std::vector<std::uint64_t>& chunks) {
  independent_ = true;
  std::uint64_t start = 0;
  std::uint64_t end = 0;
  for (const std::uint64_t rows : chunks) {
    if (end > start && end + rows - start > piece_rows_) {
      ends_.push_back(end);
      start = end;
    }
    end += rows;
    for (; end - start > most_rows_; start += most_rows_)
      ends_.push_back(start + most_rows_);
  }
  if (end > start) ends_.push_back(end);
}

std::size_t LazPieces::rows_from(std::uint64_t first) const {
  if (first >= point_count_) return 0;
  if (!ends_.empty())
    return static_cast<std::size_t>(*std::upper_bound(ends_.begin(), ends_.end(), first) - first);
  std::uint64_t rows = piece_rows_;
  // The second part of a chunk ends with it.
  if (chunk_rows_ > piece_rows_) rows = std::min(rows, chunk_rows_ - first % chunk_rows_);
  return static_cast<std::size_t>(std::min(rows, point_count_ - first));
}

}  // namespace ray
