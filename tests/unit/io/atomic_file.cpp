#include "ply_fixture.h"
#include "support/scratch.h"

#include <raycloud/core/error.h>
#include <raycloud/io/atomic_file.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>

namespace ray {
namespace {

using namespace test;
namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class AtomicFileTest : public ::testing::Test {
 protected:
  /// What writing to `target` ends with, after its path.
  std::string failure(const fs::path& target) {
    const auto error = error_of([&] {
      AtomicFile file(target);
      file.write("some text");
      file.commit();
    });
    if (!error) return "no error";
    EXPECT_EQ(error->code(), ErrorCode::file_access);
    EXPECT_THAT(error->what(), StartsWith(target.string() + ": cannot write: "));
    return std::string(error->what()).substr(target.string().size() + 16);
  }
  Scratch scratch_;
};

TEST_F(AtomicFileTest, AppearsOnCommitOnly) {
  const auto target = scratch_.path("out.txt");
  write_file(target, "old");
  AtomicFile file(target, {.flush_to_disk = true});
  file.write("hello ");
  file.write("world");
  file.write_at(0, "J");
  EXPECT_EQ(file.size(), 11u);
  EXPECT_EQ(read_file(target), "old");
  EXPECT_EQ(files_in(scratch_.folder()), 2u);
  file.commit();
  EXPECT_EQ(read_file(target), "Jello world");
  EXPECT_EQ(files_in(scratch_.folder()), 1u);
}

TEST_F(AtomicFileTest, LeavesNothingWithoutCommit) {
  const auto target = scratch_.path("out.txt");
  write_file(target, "old");
  { AtomicFile(target).write("new"); }
  EXPECT_EQ(read_file(target), "old");
  EXPECT_EQ(files_in(scratch_.folder()), 1u);
}

TEST_F(AtomicFileTest, LeftoversOfAKilledRunDoNotMatter) {
  write_file(scratch_.path(".out.txt.abcdef.partial"), "leftover");
  AtomicFile file(scratch_.path("out.txt"));
  file.write("new");
  file.commit();
  EXPECT_EQ(read_file(scratch_.path("out.txt")), "new");
  EXPECT_EQ(read_file(scratch_.path(".out.txt.abcdef.partial")), "leftover");
}

TEST_F(AtomicFileTest, KeepsThePermissionsOfTheTarget) {
  const auto target = scratch_.path("out.txt");
  for (const auto mode : {fs::perms(0600), fs::perms(0664), fs::perms(0755)}) {
    write_file(target, "old");
    fs::permissions(target, mode);
    EXPECT_EQ(failure(target), "no error");
    EXPECT_EQ(fs::status(target).permissions(), mode);
  }
  const mode_t mask = ::umask(0027);
  EXPECT_EQ(failure(scratch_.path("fresh.txt")), "no error");
  ::umask(mask);
  EXPECT_EQ(fs::status(scratch_.path("fresh.txt")).permissions(), fs::perms(0640));
}

TEST_F(AtomicFileTest, WritesThroughSymbolicLinks) {
  fs::create_directory(scratch_.path("real"));
  write_file(scratch_.path("real/a.txt"), "old");
  fs::create_symlink("real/a.txt", scratch_.path("link1"));
  fs::create_symlink("link1", scratch_.path("link2"));
  fs::create_symlink("real/new.txt", scratch_.path("to_nothing"));
  EXPECT_EQ(failure(scratch_.path("link2")), "no error");
  EXPECT_EQ(failure(scratch_.path("to_nothing")), "no error");
  EXPECT_TRUE(fs::is_symlink(scratch_.path("link1")));
  EXPECT_TRUE(fs::is_symlink(scratch_.path("link2")));
  EXPECT_EQ(read_file(scratch_.path("real/a.txt")), "some text");
  EXPECT_EQ(read_file(scratch_.path("real/new.txt")), "some text");
}

TEST_F(AtomicFileTest, LongNamesHaveRoom) {
  const std::string name(250, 'n');
  EXPECT_EQ(failure(scratch_.path(name)), "no error");
  EXPECT_EQ(read_file(scratch_.path(name)), "some text");
}

TEST_F(AtomicFileTest, PlacesThatCannotBeWritten) {
  EXPECT_EQ(failure(scratch_.folder()), "it is a folder");
  EXPECT_EQ(failure(scratch_.folder() / ""), "it is a folder");
  EXPECT_EQ(failure(scratch_.path("none/out.txt")), "there is no folder " + scratch_.path("none").string());
  write_file(scratch_.path("file"), "");
  EXPECT_EQ(failure(scratch_.path("file/out.txt")), "Not a directory");
  fs::create_symlink("loop", scratch_.path("loop"));
  EXPECT_THAT(failure(scratch_.path("loop")), HasSubstr("symbolic links"));
  if (geteuid() == 0) return;  // whom no permission stops
  write_file(scratch_.path("protected"), "old");
  fs::permissions(scratch_.path("protected"), fs::perms::owner_read);
  EXPECT_EQ(failure(scratch_.path("protected")), "Permission denied");
  fs::permissions(scratch_.folder(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(failure(scratch_.path("out.txt")), "Permission denied");
  fs::permissions(scratch_.folder(), fs::perms::owner_all);
}

TEST_F(AtomicFileTest, DevicesAreWrittenDirectly) {
  EXPECT_EQ(failure("/dev/null"), "no error");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  EXPECT_EQ(failure("/dev/full"), "No space left on device");
}

TEST_F(AtomicFileTest, PipesAreWrittenDirectly) {
  const auto pipe = scratch_.path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const pid_t reader = ::fork();
  ASSERT_GE(reader, 0);
  if (reader == 0) _exit(read_file(pipe) == "some text" ? 0 : 1);
  AtomicFile file(pipe);
  EXPECT_FALSE(file.seekable());
  file.write("some ");
  file.write("text");
  file.commit();
  int status = 0;
  ::waitpid(reader, &status, 0);
  EXPECT_EQ(status, 0);
}

/// A child process may write 100 kB at most, as on a disk that fills up; it exits with 0 if that ends well.
TEST_F(AtomicFileTest, AFileThatCannotGrowLeavesTheOldOne) {
  const auto target = scratch_.path("out.txt");
  write_file(target, "old");
  const pid_t writer = ::fork();
  ASSERT_GE(writer, 0);
  if (writer == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{100000, 100000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const auto error = error_of([&] {
      AtomicFile file(target);
      for (int i = 0; i < 10; ++i)
        file.write(std::string(30000, 'x'));
      file.commit();
    });
    const bool right = error && error->what() == target.string() + ": cannot write: File too large";
    _exit(right ? 0 : 1);
  }
  int status = 0;
  ::waitpid(writer, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(read_file(target), "old");
  EXPECT_EQ(files_in(scratch_.folder()), 1u);
}

}  // namespace
}  // namespace ray
