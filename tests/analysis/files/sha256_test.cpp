#include "analysis/files/sha256.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis {
namespace {

TEST(Sha256Test, AgreesWithTheStandardsExamples) {  // FIPS 180-2, appendix B
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const std::string million(1'000'000, 'a');
  const std::string digest = "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0";
  EXPECT_EQ(sha256_of(million), digest);
  const test::TemporaryFolder folder;
  write_text(folder / "a", million);
  EXPECT_EQ(sha256_of_file(folder / "a"), digest);
  EXPECT_THROW(sha256_of_file(folder / "b"), InputError);
}

}  // namespace
}  // namespace haptrial::analysis
