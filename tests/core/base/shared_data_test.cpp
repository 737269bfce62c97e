#include "tests/support/shared_data.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace haptrial::test {
namespace {

namespace fs = std::filesystem;

/// Gives HAPTRIAL_DATA back as it was.
class SharedDataTest : public testing::Test {
 protected:
  SharedDataTest() {
    if (const char* named = std::getenv("HAPTRIAL_DATA")) {
      before_ = named;
    }
    unsetenv("HAPTRIAL_DATA");
    fs::create_directory(folder_ / "checkout");
  }
  ~SharedDataTest() override {
    before_ ? setenv("HAPTRIAL_DATA", before_->c_str(), 1) : unsetenv("HAPTRIAL_DATA");
  }
  TemporaryFolder folder_;
  std::optional<std::string> before_;
};

TEST_F(SharedDataTest, IsFoundBesideTheCheckoutWhereNoVariableNamesIt) {
  EXPECT_EQ(shared_data_folder(folder_ / "checkout"), std::nullopt);
  fs::create_directories(folder_ / "shared/data");
  EXPECT_EQ(shared_data_folder(folder_ / "checkout"), folder_ / "shared/data");
}

TEST_F(SharedDataTest, TheVariableGoesBeforeTheFolderBesideTheCheckout) {
  fs::create_directories(folder_ / "shared/data");
  fs::create_directories(folder_ / "elsewhere");
  setenv("HAPTRIAL_DATA", (folder_ / "elsewhere").c_str(), 1);
  EXPECT_EQ(shared_data_folder(folder_ / "checkout"), folder_ / "elsewhere");
  setenv("HAPTRIAL_DATA", (folder_ / "nowhere").c_str(), 1);
  EXPECT_EQ(shared_data_folder(folder_ / "checkout"), std::nullopt);
}

}  // namespace
}  // namespace haptrial::test
