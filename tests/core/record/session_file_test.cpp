#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/random.h"
#include "core/record/session_reader.h"
#include "core/record/session_writer.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record {
namespace {

using test::example_info;
using test::hand_motion;
using test::on_file;
using test::same;
using test::TemporaryFolder;

TEST(SessionFileTest, RoundTripOfSamples) {
  const TemporaryFolder folder;
  const std::vector<Sample> samples = hand_motion(10000, 1);
  SessionWriter writer(folder / "a.h5", example_info());
  writer.append(samples);
  writer.close();
  const SessionReader reader(folder / "a.h5");
  ASSERT_EQ(reader.sample_count(), samples.size());
  const std::vector<Sample> back = reader.samples(0, samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_TRUE(same(back[i], on_file(samples[i]))) << "row " << i;
  }
}

}  // namespace
}  // namespace haptrial::record
