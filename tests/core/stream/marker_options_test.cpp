#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/stream/marker_options.h"
#include "core/stream/marker_times.h"

namespace haptrial::markers {
namespace {

using record::MarkerOf;
using testing::ElementsAre;
using testing::HasSubstr;

MarkerOptions options_of(const std::string& text) {
  Table root = Table::parse("[markers]\n" + text, "study.toml");
  Table table = root.table("markers");
  MarkerOptions options = marker_schema().read(table);
  root.finish();
  return options;
}

std::string problem_of(const std::string& text) {
  try {
    options_of(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

std::string problem_of(const std::vector<MarkerMeaning>& meanings) {
  Table root = Table::parse("[markers]\ntrial = 1\n", "study.toml");
  Table table = root.table("markers");
  marker_schema().read(table);
  check_meanings(root, "markers", meanings);
  try {
    root.finish();
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(MarkerOptionsTest, HaveDefaultsAndRead) {
  const MarkerOptions plain = options_of("");
  EXPECT_TRUE(plain.used);
  EXPECT_EQ(plain.serial, "");
  EXPECT_EQ(plain.baud, 115200);
  EXPECT_EQ(plain.pulse, 0.005);
  const MarkerOptions stated = options_of(
      "serial = \"/dev/ttyUSB0\"\nbaud = 9600\npulse = 0.01\ntrial = 5\ninterval = 30\n"
      "stage = 40\nresponse = 60\nsend = [\"response\", \"trial\", \"response\"]\n");
  EXPECT_EQ(stated.serial, "/dev/ttyUSB0");
  EXPECT_EQ(stated.baud, 9600);
  EXPECT_EQ(stated.pulse, 0.01);
  EXPECT_EQ(stated.trial, 5);
  EXPECT_EQ(stated.interval, 30);
  EXPECT_EQ(stated.stage, 40);
  EXPECT_EQ(stated.response, 60);
  EXPECT_THAT(stated.send, ElementsAre(MarkerOf::kResponse, MarkerOf::kTrial));
}

TEST(MarkerOptionsTest, MistakesGetASentence) {
  EXPECT_THAT(problem_of("trial = 0\n"), HasSubstr("markers.trial is 0; allowed: "));
  EXPECT_THAT(problem_of("stage = 256\n"), HasSubstr("markers.stage is 256"));
  EXPECT_THAT(problem_of("baud = 1234\n"), HasSubstr("9600, 19200"));
  EXPECT_THAT(problem_of("send = [\"break\"]\n"), HasSubstr("stage, response, interval, trial"));
  EXPECT_THAT(problem_of("pulse = -1.0\n"), HasSubstr("markers.pulse"));
  EXPECT_THAT(problem_of("serail = \"/dev/ttyS0\"\n"), HasSubstr("serial"));
}

TEST(MarkerOptionsTest, ACodeHasOneMeaning) {
  EXPECT_EQ(problem_of({{MarkerOf::kTrial, 0, "trial", 1}, {MarkerOf::kStage, 0, "press", 21}}),
            "none");
  const std::string twice =
      problem_of({{MarkerOf::kTrial, 0, "trial", 21}, {MarkerOf::kStage, 0, "press", 21}});
  EXPECT_THAT(twice, HasSubstr("give the code 21 two meanings, trial and stage press"));
  const std::string beyond = problem_of({{MarkerOf::kResponse, 160, "yes", 261}});
  EXPECT_THAT(beyond, HasSubstr("give response yes the code 261; allowed: 1 to 255"));
}

TEST(MarkerOptionsTest, MeaningsAreFoundAndSaid) {
  const std::vector<MarkerMeaning> meanings{{MarkerOf::kTrial, 0, "trial", 1},
                                            {MarkerOf::kStage, 1, "press", 22}};
  EXPECT_EQ(words_of(meanings), "trial 1, stage press 22");
  Onset onset{MarkerOf::kStage};
  EXPECT_EQ(meaning_of(meanings, onset), nullptr);
  onset.index = 1;
  ASSERT_NE(meaning_of(meanings, onset), nullptr);
  EXPECT_EQ(meaning_of(meanings, onset)->code, 22);
}

using record::MarkerOutput;
using record::MarkerRow;

MarkerRow row(MarkerOutput way, double latency) {
  MarkerRow row;
  row.way = way;
  row.latency = latency;
  return row;
}

TEST(MarkerTimesTest, AreNearestRanksOfEachWay) {
  MarkerLatencies first, second;
  std::vector<MarkerRow> rows{row(MarkerOutput::kNone, std::nan("")),
                              row(MarkerOutput::kScreen, std::nan(""))};
  for (int i = 150; i > 0; --i) {
    rows.push_back(row(MarkerOutput::kSerial, 1e-3 * i));
  }
  first.add(rows);
  rows.clear();
  for (int i = 151; i <= 200; ++i) {
    rows.push_back(row(MarkerOutput::kSerial, 1e-3 * i));
  }
  rows.push_back(row(MarkerOutput::kSerial, std::nan("")));
  second.add(rows);
  first.add(second);
  const auto times = first.times();
  ASSERT_EQ(times.size(), 2u) << "what went nowhere has no time";
  EXPECT_EQ(times[0].way, MarkerOutput::kSerial);
  EXPECT_EQ(times[0].sent, 200u);
  EXPECT_EQ(times[0].lost, 1u);
  EXPECT_EQ(times[0].median, 0.100);
  EXPECT_EQ(times[0].p99, 0.198);
  EXPECT_EQ(times[0].largest, 0.200);
  EXPECT_EQ(times[1].sent, 0u);
  EXPECT_TRUE(std::isnan(times[1].median));
  EXPECT_EQ(sentence_of(times[0]),
            "serial: 200 markers, median 100.000 ms, 99 % 198.000 ms, largest 200.000 ms after "
            "their tick; 1 did not go");
  EXPECT_EQ(sentence_of(times[1]), "screen: no marker; 1 did not go");
}

}  // namespace

}  // namespace haptrial::markers
