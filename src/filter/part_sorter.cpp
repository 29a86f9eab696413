#include "part_sorter.h"

namespace ray {

std::uint32_t PartSorter::part(const PartKey& key) {
  // Neighbours in the file are mostly neighbours in space.
  if (!keys_.empty() && keys_[latest_] == key) return latest_;
  const auto [found, fresh] = numbers_.try_emplace(key, static_cast<std::uint32_t>(keys_.size()));
  if (fresh) keys_.push_back(key);
  return latest_ = found->second;
}

void PartSorter::gather(const RayCloud& rays, bool marked, PartitionedChunk& out) const {
  std::vector<std::size_t> ends(keys_.size() + 1, 0);
  for (const Piece& piece : pieces_)
    ++ends[piece.part + 1];
  for (std::size_t part = 0; part < keys_.size(); ++part)
    ends[part + 1] += ends[part];
  std::vector<const Piece*> order(pieces_.size());
  for (const Piece& piece : pieces_)
    order[ends[piece.part]++] = &piece;  // what was the begin of a part becomes its end
  RayPieces sorted;
  for (const Piece* piece : order) {
    piece->flags == 0 ? sorted.add(piece->row)
                      : sorted.add(piece->row, piece->start, piece->end, piece->flags);
  }
  sorted.gather(rays, marked, out.rays);
  out.parts.clear();
  for (std::size_t part = 0, begin = 0; part < keys_.size(); begin = ends[part++]) {
    if (ends[part] > begin) out.parts.push_back({keys_[part], ends[part]});
  }
}

}  // namespace ray
