#include "analysis/bone_drilling/report/session_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/bone_drilling/hand_made.h"

namespace haptrial::analysis::drilling::session_files_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::shared_ptr<const bone::BoneModel> made_bone(int length) {
  return std::make_shared<const bone::BoneModel>(test::block(length, 1, 1));
}

TEST(SessionFilesTest, SessionsOnAnotherBoneAreNamed) {
  const auto first = made_bone(5), second = made_bone(6), replaced = made_bone(7);
  std::vector<SessionFiles> sessions{
      {"S01.h5", {{{"drilling", 1}, first}, {{"drilling", 2}, second}}, {}},
      {"S02.h5", {{{"drilling", 1}, first}}, {}},
      {"S03.h5", {{{"low tegmen", 1}, second}}, {}}};
  EXPECT_THAT(remarks_on_files(sessions), IsEmpty()) << "procedures take several bones in turn";
  sessions.push_back({"S04.h5", {{{"drilling", 1}, first}, {{"drilling", 2}, replaced}}, {}});
  sessions.push_back({"S05.h5", {{{"low tegmen", 1}, replaced}}, {}});
  EXPECT_THAT(remarks_on_files(sessions), ElementsAre(HasSubstr("the same: S04.h5, S05.h5.")));
}

TEST(SessionFilesTest, SessionsWithOtherSafeValuesAreNamed) {
  const record::HintLimitRow limit{0, "nerve", 0.002, 0.004, 1.5, 0.04, 8, false};
  record::HintLimitRow stricter = limit;
  stricter.force = 0.1;
  std::vector<SessionFiles> sessions{{"S01.h5", {}, {limit}}, {"S02.h5", {}, {limit}}};
  EXPECT_THAT(remarks_on_files(sessions), IsEmpty());
  sessions.push_back({"S03.h5", {}, {stricter}});
  EXPECT_THAT(remarks_on_files(sessions),
              ElementsAre(HasSubstr("than S01.h5, although the definition names the same file: "
                                    "S03.h5.")));
}

}  // namespace
}  // namespace haptrial::analysis::drilling::session_files_test
