// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/atomic_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/stat.h>

#include "shapemap/core/errors.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

using test::read_file;
using test::TempFolder;
using testing::ElementsAre;
using testing::HasSubstr;

std::string output_error(const std::string& path, const std::string& content) {
  try {
    write_file(path, content);
    return "";
  } catch (const OutputError& error) {
    return error.what();
  }
}

TEST(AtomicFile, AppearsOnlyWithCommit) {
  const TempFolder folder;
  const std::string path = folder.write("map.png", "old");
  {
    AtomicFile file(path);
    EXPECT_EQ(file.temporary_path().substr(file.temporary_path().size() - 4), ".png");
    EXPECT_EQ(std::filesystem::path(file.temporary_path()).parent_path(), std::filesystem::path(path).parent_path());
    std::ofstream(file.temporary_path()) << "new";
    EXPECT_EQ(read_file(path), "old");
    file.commit();
  }
  EXPECT_EQ(read_file(path), "new");
  EXPECT_THAT(folder.names(), ElementsAre("map.png"));
}

TEST(AtomicFile, LeavesNothingBehindWithoutCommit) {
  const TempFolder folder;
  const std::string path = folder.write("map.png", "old");
  {
    const AtomicFile file(path);
    std::ofstream(file.temporary_path()) << "half";
  }
  EXPECT_EQ(read_file(path), "old");
  EXPECT_THAT(folder.names(), ElementsAre("map.png"));
}

TEST(AtomicFile, TwoOfOnePathDoNotMeet) {
  const TempFolder folder;
  const AtomicFile a(folder.path("x.txt"));
  const AtomicFile b(folder.path("x.txt"));
  EXPECT_NE(a.temporary_path(), b.temporary_path());
}

TEST(AtomicFile, ObeysTheUmaskLikeAnyOtherFile) {
  const TempFolder folder;
  const mode_t before = ::umask(0022);
  write_file(folder.path("x.txt"), "x");
  ::umask(before);
  struct stat status {};
  ASSERT_EQ(::stat(folder.path("x.txt").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0644U);
}

TEST(AtomicFile, KeepsASymbolicLink) {
  const TempFolder folder;
  const std::string target = folder.write("target.txt", "old");
  std::filesystem::create_symlink(target, folder.path("link.txt"));
  write_file(folder.path("link.txt"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("link.txt")));
  EXPECT_EQ(read_file(target), "new");
}

TEST(AtomicFile, SaysWhyAFolderCannotBeWrittenTo) {
  const TempFolder folder;
  EXPECT_THAT(output_error(folder.path("missing/x.txt"), "x"), HasSubstr("No such file or directory"));
  folder.write("file", "x");
  EXPECT_THAT(output_error(folder.path("file/x.txt"), "x"), HasSubstr("Not a directory"));
  EXPECT_THAT(output_error(folder.path(""), "x"), HasSubstr("is a directory"));
}

TEST(AtomicFile, WritesToADeviceInsteadOfReplacingIt) {
  EXPECT_THAT(output_error("/dev/full", "x"), HasSubstr("No space left on device"));
  EXPECT_EQ(output_error("/dev/null", "x"), "");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(AtomicFile, FullDiskLeavesTheOldFile) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.path("small"));
  if (::mount("none", folder.path("small").c_str(), "tmpfs", 0, "size=64k") != 0) {
    GTEST_SKIP() << "needs the right to mount a small disk";
  }
  const std::string path = folder.write("small/x.txt", "old");
  EXPECT_THAT(output_error(path, std::string(1U << 20U, 'x')), HasSubstr("No space left on device"));
  EXPECT_EQ(read_file(path), "old");
  std::size_t num_files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path("small"))) ++num_files;
  EXPECT_EQ(num_files, 1U);
  ::umount(folder.path("small").c_str());
}

TEST(AtomicFile, ACommitCanBeTakenBackUntilItIsSettled) {
  const TempFolder folder;
  const std::string old_path = folder.write("old.txt", "old");
  const auto committed = [&](const std::string& path) {
    auto file = std::make_unique<AtomicFile>(path);
    std::ofstream(file->temporary_path()) << "new";
    file->commit();
    EXPECT_EQ(read_file(path), "new");
    return file;
  };
  for (const std::string& path : {old_path, folder.path("new.txt")}) {
    const auto file = committed(path);
    file->roll_back();
    file->roll_back();
  }
  EXPECT_EQ(read_file(old_path), "old");
  EXPECT_THAT(folder.names(), ElementsAre("old.txt"));
  for (const std::string& path : {old_path, folder.path("new.txt")}) {
    const auto file = committed(path);
    file->settle();
    EXPECT_EQ(folder.names().size(), path == old_path ? 1U : 2U);
    file->roll_back();
    EXPECT_EQ(read_file(path), "new");
  }
}

TEST(AtomicFile, WithoutACommitThereIsNothingToTakeBack) {
  const TempFolder folder;
  const std::string path = folder.write("x.txt", "old");
  AtomicFile file(path);
  file.roll_back();
  EXPECT_EQ(read_file(path), "old");
}

TEST(AtomicFile, LeavesWhatAnotherRunHasMadeMeanwhile) {
  const TempFolder folder;
  const std::string path = folder.path("x.txt");
  AtomicFile file(path);
  folder.write("x.txt", "of another run");
  EXPECT_THROW(file.commit(AtomicFile::IfExists::kFail), OutputError);
  file.roll_back();
  EXPECT_EQ(read_file(path), "of another run");
  std::filesystem::remove(path);
  std::ofstream(file.temporary_path()) << "mine";
  file.commit(AtomicFile::IfExists::kFail);
  EXPECT_EQ(read_file(path), "mine");
  EXPECT_THAT(folder.names(), ElementsAre("x.txt"));
}

}  // namespace
}  // namespace shapemap
