#include "text_fields.h"
#include "text_file.h"

#include <raycloud/core/error.h>
#include <raycloud/io/atomic_file.h>
#include <raycloud/io/transform_file.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

namespace ray {
namespace {

constexpr std::size_t kLongestFile = std::size_t{1} << 20;  // bytes
constexpr std::size_t kNumbers = 16, kBendNumbers = 9;

void append_list(std::string& text, const Eigen::VectorXd& values) {
  text += '[';
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (i > 0) text += ", ";
    text::append_number(text, values[i]);
  }
  text += ']';
}

/// What follows a name and a colon; of a text that has no names, all where that may be.
std::string_view part_of(std::string_view text, std::string_view name, bool nameless) {
  while (!text.empty()) {
    std::string_view rest = text;
    const std::string_view line = text::trimmed(text::take_line(text));
    if (text::is_blank(line) || text::is_comment(line)) continue;
    if (line.starts_with(name)) return rest.substr(rest.find(name) + name.size());
    if (nameless && line.find(':') == std::string_view::npos) return rest;
  }
  return {};
}

std::vector<double> numbers_of(std::string_view text, std::size_t most, const std::string& name) {
  std::vector<double> numbers;
  while (!text.empty() && numbers.size() < most) {
    std::string line(text::take_line(text));
    line = line.substr(0, line.find('#'));
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == '[' || c == ']' || c == ','; }, ' ');
    for (const std::string_view field : text::all_fields(line, ' ')) {
      if (field == "-" || field.empty()) continue;  // an item of a list
      const auto value = text::number(field);
      if (!value)
        throw Error(ErrorCode::file_format, name + ": " + text::quoted(field) + " is no number of a matrix");
      numbers.push_back(*value);
    }
  }
  return numbers;
}

}  // namespace

Eigen::Vector3d rotation_vector_deg(const Pose& pose) {
  const Eigen::AngleAxisd turn(pose.rotation);
  return turn.angle() * (180.0 / std::numbers::pi) * turn.axis();
}

void write_transform(const std::filesystem::path& path, const Pose& pose, const TransformNotes& notes,
                     const Bend& bend) {
  std::string text = "# p' = matrix * p, in metres\nmatrix:\n";
  for (Eigen::Index row = 0; row < 4; ++row) {
    Eigen::Vector4d values(0.0, 0.0, 0.0, 1.0);
    if (row < 3) values << pose.rotation.row(row).transpose(), pose.translation[row];
    append_list(text += "  - ", values);
    text += '\n';
  }
  append_list(text += "rotation_vector: ", rotation_vector_deg(pose));
  append_list(text += "  # degrees\ntranslation: ", pose.translation);
  text += "  # m\n";
  if (!bend.is_none()) {
    append_list(text += "bend_centre: ", bend.centre);
    text += "  # m\nbend:  # 1/m, of x*x, y*y and x*y from there\n";
    for (Eigen::Index row = 0; row < 3; ++row) {
      append_list(text += "  - ", bend.shifts.row(row).transpose());
      text += '\n';
    }
  }
  for (const auto& [name, value] : notes)
    text += name + ": " + value + "\n";
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

Pose parse_transform(std::string_view text, const std::string& name) {
  constexpr double kRigid = 1e-4;
  const std::vector<double> numbers = numbers_of(part_of(text, "matrix:", true), kNumbers, name);
  if (numbers.size() < kNumbers)
    throw Error(ErrorCode::file_format,
                name + ": no transform: a matrix has 16 numbers, here are " + std::to_string(numbers.size()));
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(numbers.data());
  Pose pose{matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
  const bool is_rigid =
      matrix.allFinite() && (pose.rotation * pose.rotation.transpose()).isIdentity(kRigid) &&
      pose.rotation.determinant() > 0.0 && (matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).isZero(kRigid);
  if (!is_rigid)
    throw Error(ErrorCode::file_format, name + ": the matrix is not a rotation and a translation");
  return pose;
}

Bend parse_bend(std::string_view text, const std::string& name) {
  const std::vector<double> numbers = numbers_of(part_of(text, "bend:", false), kBendNumbers, name),
                            centre = numbers_of(part_of(text, "bend_centre:", false), 2, name);
  if (numbers.empty() && centre.empty()) return {};
  if (numbers.size() < kBendNumbers || centre.size() < 2)
    throw Error(ErrorCode::file_format, name + ": a bend has a centre of 2 numbers and 3 rows of 3");
  Bend bend;
  bend.centre = {centre[0], centre[1]};
  bend.shifts = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers.data());
  if (!bend.centre.allFinite() || !bend.shifts.allFinite())
    throw Error(ErrorCode::file_format, name + ": the numbers of a bend are finite");
  return bend;
}

Pose read_transform(const std::filesystem::path& path) {
  text::TextFile file(path);
  const std::string text = file.read(kLongestFile);
  return parse_transform(text, file.name());
}

Bend read_bend(const std::filesystem::path& path) {
  text::TextFile file(path);
  const std::string text = file.read(kLongestFile);
  return parse_bend(text, file.name());
}

}  // namespace ray
