#pragma once
/// Ray cloud files of every kind, chosen by the extension in either case: .ply, .las, .laz. A file with
/// another extension is read as what its first bytes say that it is.

#include <raycloud/core/ray_stream.h>
#include <raycloud/io/file_options.h>

#include <filesystem>
#include <memory>
#include <string>

namespace ray {

/// The format of a file, as its extension: of its name, or else what its first bytes say. Empty if neither
/// tells.
[[nodiscard]] std::string cloud_format(const std::filesystem::path& path);

/// Throws what the format's own function throws (io/ply_cloud.h, io/las_cloud.h): Error(wrong_content) where
/// the file holds no rays; so too where cloud_format is empty.
[[nodiscard]] std::unique_ptr<RaySource> open_ray_cloud(const std::filesystem::path& path,
                                                        const ReadOptions& options = {});

/// The file appears, complete, when `finish` returns; until then one of that name stays as it was. The result
/// is the same for every chunking of the rays. Throws Error(usage) for an unknown extension
/// without WriteOptions::format, naming the known ones, and Error(file_access).
[[nodiscard]] std::unique_ptr<RaySink> create_ray_cloud(const std::filesystem::path& path,
                                                        const CloudInfo& info,
                                                        const WriteOptions& options = {});

}  // namespace ray
