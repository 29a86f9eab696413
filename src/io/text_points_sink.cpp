#include "text_fields.h"

#include <raycloud/core/error.h>
#include <raycloud/io/atomic_file.h>
#include <raycloud/io/text_points.h>

#include <charconv>
#include <cstring>

namespace ray {
namespace {

void append(std::string& text, const Column& column, std::size_t row) {
  visit_scalar(column.type(), [&]<class T>() {
    T value;
    std::memcpy(&value, column.data() + row * sizeof(T), sizeof(T));
    if constexpr (std::is_floating_point_v<T>)
      text::append_number(text, value);
    else
      text += std::to_string(value);
  });
}

class TextSink final : public RaySink {
 public:
  TextSink(const std::filesystem::path& path, const CloudInfo& info, const WriteOptions& options)
      : file_(path, options),
        separator_(path.extension() == ".csv" || path.extension() == ".CSV" ? ',' : ' '),
        single_(info.precision == Precision::single) {
    std::string heading;
    for (const char* name : {"x", "y", "z", "time", "red", "green", "blue", "alpha"})
      (heading += heading.empty() ? "" : std::string(1, separator_)) += name;
    for (const ColumnInfo& extra : info.extras)
      (heading += separator_) += extra.name;
    file_.write(heading + "\n");
  }

  void encode(const RayCloud& rays, RawChunk& raw) const override {
    std::string text;
    text.reserve(rays.size() * (64 + 8 * rays.extras.size()));
    for (std::size_t i = 0; i < rays.size(); ++i)
      append_row(text, rays, i);
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    raw.bytes.assign(bytes, bytes + text.size());
    raw.rows = rays.size();
  }

  void write(const RawChunk& raw) override { file_.write(raw.bytes); }
  void finish() override { file_.commit(); }

 private:
  void append_coordinate(std::string& text, double value) const {
    const float narrow = static_cast<float>(value);
    if (single_ && static_cast<double>(narrow) == value)
      text::append_number(text, narrow);
    else
      text::append_number(text, value);
  }

  void append_row(std::string& text, const RayCloud& rays, std::size_t i) const {
    for (const double coordinate : rays.ends[i]) {
      append_coordinate(text, coordinate);
      text += separator_;
    }
    text::append_number(text, rays.times[i]);
    const Colour& colour = rays.colours[i];
    const int alpha = rays.bounded[i] == 0 ? 0 : std::max<int>(1, colour.intensity);
    for (const int channel : {int{colour.red}, int{colour.green}, int{colour.blue}, alpha})
      (text += separator_) += std::to_string(channel);
    for (const Column& extra : rays.extras)
      append(text += separator_, extra, i);
    text += '\n';
  }

  AtomicFile file_;
  char separator_;
  bool single_;
};

}  // namespace

std::unique_ptr<RaySink> create_text_points(const std::filesystem::path& path, const CloudInfo& info,
                                            const WriteOptions& options) {
  return std::make_unique<TextSink>(path, info, options);
}

}  // namespace ray
