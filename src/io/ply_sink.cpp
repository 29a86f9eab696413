#include "ply_encode.h"

#include <raycloud/core/error.h>
#include <raycloud/io/atomic_file.h>
#include <raycloud/io/ply_cloud.h>

#include <string>
#include <string_view>

namespace ray {
namespace {

class PlySink final : public RaySink {
 public:
  PlySink(const std::filesystem::path& path, const CloudInfo& info, const WriteOptions& options, bool rays)
      : encoder_(path.string(), info, rays), file_(path, options) {
    if (!file_.seekable()) {
      throw Error(ErrorCode::file_access, path.string() +
                                              ": a PLY file cannot be written to a pipe, as its "
                                              "count comes last: give the name of a file");
    }
    file_.write(encoder_.header());
  }

  void encode(const RayCloud& rays, RawChunk& raw) const override { encoder_.encode(rays, raw); }
  void encode_rows(const RayCloud& rays, std::span<const std::uint32_t> rows, RawChunk& raw) const override {
    encoder_.encode_rows(rays, rows, raw);
  }

  void write(const RawChunk& raw) override {
    file_.write(raw.bytes);
    rows_ += raw.rows;
  }

  void amend(std::string_view comment, std::string_view by) override {
    const std::string start = "comment ";
    const auto at = encoder_.header().find(start + std::string(comment) + "\n");
    if (at == std::string::npos || by.size() != comment.size()) {
      throw Error(ErrorCode::usage,
                  file_.path().string() + ": no comment of this length to amend: " + std::string(by));
    }
    file_.write_at(at + start.size(), by);
  }

  void finish() override {
    const std::string count = std::to_string(rows_);
    if (count.size() > PlyEncoder::kCountDigits) {
      throw Error(ErrorCode::out_of_range, file_.path().string() + ": more than 10^12 rays");
    }
    file_.write_at(encoder_.count_offset() + PlyEncoder::kCountDigits - count.size(), count);
    file_.commit();
  }

 private:
  PlyEncoder encoder_;
  AtomicFile file_;
  std::uint64_t rows_ = 0;
};

}  // namespace

std::unique_ptr<RaySink> create_ply(const std::filesystem::path& path, const CloudInfo& info,
                                    const WriteOptions& options) {
  return std::make_unique<PlySink>(path, info, options, true);
}

std::unique_ptr<RaySink> create_ply_points(const std::filesystem::path& path, const CloudInfo& info,
                                           const WriteOptions& options) {
  return std::make_unique<PlySink>(path, info, options, false);
}

}  // namespace ray
