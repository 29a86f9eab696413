// What is no ray cloud is refused in one line that says why.
#include "ply_fixture.h"
#include "support/random_cloud.h"
#include "support/scratch.h"
#include "support/shared_data.h"

#include <raycloud/io/ply_cloud.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>

namespace ray {
namespace {

using namespace test;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kRays =
    "property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\n";

std::string with_header(const std::string& format, const std::string& count, const std::string& data,
                        const std::string& properties = kRays) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + count + "\n" + properties + "end_header\n" +
         data;
}

class PlyBadInput : public ::testing::Test {
 protected:
  /// The message without the path, after checking that it is one line that begins with the path.
  std::string message(const std::string& bytes, ErrorCode code = ErrorCode::file_format) {
    const auto path = scratch_.path("bad.ply");
    write_file(path, bytes);
    const auto error = error_of([&] { read_rest(*open_ply(path)); });
    if (!error) return "no error";
    const std::string what = error->what();
    EXPECT_EQ(error->code(), code) << what;
    EXPECT_THAT(what, StartsWith(path.string() + ": "));
    EXPECT_EQ(what.find('\n'), what.npos);
    return what.substr(path.string().size() + 2);
  }
  Scratch scratch_;
};

TEST_F(PlyBadInput, Headers) {
  EXPECT_EQ(message(""), "empty file");
  EXPECT_EQ(message("LASF and so on\n"), "not a PLY file");
  EXPECT_EQ(message(std::string(100000, '\0')), "not a PLY file");
  EXPECT_EQ(message("plywood\nformat ascii 1.0\n"), "not a PLY file");
  EXPECT_EQ(message("pl"), "not a PLY file");
  EXPECT_EQ(message("ply"), "cut short: its PLY header has no end_header");
  EXPECT_EQ(message("ply\n"), "cut short: its PLY header has no end_header");
  EXPECT_EQ(message("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"),
            "cut short: its PLY header has no end_header");
  EXPECT_EQ(message("ply\nformat ascii 1.0\n\x01\x02\xff\n"), "PLY header, line 3: unknown word '\?\?\?'");
  EXPECT_EQ(message("ply\nelement vertex 0\nproperty float x\nend_header\n"),
            "PLY header, line 4: no format");
  EXPECT_THAT(message("ply\nformat binary 1.0\n"), HasSubstr("unknown format 'binary'"));
  EXPECT_THAT(message("ply\nformat ascii 2.0\n"), HasSubstr("format version '2.0' instead of 1.0"));
  EXPECT_THAT(message("ply\nformat ascii 1.0\nproperty float x\n"),
              HasSubstr("a property before any element"));
  EXPECT_THAT(message(with_header("ascii", "-1", "")), HasSubstr("a name and a count, not '-1'"));
  EXPECT_THAT(message(with_header("ascii", "99999999999999999999", "")), HasSubstr("a name and a count"));
  EXPECT_THAT(message(with_header("ascii", "0", "", kRays + "property float x\n")),
              HasSubstr("a second property 'x'"));
  EXPECT_THAT(message(with_header("ascii", "0", "", "property half x\n")), HasSubstr("unknown type 'half'"));
  EXPECT_THAT(message(with_header("ascii", "0", "", "property list float int x\n")),
              HasSubstr("length of a list"));
  EXPECT_THAT(message(with_header("ascii", "0", "", "")), HasSubstr("'vertex' has no properties"));
  EXPECT_THAT(message("ply\nformat ascii 1.0\nelement face 0\nend_header\n"),
              HasSubstr("no element 'vertex'"));
  EXPECT_THAT(message("ply\nformat ascii 1.0\ncomment raycloud version 2\n" +
                      with_header("ascii", "0", "").substr(21)),
              HasSubstr("a later release"));
  EXPECT_THAT(
      message("ply\nformat ascii 1.0\ncomment origin 1 2\n" + with_header("ascii", "0", "").substr(21)),
      HasSubstr("comment origin needs three numbers"));
}

TEST_F(PlyBadInput, AHeaderWithoutEndIsNotReadForever) {
  std::string text = "ply\nformat ascii 1.0\n";
  while (text.size() < (std::size_t{17} << 20))
    text += "comment " + std::string(1000, 'c') + "\n";
  EXPECT_EQ(message(text), "PLY header of over 16 MiB");
}

TEST_F(PlyBadInput, SizesThatCannotBe) {
  const std::string le = "binary_little_endian";
  EXPECT_THAT(message(with_header(le, "1000000000000000000", "")),
              HasSubstr("truncated at ray 1 of 1000000000000000000"));
  EXPECT_THAT(message(with_header(le, "18446744073709551615", "")), HasSubstr("truncated at ray 1"));
  EXPECT_THAT(message(with_header("ascii", "1000000000000000000", "1 2 3 4 5 6\n")),
              HasSubstr("truncated: "));
  EXPECT_THAT(message(with_header(le, "1000000000000000000", "", "property list uchar int l\n" + kRays)),
              HasSubstr("truncated: "));
  EXPECT_THAT(
      message("ply\nformat binary_little_endian 1.0\nelement e 18446744073709551615\nproperty double a\n" +
              with_header(le, "1", "").substr(36)),
      HasSubstr("truncated within its 18446744073709551615 rows of 'e'"));
}

TEST_F(PlyBadInput, CutAndOverlongFiles) {
  const std::string header = with_header("binary_little_endian", "3", "");
  const auto bytes = [&](std::size_t data) { return header + std::string(data, 'A'); };
  const auto at = [&](std::size_t data) { return " (byte " + std::to_string(header.size() + data) + ")"; };
  EXPECT_EQ(message(bytes(0)), "truncated at ray 1 of 3" + at(0));
  EXPECT_EQ(message(bytes(30)), "truncated at ray 2 of 3" + at(30));
  EXPECT_EQ(message(bytes(71)), "truncated at ray 3 of 3" + at(71));
  EXPECT_EQ(message(bytes(72)), "no error");
  EXPECT_THAT(message(bytes(73)), StartsWith("holds 1 byte more than its header says (3 rays)"));
  EXPECT_THAT(message(bytes(96)), StartsWith("holds 24 bytes more than its header says (3 rays)"));
  const std::string row = "1.25 2.25 3.25 4.25 5.25 6.25\n";
  EXPECT_THAT(message(with_header("ascii", "3", row + row)), StartsWith("truncated at ray 3 of 3 (byte "));
  EXPECT_THAT(message(with_header("ascii", "1", row + "\n" + row)),
              StartsWith("holds lines more than its header says"));
  EXPECT_EQ(message(with_header("ascii", "1", row + "\n \n")), "no error");
}

TEST_F(PlyBadInput, RowsOfText) {
  EXPECT_EQ(message(with_header("ascii", "2", "1 2 3 4 5 6\n1 2 3 4 five 6\n")),
            "ray 2 of 2: 'five' is not a value for ny (float32)");
  EXPECT_EQ(message(with_header("ascii", "1", "1 2 3 4 5           \n")), "ray 1 of 1: no value for nz");
  EXPECT_EQ(message(with_header("ascii", "1", "1 2 3 4 5 6 7\n")),
            "ray 1 of 1: more values than the header has properties");
  const std::string label = kRays + "property uchar label\n";
  for (const std::string value : {"256", "-1", "1.5", "1e30", "nan", "++1", "0x1", "1,"}) {
    EXPECT_EQ(message(with_header("ascii", "1", "1 2 3 4 5 6 " + value + "\n", label)),
              "ray 1 of 1: '" + value + "' is not a value for label (uint8)");
  }
  const std::string list = kRays + "property list uchar int l\n";
  EXPECT_EQ(message(with_header("ascii", "1", "1 2 3 4 5 6 9999999999 1 2\n", list)),
            "ray 1 of 1: no value for l");
}

TEST_F(PlyBadInput, NegativeListLength) {
  const std::string list = "property list char int l\n" + kRays;
  EXPECT_THAT(message(with_header("binary_little_endian", "1", "\xff" + std::string(60, 'A'), list)),
              StartsWith("truncated at ray 1 of 1"));
}

TEST_F(PlyBadInput, OtherKindsOfContent) {
  const std::string points = "property float x\nproperty float y\nproperty float z\n";
  EXPECT_EQ(message(with_header("ascii", "1", "1 2 3\n", points), ErrorCode::wrong_content),
            "a point cloud, not a ray cloud: make one with rayimport");
  EXPECT_EQ(
      message(
          "ply\nformat ascii 1.0\nelement vertex 1\n" + points +
              "element face 2\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n3 0 0 0\n3 0 0 0\n",
          ErrorCode::wrong_content),
      "a mesh (2 faces), not a ray cloud");
  EXPECT_EQ(
      message(
          "ply\nformat ascii 1.0\nelement vertex 1\n" + kRays +
              "element face 1\nproperty list uchar int vertex_indices\nend_header\n1 2 3 0 0 1\n3 0 0 0\n",
          ErrorCode::wrong_content),
      "a mesh (1 faces), not a ray cloud");
  std::string rows;
  for (int i = 0; i < 50; ++i)
    rows += "1 2 3 0 -0.6 0.8\n";
  EXPECT_EQ(message(with_header("ascii", "50", rows), ErrorCode::wrong_content),
            "a point cloud with surface normals (nx ny nz all have length 1), not a ray cloud: "
            "make one with rayimport");
  EXPECT_EQ(message(with_header("ascii", "51", rows + "1 2 3 0 0 2\n")), "no error");
  EXPECT_EQ(message("ply\ncomment raycloud version 1\n" + with_header("ascii", "50", rows).substr(4)),
            "no error");
  EXPECT_EQ(message(with_header("ascii", "1", "1\n", "property float a\n"), ErrorCode::wrong_content),
            "its vertices have no x, y and z");
}

TEST_F(PlyBadInput, FilesThatCannotBeOpened) {
  const auto error_for = [&](const std::filesystem::path& path) {
    const auto error = error_of([&] { static_cast<void>(open_ply(path)); });
    return error ? error->what() : std::string("no error");
  };
  const auto missing = scratch_.path("missing.ply");
  EXPECT_EQ(error_for(missing), missing.string() + ": no such file");
  EXPECT_EQ(error_for(scratch_.folder()), scratch_.folder().string() + ": a folder, not a file");
  const auto pipe = scratch_.path("pipe.ply");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(error_for(pipe), HasSubstr("a pipe or a device"));
  if (geteuid() == 0) return;  // whom no permission stops
  write_file(scratch_.path("secret.ply"), "ply\n");
  std::filesystem::permissions(scratch_.path("secret.ply"), std::filesystem::perms::none);
  EXPECT_THAT(error_for(scratch_.path("secret.ply")), EndsWith("cannot read: Permission denied"));
}

TEST(PlyCorpus, EveryFileOfTheFieldGivesRaysOrAnError) {
  const auto corpus = shared_files("corpus_ply");
  if (corpus.empty()) GTEST_SKIP() << kNoSharedFiles;
  std::size_t readable = 0, files = 0;
  for (const auto& file : corpus) {
    for (const auto open : {open_ply, open_ply_points}) {
      ++files;
      const auto error = error_of([&] {
        const auto source = open(file, {.chunk_rays = 7});
        const auto result = read_rest(*source);
        EXPECT_EQ(result.rays.size() + result.dropped, source->info().ray_count) << file;
        ++readable;
      });
      if (error) {
        const std::string what = error->what();
        EXPECT_THAT(what, StartsWith(file.string() + ": "));
        EXPECT_LT(what.size(), file.string().size() + 200) << what;
      }
    }
  }
  EXPECT_GT(readable, 30u) << "of " << files;
}

}  // namespace
}  // namespace ray
