#pragma once
/// Point files of every kind, chosen by the extension in either case: what is imported from and exported to.

#include <raycloud/core/ray_stream.h>
#include <raycloud/io/file_options.h>

#include <filesystem>
#include <memory>

namespace ray {

/// Reads .ply, .las, .laz (.copc.laz too), .xyz, .txt, .csv, .asc and .pts. Where the file knows no sensor
/// position (info().present.starts is false) starts equal ends. Throws Error(usage) for an unknown extension,
/// naming the known ones, and what the format's own function throws.
[[nodiscard]] std::unique_ptr<RaySource> open_points(const std::filesystem::path& path,
                                                     const ReadOptions& options = {});

/// Writes .ply, .las, .laz, .xyz, .txt and .csv: the ends, times, colours and extras, without starts. Atomic
/// as create_ray_cloud. Throws Error(usage) for an unknown extension.
[[nodiscard]] std::unique_ptr<RaySink> create_points(const std::filesystem::path& path, const CloudInfo& info,
                                                     const WriteOptions& options = {});

}  // namespace ray
