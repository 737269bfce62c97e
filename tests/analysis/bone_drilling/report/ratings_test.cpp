#include "analysis/bone_drilling/report/ratings.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <set>

#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis::drilling {
namespace {

using test::message_of;

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// Two procedures each of `people`; what was done is told by the fingerprint alone.
std::vector<RatedItem> items_of(const std::vector<std::string>& people) {
  std::vector<RatedItem> items;
  std::uint64_t print = 1000;
  for (const std::string& person : people) {
    for (const int procedure : {1, 2}) {
      items.push_back({person, procedure, print = (print * 48271) % 0x7fffffff});
    }
  }
  return items;
}

class RatingsTest : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  std::string complaint(const std::string& sheet, const RatingKey& key) const {
    const auto path = file("rater.csv", sheet);
    return message_of([&] { read_sheet(path, key); });
  }

  test::TemporaryFolder folder_;
  RatingKey key_{false, {{"AB34", {"S01", 1, 5}}, {"CD67", {"S01", 2, 6}}}};
};

// Codes depend on the procedures and the seed, not on the participants: other names, in another
// alphabetical order and in other files, give the same codes for the same procedures.
TEST_F(RatingsTest, CodesDoNotDependOnNames) {
  const std::vector<std::string> plain{"S01", "S02", "S03"}, other{"zoe", "anna", "mia"};
  const RatingKey a = blinded(items_of(plain), 7, false);
  const RatingKey b = blinded(items_of(other), 7, false);
  EXPECT_EQ(rating_sheet(a), rating_sheet(b));
  ASSERT_EQ(a.entries.size(), 6u);
  for (std::size_t i = 0; i < a.entries.size(); ++i) {
    EXPECT_EQ(a.entries[i].code, b.entries[i].code);
    EXPECT_EQ(a.entries[i].item.fingerprint, b.entries[i].item.fingerprint);
    const auto at = std::find(plain.begin(), plain.end(), a.entries[i].item.session);
    EXPECT_EQ(b.entries[i].item.session, other[static_cast<std::size_t>(at - plain.begin())]);
  }
  EXPECT_NE(rating_sheet(a), rating_sheet(blinded(items_of(plain), 8, false)));
}

// Two studies of the same seed share no code, and neither does a study to which a procedure was
// added; a sheet of the one is refused by the other.
TEST_F(RatingsTest, CodesAreThoseOfOneStudy) {
  const std::vector<RatedItem> items = items_of({"S01", "S02"});
  std::vector<RatedItem> changed = items, more = items;
  ++changed[0].fingerprint;
  more.push_back({"S03", 1, 17});
  const RatingKey key = blinded(items, 7, false);
  std::string filled = "code,score,comment\n";
  for (const KeyEntry& entry : key.entries) {
    filled += entry.code + ",3,\n";
  }
  EXPECT_EQ(read_sheet(file("own.csv", filled), key).size(), 4u);
  for (const std::vector<RatedItem>& other : {changed, more}) {
    EXPECT_THAT(complaint(filled, blinded(other, 7, false)),
                HasSubstr("a code of this study's sheet"));
  }
}

// Every procedure is as likely at every place: the mean place of the first over many seeds is the
// middle (5 standard errors).
TEST_F(RatingsTest, TheOrderIsShuffled) {
  const auto items = items_of({"a", "b", "c", "d", "e"});
  double sum = 0.0;
  constexpr int kSeeds = 2000;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const RatingKey key = blinded(items, seed, false);
    const auto at = std::find_if(key.entries.begin(), key.entries.end(),
                                 [&](const KeyEntry& e) { return e.item == items[0]; });
    sum += static_cast<double>(at - key.entries.begin());
  }
  EXPECT_NEAR(sum / kSeeds, 4.5, 5.0 * 2.872 / std::sqrt(kSeeds));
}

TEST_F(RatingsTest, CodesAreShortAndNeverTwice) {
  std::vector<std::string> many;
  for (int i = 0; i < 2000; ++i) {
    many.push_back(fmt::format("S{}", i));
  }
  std::set<std::string> codes;
  for (const KeyEntry& entry : blinded(items_of(many), 1, false).entries) {
    EXPECT_THAT(entry.code, testing::MatchesRegex("[A-HJKMNP-RT-Y346-9]{4}"));
    codes.insert(entry.code);
  }
  EXPECT_EQ(codes.size(), 4000u);
  EXPECT_THAT(message_of([] {
                blinded({{"S01", 1, 2}, {"S01", 1, 3}}, 1, false);
              }),
              HasSubstr("procedure 1 twice"));
}

TEST_F(RatingsTest, TheKeySaysNothingUntilItIsOpened) {
  const RatingKey key = blinded(items_of({"surgeon01", "novice01"}), 3, true);
  const std::string text = sealed(key);
  for (const KeyEntry& entry : key.entries) {
    EXPECT_THAT(text, AllOf(Not(HasSubstr(entry.code)), Not(HasSubstr(entry.item.session))));
  }
  EXPECT_EQ(opened(text, "key"), key);
}

TEST_F(RatingsTest, AKeyThatWasChangedIsRefused) {
  const std::string text = sealed(key_);
  for (std::size_t at : {std::size_t{5}, text.find('\n') + 3, text.size() - 3}) {
    std::string changed = text;
    changed[at] = changed[at] == '0' ? '1' : '0';
    EXPECT_THAT(message_of([&] { opened(changed, "ratings.key"); }),
                AllOf(HasSubstr("ratings.key"), HasSubstr("was changed")));
  }
  EXPECT_THAT(message_of([&] { opened("", "k"); }), HasSubstr("was changed"));
  EXPECT_THAT(message_of([&] { opened(text.substr(0, text.size() - 5), "k"); }),
              HasSubstr("was changed"));
}

TEST_F(RatingsTest, AFilledInSheetComesBack) {
  std::string sheet = rating_sheet(key_);
  sheet.replace(sheet.find("AB34,,"), 6, "AB34,4,\"open, but rough\"");
  sheet.replace(sheet.find("CD67,,"), 6, "CD67,2,");
  const auto ratings = read_sheet(file("jones.csv", sheet), key_);
  const std::vector<Rating> expected{{"S01", 1, "jones", 4.0, "open, but rough", false},
                                     {"S01", 2, "jones", 2.0, "", false}};
  EXPECT_EQ(ratings, expected);
  EXPECT_EQ(load_ratings(file("ratings.csv", ratings_csv(ratings))), expected);
}

// Spreadsheets save with semicolons, CRLF and a decimal comma.
TEST_F(RatingsTest, ASpreadsheetsOwnFormIsRead) {
  RatingKey halves = key_;
  halves.halves = true;
  const auto ratings = read_sheet(file("li.csv",
                                       "\xef\xbb\xbf"
                                       "code;score;comment\r\nCD67;3,5;\r\nAB34;5;fine\r\n"),
                                  halves);
  EXPECT_EQ(ratings[0].score, 3.5);
  EXPECT_EQ(ratings[1].score, 5.0);
}

TEST_F(RatingsTest, EveryWrongLineHasItsSentence) {
  const std::string head = "code,score,comment\n";
  EXPECT_THAT(complaint(head + "AB34,4,\n", key_),
              AllOf(HasSubstr("rater.csv"), HasSubstr("CD67 has no line")));
  EXPECT_THAT(complaint(head + "AB34,4,\nAB34,4,\nCD67,1,\n", key_),
              AllOf(HasSubstr(":3:"), HasSubstr("AB34"), HasSubstr("each code once")));
  EXPECT_THAT(
      complaint(head + "AB34,4,\nXX99,4,\n", key_),
      AllOf(HasSubstr(":3:"), HasSubstr("XX99"), HasSubstr("a code of this study's sheet")));
  for (const char* score : {"", "0", "6", "-1", "3.5", "nan", "four", "0x3", "4 5", "1e0"}) {
    EXPECT_THAT(complaint(head + "AB34," + score + ",\nCD67,1,\n", key_),
                AllOf(HasSubstr(":2:"), HasSubstr("score"), HasSubstr("1, 2, 3, 4 or 5")))
        << score;
  }
  RatingKey halves = key_;
  halves.halves = true;
  EXPECT_THAT(complaint(head + "AB34,3.25,\nCD67,1,\n", halves), HasSubstr("half points"));
  EXPECT_THAT(complaint("code,comment\nAB34,\n", key_), HasSubstr("score"));
}

TEST_F(RatingsTest, RatingsThatDoNotFitAreRefused) {
  const std::string head = "session,procedure,rater,score,simulated,comment\n";
  const auto refused = [&](const std::string& rows) {
    const auto path = file("ratings.csv", head + rows);
    return message_of([&] { load_ratings(path); });
  };
  EXPECT_THAT(refused("S01,1,a,7,0,\n"), HasSubstr("1 to 5"));
  EXPECT_THAT(refused("S01,0,a,3,0,\n"), HasSubstr("whole number from 1"));
  EXPECT_THAT(refused("S01,1,a,3,2,\n"), HasSubstr("whole number from 0 to 1"));
  EXPECT_THAT(refused("S01,1,a,3,0,\nS01,1,a,4,0,\n"), HasSubstr("each rater once"));
}

}  // namespace
}  // namespace haptrial::analysis::drilling
