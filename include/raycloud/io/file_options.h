#pragma once
/// What every reader and writer of this room takes.

#include <cstddef>
#include <string>

namespace ray {

struct ReadOptions {
  /// Most rays in one chunk, at least 1. Rows too long for a buffer of 64 MiB come in smaller chunks.
  std::size_t chunk_rays = 8192;
  /// The file is about to be replaced, so what has been read of it need not stay in the page cache. Freeing
  /// it on the way is faster than all at once when the last reader closes it.
  bool will_be_replaced = false;
};

struct WriteOptions {
  /// Force the bytes onto the disk before the output replaces what had its name: for commands that overwrite
  /// their input, so that a power cut leaves one of the two.
  bool flush_to_disk = false;
  /// Open the file anew for each write, so that there is no limit to how many are being written at once: for
  /// commands that write thousands. A write costs some microseconds more: make it a large one.
  bool close_between_writes = false;
  /// Where the extension of the file says nothing: the format is that of this one, `.ply`, `.las` or `.laz`.
  std::string format = {};
};

}  // namespace ray
