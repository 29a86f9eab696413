#pragma once
/// What commands are that are no step (step.h): one ray cloud in, one out, through one streaming call of the
/// library.

#include "cli/session.h"

#include <raycloud/core/error.h>
#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/stream.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace ray::tools {

/// `call(source, sink)` streams all rays; it does not finish the sink.
using StreamingCall = std::function<StreamCounts(RaySource&, RaySink&)>;

struct CloudToCloud {
  std::filesystem::path input;
  std::filesystem::path output;
  std::function<void(CloudInfo&)> describe = {};  ///< may change what the header of the output says
};

/// Opens, writes the header (the input's, with this command added to its history), streams, finishes and
/// prints the summary. Where single precision turns out too coarse the cloud is written again in double.
void run_cloud_to_cloud(cli::Session& session, const CloudToCloud& files, const StreamingCall& call);

/// The result of `call`, in whose errors the file is named.
template <class Call>
auto naming(const std::string& file, const Call& call) {
  try {
    return call();
  } catch (const Error& error) {
    const bool named = std::string_view(error.what()).substr(0, file.size()) == file;
    if (named || error.code() == ErrorCode::cancelled || error.code() == ErrorCode::usage) throw;
    throw Error(error.code(), file + ": " + error.what());
  }
}

/// "3 rays with NaN or infinite values left out", if there were any.
void note_dropped(cli::Session& session, std::uint64_t dropped);

}  // namespace ray::tools
