#pragma once
/// Tables that do not fit the memory, on disk for a while.

#include <raycloud/exec/spill.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace ray {

/// Rows of a plain struct in several streams of one Spill. First everything is appended, then read. One
/// thread at a time; throws as a Spill does.
template <class Row>
class SpilledRows {
  // Eigen's vectors are not trivially copyable by the letter; their bytes are all there is to them.
  static_assert(std::is_trivially_destructible_v<Row>);

 public:
  /// Holds at most `memory` bytes of all streams, but at least 4 kB of each.
  SpilledRows(std::size_t streams, std::size_t memory)
      : spill_(streams, std::clamp<std::size_t>(memory / std::max<std::size_t>(1, streams),
                                                std::size_t{1} << 12, std::size_t{1} << 18)),
        next_(streams + 1) {}

  [[nodiscard]] std::size_t streams() const { return next_.size() - 1; }
  [[nodiscard]] std::size_t size(std::size_t stream) const { return spill_.size(stream) / sizeof(Row); }

  void append(std::size_t stream, std::span<const Row> rows) {
    spill_.append(stream, rows.data(), rows.size_bytes());
  }
  /// Replaces `rows`, as many as there are, by the next of the stream.
  void read(std::size_t stream, std::span<Row> rows) { spill_.read(stream, rows.data(), rows.size_bytes()); }
  void read_bytes(std::size_t stream, std::span<std::byte> rows) {
    spill_.read(stream, rows.data(), rows.size());
  }
  /// All rows of a stream of which none has been read, or that was rewound.
  [[nodiscard]] std::vector<Row> read_all(std::size_t stream) {
    std::vector<Row> rows(size(stream));
    read(stream, rows);
    return rows;
  }
  void rewind(std::size_t stream) { spill_.rewind(stream); }
  /// All rows of a stream, as often as wanted.
  [[nodiscard]] std::vector<Row> load(std::size_t stream) {
    std::vector<Row> rows = read_all(stream);
    rewind(stream);
    return rows;
  }
  void drop(std::size_t stream) { spill_.drop(stream); }

  /// The next row of each of these streams, one after the other; they may come several times. Valid until the
  /// next call.
  [[nodiscard]] std::span<const Row> take(std::span<const std::uint32_t> streams) {
    std::fill(next_.begin(), next_.end(), 0);
    for (const std::uint32_t stream : streams)
      ++next_[stream + 1];
    by_stream_.resize(streams.size());
    taken_.resize(streams.size());
    for (std::size_t stream = 0; stream + 1 < next_.size(); ++stream) {
      if (next_[stream + 1] > 0)
        read(stream, std::span(by_stream_).subspan(next_[stream], next_[stream + 1]));
      next_[stream + 1] += next_[stream];
    }
    for (std::size_t i = 0; i < streams.size(); ++i)
      taken_[i] = by_stream_[next_[streams[i]]++];
    return taken_;
  }

 private:
  Spill spill_;
  std::vector<std::size_t> next_;
  std::vector<Row> by_stream_, taken_;
};

}  // namespace ray
