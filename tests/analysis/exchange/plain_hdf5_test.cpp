// Session files are for MATLAB too, which is not here: what its h5read needs is checked instead,
// and another reader than ours, where it is installed, reads a file.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/base/file_text.h"
#include "tests/analysis/exchange/small_session.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::exchange {
namespace {

namespace fs = std::filesystem;

std::string output_of(const std::string& line, int& status) {
  const test::TemporaryFolder folder;
  const fs::path log = folder / "log";
  status = std::system((line + " >'" + log.string() + "' 2>&1").c_str());
  return file_text(log);
}

TEST(PlainHdf5Test, NothingThatMatlabLacks) {
  const test::TemporaryFolder folder;
  write_session(folder / "s.h5", {});
  int status = -1;
  const std::string output = output_of("/usr/bin/python3 '" HAPTRIAL_SOURCE_DIR
                                       "/tests/analysis/exchange/plain_hdf5.py' '" +
                                           (folder / "s.h5").string() + "'",
                                       status);
  EXPECT_EQ(status, 0) << output;
  EXPECT_EQ(output, "plain\n");
}

TEST(PlainHdf5Test, H5dumpReadsTheSamples) {
  const test::TemporaryFolder folder;
  write_session(folder / "s.h5", {.trials = 1});
  int status = -1;
  const std::string output =
      output_of("h5dump -p -d /samples -s 53 -c 1 '" + (folder / "s.h5").string() + "'", status);
  EXPECT_EQ(status, 0) << output;
  EXPECT_THAT(output, testing::HasSubstr("COMPRESSION DEFLATE"));
  EXPECT_THAT(output, testing::HasSubstr("H5T_IEEE_F32LE \"applied_force\""));
  EXPECT_THAT(output, testing::HasSubstr("(53): {"));
}

}  // namespace
}  // namespace haptrial::exchange
