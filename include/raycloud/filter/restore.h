#pragma once
/// The way back from a decimated cloud that was edited to the full one (paper, section VII-A).

#include <raycloud/core/pose.h>
#include <raycloud/core/units.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/stream.h>

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

namespace ray {

/// Rays 0, n, 2n … were kept.
struct EveryNth {
  std::uint64_t n = 1;
};

/// How the full cloud was thinned: decimate_voxels with that width, or decimate_every.
using Decimation = std::variant<Metres, EveryNth>;

struct RestoreOptions {
  bool nonrigid = false;  ///< rays that were moved in different ways carry their surroundings along
};

/// What was done to the decimated cloud. Rays, of the decimated cloud.
struct EditSummary {
  std::uint64_t kept = 0;        ///< found again
  std::uint64_t removed = 0;     ///< not found any more
  std::uint64_t added = 0;       ///< that the full cloud does not have
  std::uint64_t moved = 0;       ///< of the kept ones
  std::uint64_t recoloured = 0;  ///< colour or intensity
  std::uint64_t rebounded = 0;   ///< bounded to unbounded or the other way
  std::uint64_t revalued = 0;    ///< with another value in an extra column
  Pose pose;                     ///< of the moved rays
  Metres worst;                  ///< largest distance of a moved end or start from where `pose` puts it
  bool nonrigid = false;         ///< `pose` does not explain the moves
};

/// Finds the edits of a decimated cloud by thinning the full one again and pairing the rays, and does to
/// every ray of the full cloud what was done to the ray that stood for it: the kept ray of its cube or run.
/// With no edits the full cloud comes out bit for bit.
///
/// Removed: its whole cube goes. Added: appended as it is. Moved: all pairs give one rigid motion by least
/// squares (Kabsch 1976), for all rays or, where some stayed exactly, for those that moved. Recoloured: red,
/// green and blue, and intensity apart from them, are copied where they changed; so are boundedness and the
/// values of every extra column. New columns come along. Rays are paired by time, and among rays of one time
/// by what else they have in common: everything, or place, or place after the motion, or order.
///
/// Streaming in the full cloud, which is read twice. Memory: about 200 bytes and three times the extra
/// columns for each ray of the decimated cloud (whole, before its edits), besides the chunks. The result
/// depends on neither threads nor chunks.
class Restoration {
 public:
  /// Reads both from where they stand to their ends. Throws Error(usage) for a width or n that decimation
  /// refuses, and Error(wrong_content) where
  ///   no ray of the decimated cloud is one of the full cloud (another cloud, or shifted times),
  ///   rays of the same time cannot be told apart after a move,
  ///   the moves are no rigid motion to 1 cm, or are but noise of less than 1 cm, as smoothing makes, and
  ///   options.nonrigid is not set,
  ///   a column has different types in the two clouds.
  Restoration(const Context& context, RaySource& decimated, RaySource& full, const Decimation& decimation,
              const RestoreOptions& options = {});
  ~Restoration();
  Restoration(const Restoration&) = delete;
  Restoration& operator=(const Restoration&) = delete;

  [[nodiscard]] const EditSummary& edits() const;
  /// The extra columns of the result: those of the full cloud, and then the decimated cloud's new ones.
  [[nodiscard]] const std::vector<ColumnInfo>& extras() const;

  /// Streams the full cloud, which must be the same as before and is rewound first, with the edits. Leaves
  /// `sink->finish()` to the caller.
  StreamCounts apply(const Context& context, RaySource& full, RaySink& sink) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ray
