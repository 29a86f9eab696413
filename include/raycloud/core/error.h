#pragma once
/// What the library throws: one type, a code that decides the exit status, and one line for the user.

#include <stdexcept>
#include <string>

namespace ray {

/// Why an operation could not be done. `usage` is a wrong request (exit 2), `cancelled` is Ctrl-C (exit 130),
/// every other code is a failure at run time (exit 1).
enum class ErrorCode {
  file_not_found,
  file_access,    ///< permission, a folder that cannot be written, a full disk
  file_format,    ///< not the format it claims, cut short, damaged
  wrong_content,  ///< a readable file of the wrong kind (a mesh given as a ray cloud)
  out_of_range,   ///< a value that the output cannot hold
  no_data,        ///< nothing to work on
  usage,
  cancelled,
};

/// The only exception the library throws on purpose. `what()` is one line without a final newline that names
/// the path and record where there is one ("scan.ply: truncated at ray 10412 of 34579 (byte 375004)") and
/// what to do where that helps.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

/// Thrown by a sink that was asked to keep single precision when a coordinate would lose more than the
/// tolerance. Whoever drives the stream starts again with Precision::double_ (see `core/cloud_info.h`).
class PrecisionLoss : public Error {
 public:
  explicit PrecisionLoss(const std::string& message) : Error(ErrorCode::out_of_range, message) {}
};

}  // namespace ray
