#pragma once
/// Real scans, which are measured with where their folder is: RAYCLOUD_TEST_DATA, or shared/data above.

#include <string>

namespace bench {

/// The file NAME.ply or NAME.ply.xz of that folder, or nothing.
[[nodiscard]] std::string real_file(const std::string& name);

/// The command that writes such a file to standard output, unpacked.
[[nodiscard]] std::string printing(const std::string& file);

}  // namespace bench
