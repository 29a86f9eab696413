#include "ply_decode.h"
#include "ply_encode.h"
#include "ply_header.h"
#include "ply_schema.h"

#include <raycloud/io/ply_channel.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <utility>

namespace ray {
namespace {

constexpr std::size_t kChunksHeld = 4;
constexpr const char* kName = "between two steps";

[[noreturn]] void fail_given_up() {
  throw Error(ErrorCode::cancelled, "the other end of the channel was given up");
}

class ChunkQueue {
 public:
  void push(RawChunk chunk) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return chunks_.size() < kChunksHeld || reader_gone_; });
    if (reader_gone_) fail_given_up();
    chunks_.push_back(std::move(chunk));
    changed_.notify_all();
  }

  /// False at the end. Gives the emptied buffers of `chunk` back to the writer.
  bool pop(RawChunk& chunk) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !chunks_.empty() || complete_ || writer_gone_; });
    if (chunks_.empty() && !complete_) fail_given_up();
    if (chunks_.empty()) return false;
    std::swap(chunk, chunks_.front());
    if (spare_.size() < kChunksHeld) spare_.push_back(std::move(chunks_.front()));
    chunks_.pop_front();
    changed_.notify_all();
    return true;
  }

  RawChunk spare() {
    const std::lock_guard lock(mutex_);
    if (spare_.empty()) return {};
    RawChunk chunk = std::move(spare_.back());
    spare_.pop_back();
    return chunk;
  }

  void complete() { set(complete_); }
  void leave_as_writer() { set(writer_gone_); }
  void leave_as_reader() { set(reader_gone_); }

 private:
  void set(bool& flag) {
    const std::lock_guard lock(mutex_);
    flag = true;
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<RawChunk> chunks_;
  std::vector<RawChunk> spare_;
  bool complete_ = false;
  bool writer_gone_ = false;
  bool reader_gone_ = false;
};

PlyHeader header_of(const PlyEncoder& encoder) {
  return parse_ply_header(encoder.header(), kName).value();
}

class ChannelSink final : public RaySink {
 public:
  ChannelSink(std::shared_ptr<const PlyEncoder> encoder, std::shared_ptr<ChunkQueue> queue)
      : encoder_(std::move(encoder)), queue_(std::move(queue)) {}
  ~ChannelSink() override { queue_->leave_as_writer(); }

  void encode(const RayCloud& rays, RawChunk& raw) const override { encoder_->encode(rays, raw); }
  void encode_rows(const RayCloud& rays, std::span<const std::uint32_t> rows, RawChunk& raw) const override {
    encoder_->encode_rows(rays, rows, raw);
  }

  void write(const RawChunk& raw) override {
    RawChunk copy = queue_->spare();
    copy.bytes.assign(raw.bytes.begin(), raw.bytes.end());
    copy.rows = raw.rows;
    copy.first_row = row_;
    row_ += raw.rows;
    queue_->push(std::move(copy));
  }

  void finish() override { queue_->complete(); }

 private:
  std::shared_ptr<const PlyEncoder> encoder_;
  std::shared_ptr<ChunkQueue> queue_;
  std::uint64_t row_ = 0;
};

class ChannelSource final : public RaySource {
 public:
  ChannelSource(CloudInfo info, PlyDecoder decoder, std::shared_ptr<ChunkQueue> queue)
      : info_(std::move(info)), decoder_(std::move(decoder)), queue_(std::move(queue)) {}
  ~ChannelSource() override { queue_->leave_as_reader(); }

  const CloudInfo& info() const override { return info_; }
  bool fetch(RawChunk& raw) override {
    begun_ = true;
    return queue_->pop(raw);
  }
  std::size_t decode(const RawChunk& raw, RayCloud& rays) const override {
    return decoder_.decode(raw.bytes, rays);
  }
  void rewind() override {
    if (begun_) throw CannotRewind();
  }

 private:
  CloudInfo info_;
  PlyDecoder decoder_;
  std::shared_ptr<ChunkQueue> queue_;
  bool begun_ = false;
};

}  // namespace

PlyMirror::PlyMirror(const CloudInfo& info) : encoder_(std::make_unique<PlyEncoder>(kName, info, true)) {
  const PlyHeader header = header_of(*encoder_);
  const PlySchema schema = schema_of(layout_of(header), PlyContent::rays, PlyNormals::rays, kName);
  info_ = described(notes_of(header, kName), schema);
}

PlyMirror::~PlyMirror() = default;
PlyMirror::PlyMirror(PlyMirror&&) noexcept = default;

bool PlyMirror::reflect(RayCloud& rays) const {
  const bool settled = encoder_->reflect(rays);
  rename_columns(rays);
  return settled;
}

void PlyMirror::reflect_settled(RayCloud& rays) const {
  encoder_->reflect_settled(rays);
  rename_columns(rays);
}

void PlyMirror::rename_columns(RayCloud& rays) const {
  for (std::size_t i = 0; i < rays.extras.size(); ++i) {
    if (rays.extras[i].info() == info_.extras[i]) continue;
    Column renamed(info_.extras[i], rays.size());
    std::copy_n(rays.extras[i].data(), rays.size() * renamed.stride(), renamed.data());
    rays.extras[i] = std::move(renamed);
  }
}

PlyChannel make_ply_channel(const CloudInfo& info) {
  const auto encoder = std::make_shared<const PlyEncoder>(kName, info, true);
  const PlyHeader header = header_of(*encoder);
  const PlyLayout layout = layout_of(header);
  const PlySchema schema = schema_of(layout, PlyContent::rays, PlyNormals::rays, kName);
  const PlyNotes notes = notes_of(header, kName);
  const auto queue = std::make_shared<ChunkQueue>();
  // Colours are stored in 8 bits, so there is nothing to scale.
  PlyDecoder decoder(schema, layout, notes.origin, PlyColourScale{});
  return {std::make_unique<ChannelSink>(encoder, queue),
          std::make_unique<ChannelSource>(described(notes, schema), std::move(decoder), queue)};
}

}  // namespace ray
