#include "las_crs.h"

#include "input_file.h"
#include "las_bytes.h"

#include <charconv>

namespace ray {
namespace {

constexpr std::uint16_t kModelType = 1024;
constexpr std::uint16_t kRasterType = 1025;
constexpr std::uint16_t kGeographicType = 2048;
constexpr std::uint16_t kProjectedType = 3072;
constexpr std::uint16_t kUserDefined = 32767;

}  // namespace

std::string one_line_wkt(std::span<const std::byte> record) {
  std::string text(reinterpret_cast<const char*>(record.data()), record.size());
  text.resize(std::min(text.size(), text.find('\0')));
  for (char& letter : text)
    letter = letter == '\n' || letter == '\r' || letter == '\t' ? ' ' : letter;
  text.erase(text.find_last_not_of(' ') + 1);
  return is_wkt(text) ? text : "";
}

std::string epsg_of_geokeys(std::span<const std::byte> record) {
  int geographic = 0;
  int projected = 0;
  for (std::size_t at = 8; at + 8 <= record.size(); at += 8) {
    const auto key = load<std::uint16_t>(record.data() + at);
    const auto location = load<std::uint16_t>(record.data() + at + 2);
    const auto value = load<std::uint16_t>(record.data() + at + 6);
    if (location != 0 || value == 0 || value >= kUserDefined) continue;
    if (key == kGeographicType) geographic = value;
    if (key == kProjectedType) projected = value;
  }
  const int code = projected != 0 ? projected : geographic;
  return code == 0 ? "" : "EPSG:" + std::to_string(code);
}

std::vector<std::byte> geokeys_of_epsg(std::string_view crs) {
  if (!crs.starts_with("EPSG:")) return {};
  crs.remove_prefix(5);
  std::uint16_t code = 0;
  const auto [end, error] = std::from_chars(crs.data(), crs.data() + crs.size(), code);
  if (error != std::errc() || end != crs.data() + crs.size() || code == 0 || code >= kUserDefined) return {};
  const bool geographic = code / 1000 == 4;
  const std::array<std::uint16_t, 16> keys{1,
                                           1,
                                           0,
                                           3,
                                           kModelType,
                                           0,
                                           1,
                                           static_cast<std::uint16_t>(geographic ? 2 : 1),
                                           kRasterType,
                                           0,
                                           1,
                                           1,
                                           geographic ? kGeographicType : kProjectedType,
                                           0,
                                           1,
                                           code};
  std::vector<std::byte> record(sizeof keys);
  std::memcpy(record.data(), keys.data(), sizeof keys);
  return record;
}

bool is_wkt(std::string_view crs) {
  return crs.find('[') != crs.npos &&
         crs.substr(0, crs.find('[')).find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_") == crs.npos;
}

}  // namespace ray
