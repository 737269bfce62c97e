#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "analysis/bone_drilling/report/ratings.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "experiments/studies/drilling/drilling_study.h"
#include "experiments/studies/drilling/rating_pictures.h"
#include "experiments/study/study_run.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/load_bones.h"
#include "tests/experiments/command.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using test::message_of;

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Names and bytes of all files.
std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    files[entry.path().filename().string()] = file_text(entry.path());
  }
  return files;
}

/// Two participants, one short procedure each, on a coarse bone.
class RateTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    const fs::path source = fs::path(HAPTRIAL_SOURCE_DIR) / "experiments/bone_drilling.toml";
    std::string text = file_text(source);
    const auto replace = [&](const std::string& from, const std::string& to) {
      const auto at = text.find(from);
      ASSERT_NE(at, std::string::npos) << from;
      text.replace(at, from.size(), to);
    };
    replace("participants = 1", "participants = 2");
    replace("time_limit = 60.0", "time_limit = 4.0");
    replace("seed = 1 ", "spacing = 0.0006\nseed = 1 ");
    text.erase(text.find("[dust]"), text.find("[sound]") - text.find("[dust]"));  // it takes time
    std::ofstream(*folder_ / "short.toml") << text;
    const protocols::BoneDefinition definition =
        protocols::load_bone_definition(*folder_ / "short.toml");
    DryRun dry_run;
    dry_run.participants = 2;
    dry_run.folder = *folder_ / "study";
    run_dry(protocols::bone_drilling(), definition, dry_run);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static fs::path study() { return *folder_ / "study"; }
  /// The same sessions under other names in a new folder.
  static fs::path copied(const char* folder, const char* first, const char* second) {
    const fs::path other = *folder_ / folder;
    fs::create_directories(other);
    fs::copy_file(study() / "S01.h5", other / first);
    fs::copy_file(study() / "S02.h5", other / second);
    return other;
  }
  /// Runs a subcommand of haptrial rate.
  static test::CommandResult rate(const std::string& words) {
    return test::run_command("haptrial rate " + words);
  }
  static void prepare(const fs::path& sessions, const fs::path& out, bool sheets = true) {
    const test::CommandResult made =
        rate(fmt::format("prepare '{}' --out '{}' --frames 4 --speed 2{}", sessions.string(),
                         out.string(), sheets ? " --sheets" : ""));
    EXPECT_EQ(made.status, 0) << made.errors;
  }

  /// Folder with the sheets of the study, made once.
  static fs::path sheets() {
    const fs::path made = *folder_ / "sheets";
    if (!fs::exists(made)) {
      prepare(study(), made);
    }
    return made;
  }
  /// Folder with the films, made once, of a copy of the study: each preparation has its own key.
  static fs::path films() {
    const fs::path made = *folder_ / "films";
    if (!fs::exists(made)) {
      prepare(copied("filmed", "S01.h5", "S02.h5"), made, false);
    }
    return made;
  }

  static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> RateTest::folder_;

TEST_F(RateTest, WhatRatersGetDoesNotDependOnNames) {
  prepare(copied("renamed", "zoe.h5", "anna.h5"), *folder_ / "b");  // in another order
  const auto a = files_in(sheets()), b = files_in(*folder_ / "b");
  EXPECT_EQ(a.size(), 4u);
  EXPECT_TRUE(a == b);
  std::vector<fs::file_time_type> times;
  for (const auto& entry : fs::directory_iterator(sheets())) {
    times.push_back(entry.last_write_time());
    EXPECT_EQ(times.back(), times.front()) << entry.path();
  }
  for (const auto& [name, bytes] : a) {
    const std::string told = bytes.substr(0, bytes.find("IDAT"));  // pixels have any three letters
    EXPECT_EQ(told.find("S01"), std::string::npos) << name;
  }
}

/// Entries of the first stream of a film, as ffprobe prints them.
std::string probed(const fs::path& film, const std::string& entries) {
  const test::CommandResult result =
      test::run_command("ffprobe -v error -of default=nk=1:nw=1 -show_entries " + entries + " '" +
                        film.string() + "'");
  EXPECT_EQ(result.status, 0) << result.errors;
  return result.output;
}

TEST_F(RateTest, FilmsAreOfOneKindAndTellNothingElse) {
  prepare(copied("others", "zoe.h5", "anna.h5"), *folder_ / "others-films", false);
  EXPECT_TRUE(files_in(films()) == files_in(*folder_ / "others-films"))
      << "names of participants enter";
  std::vector<std::string> kinds;
  for (const auto& [name, bytes] : files_in(films())) {
    if (!name.ends_with(".mp4")) {
      continue;
    }
    const fs::path film = films() / name;
    kinds.push_back(
        probed(film, "stream=codec_name,width,height,pix_fmt,r_frame_rate,time_base,profile"));
    EXPECT_EQ(kinds.back(), kinds.front());
    // 4 s twice as fast, and 4 s of the cavity; at 15 pictures a second.
    EXPECT_NEAR(std::stod(probed(film, "stream=duration")), 2.0 + 4.0, 0.1) << name;
    EXPECT_EQ(probed(film, "stream_tags=creation_time:format_tags=creation_time,title,comment"),
              "");
    for (const char* word : {"S01.h5", "anna", "study", "short"}) {
      EXPECT_EQ(bytes.find(word), std::string::npos) << name << " holds " << word;
    }
  }
  EXPECT_EQ(kinds.size(), 2u);
  EXPECT_THAT(kinds.front(), HasSubstr("h264"));
}

TEST_F(RateTest, TheEndOfAFilmStandsStillAndItsBeginningMoves) {
  for (const auto& entry : fs::directory_iterator(films())) {
    if (entry.path().extension() != ".mp4") {
      continue;
    }
    // Decoded again, 64 by 36 grey pixels a picture.
    const test::CommandResult decoded =
        test::run_command("ffmpeg -v error -i '" + entry.path().string() +
                          "' -vf scale=64:36 -f rawvideo -pix_fmt gray - | od -An -v -tu1 -w2304");
    ASSERT_EQ(decoded.status, 0) << decoded.errors;
    std::vector<std::vector<int>> pictures;
    std::istringstream lines(decoded.output);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream bytes(line);
      pictures.emplace_back(std::istream_iterator<int>(bytes), std::istream_iterator<int>());
    }
    ASSERT_EQ(pictures.size(), 31u + 60u);  // 4000 ticks, every 133rd; 4 s
    const auto moved = [&](std::size_t from, std::size_t to) {
      int pixels = 0;
      for (std::size_t i = 0; i < pictures[from].size(); ++i) {
        pixels += std::abs(pictures[from][i] - pictures[to][i]) > 12 ? 1 : 0;
      }
      return pixels;
    };
    EXPECT_GT(moved(0, 25), 5) << "the tool moves";
    EXPECT_EQ(moved(35, 89), 0) << "the cavity stands";
    EXPECT_GT(moved(28, 40), 5) << "and without the tool";
    EXPECT_GT(*std::max_element(pictures[40].begin(), pictures[40].end()), 100) << "it is lit";
  }
}

TEST_F(RateTest, ScoresComeBackUnderTheirSession) {
  std::string sheet = file_text(sheets() / "rating-sheet.csv");
  int score = 2;
  for (std::size_t at; (at = sheet.find(",,\n")) != std::string::npos;) {
    sheet.replace(at, 3, "," + std::to_string(score++) + ",\n");
  }
  std::ofstream(*folder_ / "li.csv") << sheet;
  const std::string words =
      fmt::format("import '{}' --study '{}'", (*folder_ / "li.csv").string(), study().string());
  fs::remove(study() / kRatingsFile);
  const test::CommandResult read = rate(words);
  EXPECT_EQ(read.status, 0) << read.errors;
  const auto ratings = analysis::drilling::load_ratings(study() / kRatingsFile);
  ASSERT_EQ(ratings.size(), 2u);
  EXPECT_NE(ratings[0].session, ratings[1].session);
  EXPECT_EQ(ratings[0].score + ratings[1].score, 5.0);
  const test::CommandResult again = rate(words);
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.errors, HasSubstr("exists already"));
  const test::CommandResult twice =
      rate(fmt::format("import --overwrite '{0}' '{0}' --study '{1}'",
                       (*folder_ / "li.csv").string(), study().string()));
  EXPECT_EQ(twice.status, 2);
  EXPECT_THAT(twice.errors, HasSubstr("has another sheet"));
  fs::remove(study() / kRatingsFile);
}

TEST_F(RateTest, NothingIsOverwritten) {
  const fs::path made = sheets();
  const std::string words = fmt::format("prepare '{}' --out ", study().string());
  const test::CommandResult full = rate(words + "'" + made.string() + "'");
  EXPECT_EQ(full.status, 2);
  EXPECT_THAT(full.errors, HasSubstr("a new folder"));
  const test::CommandResult again = rate(words + "'" + (*folder_ / "e").string() + "'");
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.errors, HasSubstr("remove it to prepare the study again"));
  EXPECT_FALSE(fs::exists(*folder_ / "e"));
}

TEST_F(RateTest, AStudyOfDrillingsIsAnalysed) {
  EXPECT_EQ(test::run_command("haptrial analyze '" + study().string() + "'").status, 0);
  const std::string report = file_text(study() / "report.md");
  EXPECT_THAT(report, HasSubstr("proves nothing about people"));
  EXPECT_THAT(report, HasSubstr("Nothing is rated yet"));
  EXPECT_TRUE(fs::exists(study() / "metrics.csv"));
}

TEST(ContactSheet, PutsEveryPictureInItsPlace) {
  const auto plain = [](std::uint8_t value, int width) {
    return render::Image{width, 2,
                         std::vector<std::uint8_t>(static_cast<std::size_t>(6) * width, value)};
  };
  const render::Image sheet =
      contact_sheet({plain(10, 3), plain(20, 3), plain(30, 3)}, 2, plain(40, 6));
  ASSERT_EQ(sheet.width, 6);
  ASSERT_EQ(sheet.height, 6);
  const auto at = [&](int x, int y) {
    return static_cast<int>(sheet.rgb[static_cast<std::size_t>(3) * (6 * y + x)]);
  };
  EXPECT_THAT(
      (std::vector<int>{at(0, 0), at(2, 1), at(3, 0), at(0, 2), at(3, 2), at(0, 4), at(5, 5)}),
      testing::ElementsAre(10, 10, 20, 30, 0, 40, 40));
  EXPECT_THROW(contact_sheet({plain(1, 3), plain(1, 2)}, 2, plain(1, 6)), std::invalid_argument);
  EXPECT_THROW(contact_sheet({}, 2, plain(1, 6)), std::invalid_argument);
}

/// A participant with a number keeps the group, and further ones share the groups out as they are
/// stated.
TEST(StudyGroups, TakeFurtherParticipantsInTurn) {
  const auto groups_of = [](int participants) {
    Table root = Table::parse("[groups]\ntrained = 4\ncontrol = 2\n", "d.toml");
    auto groups = protocols::read_groups(root);
    protocols::plan_further(root, groups, participants);
    root.finish();
    std::string all;
    for (int number = 1; number <= participants; ++number) {
      all += group_of(groups, "P" + std::to_string(number)).front();
    }
    EXPECT_EQ(groups[0].planned, std::count(all.begin(), all.end(), 't'));
    EXPECT_EQ(groups[1].planned, std::count(all.begin(), all.end(), 'c'));
    EXPECT_THROW(group_of(groups, "P" + std::to_string(participants + 1)), InputError);
    EXPECT_EQ(group_warnings(groups).size(), participants > 6 ? 1u : 0u);
    return all;
  };
  EXPECT_EQ(groups_of(6), "ttttcc");
  EXPECT_EQ(groups_of(7), "ttttcct");
  EXPECT_EQ(groups_of(13), "ttttccttcttct");
  EXPECT_THAT(message_of([&] { groups_of(5); }), HasSubstr("has 6 participants in all; make it 5"));
}

TEST(StudyGroups, AreThoseOfTheDefinitionInItsOrder) {
  const auto read = [](const char* text) {
    Table root = Table::parse(text, "d.toml");
    auto groups = protocols::read_groups(root);
    root.finish();
    return groups;
  };
  const auto groups = read("[groups]\nsurgeons = 4\nresidents = 4\nnovices = 7\n");
  const std::vector<protocols::StudyGroup> expected{
      {"surgeons", 4, true, 4}, {"residents", 4, true, 4}, {"novices", 7, false, 7}};
  EXPECT_EQ(groups, expected);
  EXPECT_EQ(group_of(groups, "S04"), "surgeons");
  EXPECT_EQ(group_of(groups, "S05"), "residents");
  EXPECT_EQ(group_of(groups, "P-9"), "novices");
  EXPECT_EQ(group_of(groups, "S15"), "novices");
  for (const char* subject : {"S16", "S00", "Ann", "S99999999"}) {
    EXPECT_THAT(message_of([&] { group_of(groups, subject); }), HasSubstr("belongs to no group"));
  }
  Table none = Table::parse("x = 1", "d.toml");
  EXPECT_EQ(group_of(protocols::read_groups(none), "Ann"), "participants");
  EXPECT_THAT(message_of([&] { read("[groups]\na = 0\n"); }),
              HasSubstr("groups.a is 0; allowed: a whole number from 1 to 10000"));
}

}  // namespace
}  // namespace haptrial::experiments
