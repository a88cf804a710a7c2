#include "common/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "common/errors.h"
#include "tests/support.h"

namespace foresight {
namespace {

namespace fs = std::filesystem;

struct stat status_of(const std::string& file) {
  struct stat status {};
  EXPECT_EQ(::stat(file.c_str(), &status), 0);
  return status;
}

std::size_t files_in(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(AtomicFile, reads_back_what_was_written) {
  const test::TemporaryFolder folder;
  const std::string content("bytes\0\r\n\xFF of any kind", 20);
  EXPECT_TRUE(write_file_atomically(folder.file("a"), content));
  EXPECT_EQ(read_whole_file(folder.file("a")), content);
  EXPECT_TRUE(write_file_atomically(folder.file("a"), ""));
  EXPECT_EQ(read_whole_file(folder.file("a")), "");
  const std::string large(3'000'000, 'x');
  EXPECT_TRUE(write_file_atomically(folder.file("a"), large));
  EXPECT_EQ(read_whole_file(folder.file("a")), large);
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFile, leaves_equal_content_untouched) {
  const test::TemporaryFolder folder;
  write_file_atomically(folder.file("a"), "same");
  const auto before = status_of(folder.file("a"));
  EXPECT_FALSE(write_file_atomically(folder.file("a"), "same"));
  const auto after = status_of(folder.file("a"));
  EXPECT_EQ(before.st_ino, after.st_ino);
  EXPECT_EQ(before.st_mtim.tv_nsec, after.st_mtim.tv_nsec);
  EXPECT_TRUE(write_file_atomically(folder.file("a"), "sama"));
}

TEST(AtomicFile, replaces_by_rename_so_that_readers_keep_the_old_file) {
  const test::TemporaryFolder folder;
  write_file_atomically(folder.file("a"), "old");
  std::ifstream reader(folder.file("a"));
  write_file_atomically(folder.file("a"), "new");
  std::string seen;
  reader >> seen;
  EXPECT_EQ(seen, "old");
}

TEST(AtomicFile, keeps_the_mode_of_the_file_and_honours_the_umask) {
  const test::TemporaryFolder folder;
  const mode_t old = ::umask(027);
  write_file_atomically(folder.file("a"), "1");
  ::umask(old);
  EXPECT_EQ(status_of(folder.file("a")).st_mode & 07777U, 0640U);
  ::chmod(folder.file("a").c_str(), 0604);
  write_file_atomically(folder.file("a"), "2");
  EXPECT_EQ(status_of(folder.file("a")).st_mode & 07777U, 0604U);
}

TEST(AtomicFile, writes_a_bare_name_and_through_a_link) {
  const test::TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  write_file_atomically("bare", "here");
  fs::create_symlink("bare", "link");
  write_file_atomically("link", "there");
  fs::current_path(before);
  EXPECT_EQ(read_whole_file(folder.file("bare")), "there");
  EXPECT_TRUE(fs::is_symlink(folder.file("link")));
}

TEST(AtomicFile, writes_what_is_no_regular_file_directly) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(write_file_atomically("/dev/null", "gone"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  EXPECT_TRUE(write_file_atomically("/dev/fd/" + std::to_string(ends[1]), "through"));
  char got[8] = {};
  EXPECT_EQ(::read(ends[0], got, 7), 7);
  EXPECT_STREQ(got, "through");
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(AtomicFile, leaves_the_old_file_and_no_temporary_when_the_disk_is_full) {
  const test::TemporaryFolder folder;
  write_file_atomically(folder.file("a"), "old");
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit small{4096, limit.rlim_max};
  auto* handler = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(write_file_atomically(folder.file("a"), std::string(100'000, 'x')), InputError);
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(read_whole_file(folder.file("a")), "old");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFile, names_what_cannot_be_written_or_read) {
  const test::TemporaryFolder folder;
  const auto cause = [](const std::function<void()>& action) -> std::string {
    try {
      action();
    } catch (const InputError& error) {
      EXPECT_FALSE(error.mend().empty());
      return error.what();
    }
    return "no error";
  };
  const auto write = [&](const std::string& file) { return cause([&] { write_file_atomically(file, "x"); }); };
  const auto read = [&](const std::string& file) { return cause([&] { static_cast<void>(read_whole_file(file)); }); };
  EXPECT_NE(write(folder.path()).find("folder"), std::string::npos);
  EXPECT_NE(write(folder.file("none/a")).find("create the folder"), std::string::npos);
  EXPECT_NE(write("").find("empty name"), std::string::npos);
  EXPECT_NE(write("/proc/none").find("/proc/none: cannot be written"), std::string::npos);
  write_file_atomically(folder.file("a"), "x");
  EXPECT_NE(write(folder.file("a/b")).find("cannot be written"), std::string::npos);
  EXPECT_NE(read(folder.path()).find("is a folder"), std::string::npos);
  EXPECT_NE(read(folder.file("none")).find("does not exist"), std::string::npos);
  EXPECT_NE(read(folder.file("a/b")).find("cannot be read"), std::string::npos);
  EXPECT_EQ(files_in(folder.path()), 1U);
}

}  // namespace
}  // namespace foresight
