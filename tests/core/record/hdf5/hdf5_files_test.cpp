#include <gtest/gtest.h>
#include <hdf5.h>

#include <filesystem>

#include "core/record/hdf5/file_lock.h"
#include "core/record/hdf5/hdf5_layer.h"
#include "core/record/hdf5/session_writer.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record::hdf5_files_test {
namespace {

namespace fs = std::filesystem;

unsigned read_attempts(const fs::path& path) {
  const h5::Lock lock;
  const h5::Id file = h5::open_file(path);
  const h5::Id access(H5Fget_access_plist(file.get()));
  unsigned attempts = 0;
  EXPECT_GE(H5Pget_metadata_read_attempts(access.get(), &attempts), 0);
  return attempts;
}

/// A torn look becomes whole only while somebody writes; a damaged file would cost the wait for
/// each of its chunks.
TEST(Hdf5FilesTest, OnlyAFileThatIsWrittenIsReadAgain) {
  const test::TemporaryFolder folder;
  SessionInfo info = test::example_info();
  info.clock = "real";
  {
    SessionWriter writer(folder / "a.h5", info);
    writer.append(test::hand_motion(3000, 2));
    writer.sync();
    EXPECT_FALSE(FileLock::certainly_free(folder / "a.h5.partial"));
    fs::copy_file(folder / "a.h5.partial", folder / "killed.h5.partial");
  }
  EXPECT_TRUE(FileLock::certainly_free(folder / "killed.h5.partial"));
  EXPECT_EQ(read_attempts(folder / "killed.h5.partial"), 1u);
}

}  // namespace
}  // namespace haptrial::record::hdf5_files_test
