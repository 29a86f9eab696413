#pragma once
/// Putting ray clouds together: one after the other, every ray as it was, whatever columns each has. Paper,
/// sections VI-B (`all`) and VIII-D; docs/algorithms/splitting.md for the joining of cut rays.

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/stream.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace ray {

/// Opens one of the clouds; called anew each time it is read, and its name for notes.
struct CloudToCombine {
  std::string name;
  std::function<std::unique_ptr<RaySource>()> open;
};

/// All rays of several clouds, in order. Columns are matched by name; the result has the columns of all of
/// them, filled where a cloud has none: 0 for integers, NaN for real numbers. Where two clouds store a column
/// in different types it gets the smallest type that holds every value of both exactly. Precision is double
/// if that of one of them is. The history is that of the first cloud and the lines of the others that are
/// not in it; a coordinate system or time base on which the clouds disagree is left out.
///
/// A cloud is open from its first chunk until its last one is decoded, so any number of clouds can be
/// combined. Precondition: every chunk that was fetched is decoded once.
class CombinedSource final : public RaySource {
 public:
  /// Opens each cloud once, for its header. Throws what that throws, Error(usage) if there is no cloud, and
  /// Error(wrong_content) if no type holds the values of a column exactly (int64 with float64, say).
  explicit CombinedSource(std::vector<CloudToCombine> clouds);
  ~CombinedSource() override;

  [[nodiscard]] const CloudInfo& info() const override { return info_; }
  /// What was filled, converted or left out, a line each for the user.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  /// Those on which the clouds contradict each other.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
  [[nodiscard]] bool fetch(RawChunk& raw) override;
  std::size_t decode(const RawChunk& raw, RayCloud& rays) const override;
  void rewind() override;

  [[nodiscard]] std::size_t cloud_count() const { return members_.size(); }
  /// The rays of one cloud, with the columns of all and its own precision. It is open while it is read, from
  /// the first fetch to the next rewind. This must outlive it.
  [[nodiscard]] std::unique_ptr<RaySource> alone(std::size_t cloud) const;

 private:
  /// One of the clouds.
  struct Member;
  class Alone;

  void open_current();
  void close_finished();
  void unite_columns(const Member& member, RayCloud& rays) const;

  std::vector<std::unique_ptr<Member>> members_;
  CloudInfo info_;
  std::vector<std::string> notes_;
  std::vector<std::string> warnings_;
  std::size_t current_ = 0;
  std::size_t first_open_ = 0;
};

/// How pieces of cut rays belong together: what join_pieces finds out in its first pass.
class JoinPlan;

struct JoinCounts {
  StreamCounts stream;
  std::uint64_t joined = 0;  ///< rays made of two or more pieces
  std::uint64_t left = 0;    ///< pieces whose neighbour is missing
};

/// Reads all pieces that the column `clipped` marks and finds which follow each other: same time, the one
/// ends where the other starts to within 2 mm, and together they are straight to within that. Those that fit
/// best belong together, of equal ones the first. Memory: 200 bytes a piece. Reads `source`
/// to its end; rewind it before join_pieces. Throws Error(no_data) if there is no column `clipped`.
[[nodiscard]] std::shared_ptr<const JoinPlan> plan_join(const Context& context, RaySource& source);

/// The columns of the result: those of the source without `clipped`, or with it if some pieces stay pieces.
[[nodiscard]] std::vector<ColumnInfo> join_columns(const JoinPlan& plan, std::vector<ColumnInfo> source);

/// Streams every ray, with the pieces of each as one ray where the piece with its end was: end and columns
/// are those of that piece bit for bit, the start is that of the first piece. The second pass, on the same
/// source. Does not finish the sink. The result does not depend on threads or chunks.
JoinCounts join_pieces(const Context& context, RaySource& source, RaySink& sink, const JoinPlan& plan);

}  // namespace ray
