#pragma once
/// From one streaming call to the next without a file between them.

#include <raycloud/core/error.h>
#include <raycloud/core/ray_stream.h>

#include <memory>

namespace ray {

class PlyEncoder;

/// Both ends of a PLY file that is never there: what one thread writes to `sink` another reads from `source`,
/// with the header and to the bit as if it had come from a file of create_ply by open_ply, single precision
/// included (PrecisionLoss is thrown as there). A few chunks are held in between; who is faster waits.
///
/// Where one end is given up (the sink destroyed before `finish`, or the source destroyed), the other throws
/// Error(cancelled). `source->rewind()` throws CannotRewind once something was fetched.
struct PlyChannel {
  std::unique_ptr<RaySink> sink;
  std::unique_ptr<RaySource> source;
};

/// Throws Error(usage) for columns that a PLY file cannot hold.
[[nodiscard]] PlyChannel make_ply_channel(const CloudInfo& info);

/// What a PLY file makes of rays, without the file: what create_ply would round, change or refuse.
class PlyMirror {
 public:
  /// Throws Error(usage) for columns that a PLY file cannot hold.
  explicit PlyMirror(const CloudInfo& info);
  ~PlyMirror();
  PlyMirror(PlyMirror&&) noexcept;

  /// What open_ply would tell of the file, but for the number of rays.
  [[nodiscard]] const CloudInfo& info() const { return info_; }
  /// Turns `rays` into what would be read back, to the bit. Thread-safe. Throws as the sink of create_ply
  /// does. Returns whether starts and ends would stay as they are if a file of the same or of double
  /// precision were written of them again.
  bool reflect(RayCloud& rays) const;
  /// The same where that is known of starts, ends and times: what such a file does to the rest. Quick.
  void reflect_settled(RayCloud& rays) const;

 private:
  void rename_columns(RayCloud& rays) const;

  std::unique_ptr<const PlyEncoder> encoder_;
  CloudInfo info_;
};

/// The reader wants to read again what is only there once. Put a file in between.
class CannotRewind : public Error {
 public:
  CannotRewind() : Error(ErrorCode::usage, "what comes through a channel can be read only once") {}
};

}  // namespace ray
